#include <oneapi/tbb/parallel_for.h>

#include <algorithm>

#include "depth/base/error.h"
#include "depth/base/random.h"
#include "depth/base/train_interrupted.h"
#include "forest/training/images_internal.h"

namespace ossa::forest {
namespace {

constexpr size_t kReadBatch = 64;  // for speed

void CheckImage(const TrainingImage& image, size_t index, size_t class_count) {
  const auto pixels =
      static_cast<size_t>(image.camera.width) * static_cast<size_t>(image.camera.height);
  if (image.depth_mm.size() != pixels || image.label.size() != pixels) {
    throw InputError("training image " + std::to_string(index) + ": expected " +
                     std::to_string(pixels) + " pixels of depth and labels, found " +
                     std::to_string(image.depth_mm.size()) + " and " +
                     std::to_string(image.label.size()));
  }
  for (const uint8_t label : image.label) {
    if (label >= class_count) {
      throw InputError("training image " + std::to_string(index) + ": label " +
                       std::to_string(label) + ", expected less than " +
                       std::to_string(class_count));
    }
  }
}

// Each present class gets an equal share of the samples; what small classes leave unused goes to
// larger ones: the smallest share for which Σ min(available, share) reaches `pixels`.
size_t FairShare(const std::vector<std::vector<PixelSample>>& by_class, size_t pixels) {
  size_t low = 0;
  size_t high = pixels;
  while (low < high) {
    const size_t share = (low + high) / 2;
    size_t drawn = 0;
    for (const auto& samples : by_class) drawn += std::min(samples.size(), share);
    if (drawn >= pixels) {
      high = share;
    } else {
      low = share + 1;
    }
  }
  return low;
}

size_t CountBytes(const StoredImage& image) {
  return sizeof(StoredImage) + image.image.depth_mm.size() * sizeof(uint16_t) +
         image.samples.size() * sizeof(PixelSample) + image.target_m.size() * 12;
}

}  // namespace

StoredImage StoreImage(const TrainingImage& image, size_t index, int pixels, uint64_t seed,
                       uint16_t background_mm, size_t class_count) {
  CheckImage(image, index, class_count);
  StoredImage stored;
  stored.index = index;
  stored.context = image.context;
  stored.target_m = image.target_m;
  std::vector<int32_t> object;
  for (size_t i = 0; i < image.label.size(); ++i) {
    if (image.label[i] != 0 && image.depth_mm[i] != 0) object.push_back(static_cast<int32_t>(i));
  }
  const int width = image.camera.width;
  const depth::DepthView view{image.depth_mm.data(), width, image.camera.height, width};
  stored.image = CutOut(view, image.camera, object, background_mm);
  stored.camera = image.camera;
  stored.camera.cx -= stored.image.u0;
  stored.camera.cy -= stored.image.v0;
  std::vector<std::vector<PixelSample>> by_class(class_count);
  for (const int32_t pixel : object) {
    const uint8_t label = image.label[static_cast<size_t>(pixel)];
    by_class[label].push_back({static_cast<uint16_t>(pixel % width - stored.image.u0),
                               static_cast<uint16_t>(pixel / width - stored.image.v0), label});
  }
  const size_t share = FairShare(by_class, static_cast<size_t>(pixels));
  Random random(MixSeed(seed, 0x5a3b1e, index));
  for (auto& samples : by_class) {
    const size_t count = std::min(samples.size(), share);
    for (size_t i = 0; i < count; ++i) {
      const auto rest = static_cast<uint32_t>(samples.size() - i);
      std::swap(samples[i], samples[i + random.Below(rest)]);
      stored.samples.push_back(samples[i]);
    }
  }
  return stored;
}

ImageParts::ImageParts(const TrainingSource& source, const TrainOptions& options,
                       size_t class_count, const Reducer& reducer)
    : source_(source), options_(options), class_count_(class_count), context_counts_(256, 0) {
  std::vector<size_t> part;
  size_t bytes = 0;
  bool fits = true;
  const auto step = static_cast<size_t>(reducer.size());
  std::vector<size_t> mine;
  for (size_t i = static_cast<size_t>(reducer.rank()); i < source.size(); i += step) {
    mine.push_back(i);
  }
  for (size_t first = 0; first < mine.size(); first += kReadBatch) {
    const auto begin = mine.begin() + static_cast<ptrdiff_t>(first);
    const size_t count = std::min(kReadBatch, mine.size() - first);
    for (StoredImage& image : ReadPart({begin, begin + static_cast<ptrdiff_t>(count)})) {
      if (image.samples.empty()) continue;
      const size_t size = CountBytes(image);
      if (bytes + size > options.memory_bytes && !part.empty()) {
        parts_.push_back(std::move(part));
        part.clear();
        bytes = 0;
        fits = false;
        kept_.clear();
        kept_.shrink_to_fit();
      }
      bytes += size;
      part.push_back(image.index);
      ++context_counts_[image.context];
      ++image_count_;
      if (fits) kept_.push_back(std::move(image));
    }
  }
  if (!part.empty()) parts_.push_back(std::move(part));
}

std::vector<StoredImage> ImageParts::ReadPart(const std::vector<size_t>& indices) const {
  std::vector<StoredImage> images(indices.size());
  // Blocks of consecutive images: data sets decode the frames of a shard in order.
  constexpr size_t kBlock = kReadBatch / 2;
  oneapi::tbb::parallel_for(size_t{0}, (indices.size() + kBlock - 1) / kBlock, [&](size_t block) {
    for (size_t i = block * kBlock; i < std::min(indices.size(), (block + 1) * kBlock); ++i) {
      if (StopWanted()) return;
      const int pixels = std::max(options_.pixels, options_.refill_pixels);
      images[i] = StoreImage(source_.Read(indices[i]), indices[i], pixels, options_.seed,
                             kBackground_mm, class_count_);
    }
  });
  EndIfStopped();
  return images;
}

void ImageParts::EndIfStopped() const {
  if (StopWanted()) throw TrainInterrupted("interrupted while reading");
}

void ImageParts::Visit(
    const std::function<void(size_t, const std::vector<StoredImage>&)>& visit) const {
  EndIfStopped();
  if (parts_.size() == 1 && !kept_.empty()) return visit(0, kept_);
  for (size_t i = 0; i < parts_.size(); ++i) visit(i, ReadPart(parts_[i]));
}

}  // namespace ossa::forest
