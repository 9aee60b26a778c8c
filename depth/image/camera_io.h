#pragma once
#include <filesystem>
#include <string>

#include "depth/image/camera.h"
#include "depth/image/camera_presets.h"

namespace ossa::depth {

/// `camera.json`: {"width": 640, "height": 480, "fx": 575.0, "fy": 575.0, "cx": 320.0, "cy": 240.0}
/// or, as Open3D writes it, with "intrinsic_matrix": [fx, 0, 0, 0, fy, 0, cx, cy, 1].
/// Throws InputError naming the file and the field.
Camera ReadCameraJson(const std::filesystem::path& path);

/// Whether the name may be a camera file: it ends in .json, .yaml, .yml, .xml or .txt, or a file of
/// that name exists.
bool IsCameraFile(const std::filesystem::path& path);
/// Reads the intrinsics in a camera file: camera.json, a calibration of OpenCV's FileStorage (YAML,
/// XML, JSON), of ROS (camera_calibration's ost.yaml, camera_info), Kalibr (camchain.yaml) or
/// COLMAP (cameras.txt), or the numbers of the camera matrix alone. Without an image size in the
/// file they are for images of any size. Distortion of more than a hundredth of the image's width
/// is ignored and reported in `unheeded`. Throws InputError naming the file.
CameraChoice ReadCameraFile(const std::filesystem::path& path);
void WriteCameraJson(const std::filesystem::path& path, const Camera& camera);

/// The same object as text; `name` stands for the file in messages.
Camera CameraFromJson(const std::string& text, const std::string& name);
std::string CameraToJson(const Camera& camera);

/// The "camera" object of a data set's manifest.json.
Camera ReadManifestCamera(const std::filesystem::path& manifest_path);

/// Parses `--camera PRESET|fx,fy,cx,cy|FILE` (CameraPresetNames, ReadCameraFile). Four numbers are
/// in pixels of the frames (of the whole image, where a sensor crops it), whose size is not known
/// yet: their camera has width and height 0 until CameraForSize.
CameraChoice ParseCamera(const std::string& text);

}  // namespace ossa::depth
