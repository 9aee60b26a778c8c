#pragma once
#include <Eigen/Geometry>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace ossa::recon {

/// One of several cameras that see the same people and do not move.
struct CameraExtrinsics {
  std::string name;
  /// Takes a point of camera 0's space to this camera's, metres.
  Eigen::Isometry3d from_camera_0 = Eigen::Isometry3d::Identity();
  /// Seconds to add to this camera's times: then they are camera 0's.
  double clock_offset_s = 0.0;
};

/// All cameras, camera 0 first: its transform is the identity and its offset 0.
using Extrinsics = std::vector<CameraExtrinsics>;

/// Reads an extrinsics file (docs/files.md). Throws InputError naming file, place and expectation
/// for what is no JSON of that form: a camera without a name of its own, a matrix that is no
/// rotation and translation within 1000 km, a first camera that is elsewhere than camera 0. What is
/// off a rotation by less than a thousandth (few digits) is brought to the nearest one.
Extrinsics ReadExtrinsics(const std::filesystem::path& path);

/// The same of such a file's text; `place` stands for the file in messages.
Extrinsics ExtrinsicsFromJson(const std::string& text, const std::string& place);

/// Writes it; the file appears under its name when complete. Throws InputError.
void WriteExtrinsics(const std::filesystem::path& path, const Extrinsics& cameras);

/// The text of such a file.
std::string ExtrinsicsJson(const Extrinsics& cameras);

/// The cameras that recordings of these names are of, relative to the first of them: where every
/// name is a camera's, those, in any order; else all cameras in their order. Throws InputError,
/// `place` (the file) first, where there are then more or fewer cameras than names, and where one
/// of the names is that of a camera at another place.
Extrinsics SelectCameras(const Extrinsics& cameras, std::span<const std::string> names,
                         const std::string& place);

/// Names of cameras by the files or folders that their recordings are: the stem, and where two are
/// alike camera_0, camera_1 ... for all.
std::vector<std::string> CameraNames(std::span<const std::string> sources);

}  // namespace ossa::recon
