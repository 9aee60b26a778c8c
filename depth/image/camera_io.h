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

/// Whether a name is one of files that state cameras, .json, .yaml, .yml, .xml, .txt, or of a file
/// with another extension that is there.
bool IsCameraFile(const std::filesystem::path& path);
/// The camera that such a file states: as camera.json does, or a calibration as OpenCV's
/// FileStorage (YAML, XML, JSON) and ROS's camera_calibration (ost.yaml) and camera_info have it,
/// or the numbers of its matrix alone; one that states no size is of whatever images come. What a
/// pinhole camera cannot be, a lens that bends by more than a hundredth of the image, is in
/// `unheeded`. Throws InputError naming the file.
CameraChoice ReadCameraFile(const std::filesystem::path& path);
void WriteCameraJson(const std::filesystem::path& path, const Camera& camera);

/// The same object as text; `name` stands for the file in messages.
Camera CameraFromJson(const std::string& text, const std::string& name);
std::string CameraToJson(const Camera& camera);

/// The "camera" object of a data set's manifest.json.
Camera ReadManifestCamera(const std::filesystem::path& manifest_path);

/// What `--camera PRESET|fx,fy,cx,cy|FILE` says (CameraPresetNames, ReadCameraFile). Four numbers
/// are in pixels of whatever frames come (of the whole image, where a sensor crops it), so their
/// camera has width and height 0 until CameraForSize gets the size.
CameraChoice ParseCamera(const std::string& text);

}  // namespace ossa::depth
