#pragma once
#include <filesystem>
#include <optional>

#include "depth/image/depth_png.h"
#include "depth/sensor/depth_list.h"

/// Recordings of Stray Scanner, an app for iPhones and iPads with a LiDAR: a folder with `depth`
/// and `confidence` (PNGs of the same names), `camera_matrix.csv` and `odometry.csv`.
namespace ossa::depth {

/// Name of the file of intrinsics in a recording.
inline constexpr const char* kScannerCameraFile = "camera_matrix.csv";

/// The camera of the depth images, which have this size, from a recording's camera_matrix.csv. It
/// states the colour camera's intrinsics, in pixels of 1920x1440; depth is aligned to colour.
/// Throws InputError.
Camera ReadScannerCamera(const std::filesystem::path& file, ImageSize size);

/// The times of the depth images from a recording's odometry.csv, which may name more than there
/// are: files relative to the recording; nothing if there is no such table.
std::optional<DepthList> ReadScannerTimes(const std::filesystem::path& recording);

/// Whether a depth image of this size has a confidence image, of confidences 0, 1 and 2.
bool HasConfidence(const std::filesystem::path& depth_png, ImageSize size);

/// Removes the readings of confidence 0: guessed from the colours, they connect people with what is
/// behind them. Throws InputError if the confidence image cannot be read or has another size.
void RemoveUnconfident(const std::filesystem::path& depth_png, Image<uint16_t>& depth);

}  // namespace ossa::depth
