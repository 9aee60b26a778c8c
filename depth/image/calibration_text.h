#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

namespace ossa::depth {

/// A camera calibration as in OpenCV and ROS.
struct Calibration {
  int width = 0, height = 0;         // pixels; 0: not stated
  std::array<double, 9> matrix{};    // fx 0 cx, 0 fy cy, 0 0 1
  std::vector<double> distortion{};  // OpenCV's order: k1 k2 p1 p2 k3 k4 k5 k6 ...
  std::string model{};               // ROS's name of the distortion model; "": not stated
};

/// The calibration in a text, under the common names `camera_matrix`, `cameraMatrix`, `K` or
/// `intrinsics`, row by row or column by column, `distortion_coefficients`, `distCoeffs` or `D`,
/// `image_width` or `width`. YAML with or without OpenCV's first line (ROS's ost.yaml and
/// camera_info), XML, or JSON; a matrix is a list of numbers, possibly under `data`. nullopt if
/// there is no matrix; throws InputError, starting with `name`, if it does not have nine numbers. A
/// hand-written parser: OpenCV's FileStorage refuses ROS's files (they lack its first line),
/// yaml-cpp reads no XML, and either would be loaded by all users of this library, including
/// drivers in other programs, for a dozen numbers.
std::optional<Calibration> FindCalibration(const std::string& text, const std::string& name);

/// The matrix of a text of numbers only, nine, twelve or sixteen (three or four rows of four, as in
/// ScanNet), as numpy.savetxt writes it, or of nine followed by others; nullopt for other texts.
std::optional<Calibration> ReadBareMatrix(const std::string& text);

/// The calibration of a text that names fx, fy, cx and cy, a line each, as ORB-SLAM's settings
/// (`Camera.fx: 525.0`) and own programs' (`fx = 525`), with k1 k2 p1 p2 k3 where it names them;
/// nullopt for other texts. Throws InputError, starting with `name`, for a size that is none.
std::optional<Calibration> ReadNamedNumbers(const std::string& text, const std::string& name);

/// The pinhole camera of a calibration by Kalibr (camchain.yaml: camera_model, intrinsics fx fy cx
/// cy, resolution) or of EuRoC's sensor.yaml; nullopt for other texts. Throws InputError, starting
/// with `name`, for another camera model, and for several cameras, of which any may be meant.
std::optional<Calibration> ReadKalibrCamera(const std::string& text, const std::string& name);

/// The camera of COLMAP's cameras.txt, its principal point moved by half a pixel to our pixel
/// centres; nullopt for other texts. Throws InputError, starting with `name`, as above.
std::optional<Calibration> ReadColmapCameras(const std::string& text, const std::string& name);

/// Largest displacement of an image corner by the distortion, pixels; if the size is not stated it
/// is twice the principal point. NaN for models other than OpenCV's.
double ComputeCornerShift(const Calibration& calibration);

}  // namespace ossa::depth
