#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "forest/training/train.h"
#include "forest/trees/depth_feature_internal.h"

namespace ossa::forest {

/// A sampled pixel of an image.
struct PixelSample {
  uint16_t x = 0;  // box coordinates
  uint16_t y = 0;
  uint8_t label = 0;
  uint8_t unused = 0;
};

/// A training image in memory: depth, a class-balanced sample of its pixels, and the truth.
struct StoredImage {
  size_t index = 0;  // index in the source
  ObjectImage image;
  std::vector<PixelSample> samples;
  uint8_t context = 0;
  depth::Camera camera;  // of the full box: back-projects box coordinates
  std::vector<Eigen::Vector3f> target_m;
};

StoredImage StoreImage(const TrainingImage& image, size_t index, int pixels, uint64_t seed,
                       uint16_t background_mm, size_t class_count);

/// This rank's images, in parts that fit into the memory limit. A single part is kept in memory;
/// several are read again at each visit.
class ImageParts {
 public:
  ImageParts(const TrainingSource& source, const TrainOptions& options, size_t class_count,
             const Reducer& reducer);

  size_t part_count() const { return parts_.size(); }
  size_t image_count() const { return image_count_; }
  /// Calls visit(part, images) for every part in order. Checks TrainOptions::stop before each part,
  /// and throws TrainInterrupted: reading a part may take long.
  void Visit(const std::function<void(size_t, const std::vector<StoredImage>&)>& visit) const;
  uint64_t context_count(size_t context) const { return context_counts_[context]; }

 private:
  std::vector<StoredImage> ReadPart(const std::vector<size_t>& indices) const;
  bool StopWanted() const { return options_.stop && options_.stop(); }
  void EndIfStopped() const;

  const TrainingSource& source_;
  const TrainOptions& options_;
  size_t class_count_;
  std::vector<std::vector<size_t>> parts_;  // source indices
  std::vector<StoredImage> kept_;           // if there is one part
  size_t image_count_ = 0;
  std::vector<uint64_t> context_counts_;
};

inline constexpr uint16_t kBackground_mm = 10000;  // by hand: farther than any person

}  // namespace ossa::forest
