// Close looks (.ossalook): any payload is a value or an InputError.
#include <cstdint>

#include "recon/look/close_look.h"
#include "tests/fuzz/outcome.h"
#include "tests/fuzz/seeds.h"

namespace {

namespace recon = ossa::recon;
using recon::CloseLook;

}  // namespace

std::vector<std::string> ossa::fuzz::Seeds() {
  CloseLook look;
  look.people = 1;
  for (recon::RectifiedNetwork& network : look.glances.emplace_back()) {
    network.input_mean = Eigen::VectorXf::Zero(recon::kLookInputs);
    network.input_scale = Eigen::VectorXf::Ones(recon::kLookInputs);
    network.layers = {{Eigen::MatrixXf::Ones(3, recon::kLookInputs), Eigen::VectorXf::Zero(3)}};
  }
  const std::string path = ScratchPath("look");
  look.Save(path);
  return {TakePayload(path)};
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  ossa::fuzz::ExpectValueOrOneLine([&] {
    const auto look = CloseLook::FromBytes(std::as_bytes(std::span(data, size)), "x.ossalook");
    for (const recon::Glance& glance : look.glances) {
      for (const recon::RectifiedNetwork& network : glance) {
        if (!network.Run(Eigen::VectorXf::Zero(recon::kLookInputs)).allFinite()) abort();
      }
    }
  });
  return 0;
}
