// Close looks (.ossalook): any payload is a value or an InputError.
#include <cstdint>

#include "recon/refine/bone_measure.h"
#include "recon/refine/close_look.h"
#include "tests/fuzz/outcome.h"
#include "tests/fuzz/seeds.h"

namespace {

namespace recon = ossa::recon;
using recon::CloseLook;

recon::RectifiedNetwork Plain(Eigen::Index inputs, Eigen::Index outputs) {
  recon::RectifiedNetwork network;
  network.input_mean = Eigen::VectorXf::Zero(inputs);
  network.input_scale = Eigen::VectorXf::Ones(inputs);
  network.layers = {{Eigen::MatrixXf::Ones(outputs, inputs), Eigen::VectorXf::Zero(outputs)}};
  return network;
}

}  // namespace

std::vector<std::string> ossa::fuzz::Seeds() {
  CloseLook look;
  look.people = look.measured = 1;
  look.glances.emplace_back().fill(Plain(recon::kLookInputs, 3));
  look.bones = Plain(recon::kBoneInputs, recon::kMeasuredBones.size());
  look.told.emplace_back().fill(Plain(recon::kToldInputs, 3));
  const std::string path = ScratchPath("look");
  look.Save(path);
  return {TakePayload(path)};
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  ossa::fuzz::ExpectValueOrOneLine([&] {
    const auto look = CloseLook::FromBytes(std::as_bytes(std::span(data, size)), "x.ossalook");
    const auto run = [](const std::vector<recon::Glance>& glances, Eigen::Index inputs) {
      for (const recon::Glance& glance : glances) {
        for (const recon::RectifiedNetwork& network : glance) {
          if (!network.Run(Eigen::VectorXf::Zero(inputs)).allFinite()) abort();
        }
      }
    };
    run(look.glances, recon::kLookInputs);
    run(look.told, recon::kToldInputs);
    if (!look.bones.empty() &&
        !look.bones.Run(Eigen::VectorXf::Zero(recon::kBoneInputs)).allFinite()) {
      abort();
    }
  });
  return 0;
}
