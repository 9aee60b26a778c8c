// Posture priors (.ossaprior): any payload is a value or an InputError.
#include <cstdint>

#include "recon/models/posture_prior.h"
#include "tests/fuzz/outcome.h"
#include "tests/fuzz/seeds.h"

namespace {

namespace recon = ossa::recon;
using recon::PosturePrior;

}  // namespace

std::vector<std::string> ossa::fuzz::Seeds() {
  PosturePrior prior;
  prior.frames = 100;
  prior.modes_m = Eigen::MatrixXd::Constant(recon::kBoneDims, 2, 0.1);
  prior.correlation_time_s = Eigen::VectorXd::Constant(2, 0.5);
  const std::string path = ScratchPath("prior");
  prior.Save(path);
  const std::string without = TakePayload(path);
  prior.network.input_mean = Eigen::RowVectorXf::Zero(recon::kPriorInputs);
  prior.network.input_scale = Eigen::RowVectorXf::Ones(recon::kPriorInputs);
  prior.network.layers = {
      {ossa::RowMatrix::Ones(recon::kPriorInputs, 1), Eigen::RowVectorXf::Zero(1)},
      {ossa::RowMatrix::Ones(1, recon::kBoneDims), Eigen::RowVectorXf::Zero(recon::kBoneDims)}};
  prior.Save(path);
  return {without, TakePayload(path)};
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  for (uint32_t version = 1; version <= PosturePrior::kVersion; ++version) {
    ossa::fuzz::ExpectValueOrOneLine([&] {
      const auto prior =
          PosturePrior::FromBytes(std::as_bytes(std::span(data, size)), "x.ossaprior", version);
      if (prior.modes_m.cols() != prior.correlation_time_s.size() || !prior.modes_m.allFinite())
        abort();
      const auto says_m = prior.network.empty()
                              ? recon::BoneVector(recon::BoneVector::Zero())
                              : prior.network.Correction_m(recon::PriorInput::Zero());
      if (!says_m.allFinite()) abort();
    });
  }
  return 0;
}
