#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>

namespace ossa::tools {

struct PersonCropOptions {
  int threads = 0;                                 // 0: all; they do not change the files
  std::function<void(int64_t, int64_t)> progress;  // frames done, frames in all
  std::function<bool()> stop;                      // true: end with TrainInterrupted
};

/// Cuts one person of each frame of a data set out as a pose network reads them, in turn where
/// there are several, and writes them for a trainer, as NumPy's files, a row a frame:
///   crops.npy   uint8 [frames, 2, 96, 96]: recon::PersonCrop's cells, first how far beyond the
///               middle surface lies, centimetres + 128, then 5 * surface + hidden;
///   joints.npy  float32 [frames, 20, 3]: recon::PersonCrop::Project of the true joints, NaN
///               where too little of the person is seen or a joint is not before the camera;
///   range.npy   float32 [frames]: metres from the camera to the middle.
/// Returns how many people there are. joints.npy comes last: with it the folder is whole.
int64_t WritePersonCrops(const std::filesystem::path& dataset, const std::filesystem::path& out,
                         const PersonCropOptions& options);

}  // namespace ossa::tools
