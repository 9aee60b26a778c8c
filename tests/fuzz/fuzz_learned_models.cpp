// Learned reconstructions (.ossagp): any payload is a value or an InputError.
#include <cstdint>

#include "recon/models/learned_models.h"
#include "tests/fuzz/outcome.h"
#include "tests/fuzz/seeds.h"

namespace {

using ossa::recon::LearnedModels;

}  // namespace

std::vector<std::string> ossa::fuzz::Seeds() {
  LearnedModels models;
  models.pair_count = 2;
  const auto features =
      static_cast<Eigen::Index>(recon::JointFeature(recon::Posture(), size_t{3}).size());
  Eigen::MatrixXd inputs = Eigen::MatrixXd::Zero(2, features);
  inputs(1, 0) = 0.5;
  models.full[3] = recon::GaussianProcess({}, inputs, Eigen::MatrixXd::Constant(2, 3, 0.1));
  models.filter.step_s = 1.0 / 30.0;
  models.filter.weights[0][3] = Eigen::MatrixXf::Constant(recon::FilterFeatureSize(3), 3, 0.01F);
  const std::string path = ScratchPath("learned");
  models.Save(path);
  return {TakePayload(path)};
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  ossa::fuzz::ExpectValueOrOneLine(
      [&] { LearnedModels::FromBytes(std::as_bytes(std::span(data, size)), "x.ossagp"); });
  return 0;
}
