// Where several cameras are: any text is extrinsics, which are written and read again, or an
// InputError.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "depth/base/error.h"
#include "recon/fuse/extrinsics.h"
#include "tests/fuzz/seeds.h"

std::vector<std::string> ossa::fuzz::Seeds() {
  Eigen::Isometry3d side = Eigen::Isometry3d::Identity();
  side.linear() = Eigen::AngleAxisd(1.2, Eigen::Vector3d::UnitY()).toRotationMatrix();
  side.translation() = Eigen::Vector3d(-2.7, 0.3, 1.9);
  return {recon::ExtrinsicsJson({{.name = "front"}, {"side", side, -0.125}})};
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  ossa::recon::Extrinsics cameras;
  try {
    cameras = ossa::recon::ExtrinsicsFromJson(text, "room.json");
  } catch (const ossa::InputError&) {
    return 0;
  }
  const auto again = ossa::recon::ExtrinsicsFromJson(ossa::recon::ExtrinsicsJson(cameras), "again");
  if (again.size() != cameras.size()) abort();
  for (const auto& camera : again) {
    const Eigen::Matrix3d turn = camera.from_camera_0.linear();
    if (!(std::abs(turn.determinant() - 1.0) < 1e-6)) abort();
  }
  return 0;
}
