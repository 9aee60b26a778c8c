// Posture priors (.ossaprior): any payload is a value or an InputError.
#include <cstdint>

#include "recon/gp/posture_prior.h"
#include "tests/fuzz/outcome.h"
#include "tests/fuzz/seeds.h"

namespace {

using ossa::recon::PosturePrior;

constexpr size_t kSealSize = 32;  // magic, byte order, version, length and checksum

}  // namespace

std::vector<std::string> ossa::fuzz::Seeds() {
  PosturePrior prior;
  prior.frames = 100;
  prior.modes_m = Eigen::MatrixXd::Constant(recon::kBoneDims, 2, 0.1);
  prior.time_s = Eigen::VectorXd::Constant(2, 0.5);
  const std::string path = ScratchPath("prior");
  prior.Save(path);
  return {TakeFile(path).substr(kSealSize)};
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  ossa::fuzz::ExpectValueOrOneLine([&] {
    const auto prior = PosturePrior::FromBytes(std::as_bytes(std::span(data, size)), "x.ossaprior");
    if (prior.modes_m.cols() != prior.time_s.size() || !prior.modes_m.allFinite()) abort();
  });
  return 0;
}
