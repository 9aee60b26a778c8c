#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

namespace ossa::depth {

/// A camera's calibration as OpenCV's and ROS's programs write it.
struct Calibration {
  int width = 0, height = 0;         // pixels; 0: not stated
  std::array<double, 9> matrix{};    // fx 0 cx, 0 fy cy, 0 0 1
  std::vector<double> distortion{};  // OpenCV's order: k1 k2 p1 p2 k3 k4 k5 k6 ...
  std::string model{};               // ROS's name for them; "": not stated
};

/// The calibration that a text states under the names that are in use: `camera_matrix`,
/// `cameraMatrix`, `K` or `intrinsics`, row by row or column by column, `distortion_coefficients`,
/// `distCoeffs` or `D`, `image_width` or `width`. YAML with or without OpenCV's first line (what
/// ROS's camera_calibration saves as ost.yaml, and camera_info), XML, or JSON; a matrix is its
/// numbers, or what has them as `data`. nullopt where it states no such matrix; throws InputError,
/// `name` first, where that has not nine numbers. Read by hand: OpenCV's own FileStorage refuses
/// ROS's files (they lack its first line), yaml-cpp reads no XML, and either would be loaded by
/// everybody who uses this room, drivers in other people's programs among them, for a dozen
/// numbers.
std::optional<Calibration> FindCalibration(const std::string& text, const std::string& name);

/// The matrix of a text of nothing but its numbers, nine, twelve or sixteen (three or four rows of
/// four, as ScanNet's), as numpy.savetxt writes it, or of these nine and others behind them;
/// nullopt of another text.
std::optional<Calibration> ReadBareMatrix(const std::string& text);

/// By how many pixels the lens moves the corner of the image that it moves most, the whole image's
/// size being twice the centre where none is stated. NaN of a model that is not OpenCV's.
double ComputeCornerShift(const Calibration& calibration);

}  // namespace ossa::depth
