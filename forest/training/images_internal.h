#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "forest/training/train.h"
#include "forest/trees/depth_feature_internal.h"

namespace ossa::forest {

/// A pixel drawn from an image.
struct PixelSample {
  uint16_t x = 0;  // box coordinates
  uint16_t y = 0;
  uint8_t label = 0;
  uint8_t unused = 0;
};

/// An image as training keeps it: the depth, a class-balanced draw of its pixels, and the truth.
struct StoredImage {
  size_t index = 0;  // in the source
  ObjectImage image;
  std::vector<PixelSample> samples;
  uint8_t context = 0;
  depth::Camera camera;  // of the uncut box: back-projects box coordinates
  std::vector<Eigen::Vector3f> target_m;
};

StoredImage StoreImage(const TrainingImage& image, size_t index, int pixels, uint64_t seed,
                       uint16_t background_mm, size_t class_count);

/// This rank's images, in parts that fit the memory allowed. One part is kept; several are read
/// anew each time they are visited.
class ImageParts {
 public:
  ImageParts(const TrainingSource& source, const TrainOptions& options, size_t class_count,
             const Reducer& reducer);

  size_t part_count() const { return parts_.size(); }
  size_t image_count() const { return image_count_; }
  /// Calls visit(part, images) for every part in order. Throws TrainInterrupted before the next one
  /// once TrainOptions::stop says so: a part takes as long to read as the memory allowed is large.
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
  std::vector<StoredImage> kept_;           // when there is one part
  size_t image_count_ = 0;
  std::vector<uint64_t> context_counts_;
};

inline constexpr uint16_t kBackground_mm = 10000;  // by hand: farther than any person

}  // namespace ossa::forest
