// Pose network (.ossanet): any payload is a value or an InputError.
#include <cstdint>

#include "recon/refine/pose_network.h"
#include "tests/fuzz/outcome.h"
#include "tests/fuzz/seeds.h"
#include "tests/recon/refine/pose_networks.h"

namespace recon = ossa::recon;

std::vector<std::string> ossa::fuzz::Seeds() {
  const std::string path = ScratchPath("network");
  recon::PoseNetwork(recon::test::SilentLayers(), 1, path).Save(path);
  return {TakePayload(path)};
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  ossa::fuzz::ExpectValueOrOneLine([&] {
    const auto network =
        recon::PoseNetwork::FromBytes(std::as_bytes(std::span(data, size)), "x.ossanet");
    const recon::NetworkPose pose = network.Run(recon::test::EmptyCrop(2.0));
    for (size_t j = 0; j < recon::kJointCount; ++j) {
      if (!pose.joints_m.position_m[j].allFinite() || !(pose.error_m[j] > 0.0)) abort();
    }
  });
  return 0;
}
