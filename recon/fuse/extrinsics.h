#pragma once
#include <Eigen/Geometry>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace ossa::recon {

/// One of several fixed cameras that see the same people.
struct CameraExtrinsics {
  std::string name;
  /// Transforms a point from camera 0's space to this camera's, metres.
  Eigen::Isometry3d from_camera_0 = Eigen::Isometry3d::Identity();
  /// Seconds to add to this camera's times to get camera 0's.
  double clock_offset_s = 0.0;
};

/// All cameras, camera 0 first: its transform is the identity and its offset 0.
using Extrinsics = std::vector<CameraExtrinsics>;

/// Reads an extrinsics file (docs/files.md). Throws InputError naming file, place and expectation
/// for text that is not JSON of that form: a camera without a unique name, a matrix that is not a
/// rotation and translation within 1000 km, a first camera that is not at the origin. Rotations off
/// by less than a thousandth (few digits) are projected to the nearest rotation.
Extrinsics ReadExtrinsics(const std::filesystem::path& path);

/// As ReadExtrinsics, from text; `place` stands for the file in messages.
Extrinsics ExtrinsicsFromJson(const std::string& text, const std::string& place);

/// Writes an extrinsics file atomically. Throws InputError.
void WriteExtrinsics(const std::filesystem::path& path, const Extrinsics& cameras);

/// The text of an extrinsics file.
std::string ExtrinsicsJson(const Extrinsics& cameras);

/// Selects the cameras of recordings with these names, relative to the first of them: by name, if
/// every name is a camera's; else all cameras in order. Throws InputError, starting with `place`
/// (the file), if the counts then differ, or if a name is that of a camera at another index.
Extrinsics SelectCameras(const Extrinsics& cameras, std::span<const std::string> names,
                         const std::string& place);

/// Camera names from the files or folders of their recordings: the stem, or camera_0, camera_1 ...
/// for all if two stems are equal.
std::vector<std::string> CameraNames(std::span<const std::string> sources);

}  // namespace ossa::recon
