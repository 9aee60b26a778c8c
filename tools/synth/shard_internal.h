#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "tools/synth/dataset.h"

namespace ossa::tools {

/// A file of packed frames: a checksummed container of zstd blobs, one per frame, cropped to the
/// people. A shard has few frames (DatasetManifest::frames_per_shard), so that reading one is fast
/// and rendering can resume at a shard.
struct Shard {
  int64_t first_index = 0;
  std::vector<uint64_t> offsets;  // count + 1 entries into blobs
  std::vector<uint8_t> blobs;
  std::string file;

  int64_t count() const { return static_cast<int64_t>(offsets.size()) - 1; }
};

std::filesystem::path ShardPath(const std::filesystem::path& folder, int64_t shard);

/// One frame as a blob: cropped to its labelled pixels and `kCropBorder` around them.
std::vector<uint8_t> PackFrame(const LabelledFrame& frame);
LabelledFrame UnpackFrame(const Shard& shard, int64_t index);

void WriteShard(const std::filesystem::path& path, int64_t first_index,
                std::span<const std::vector<uint8_t>> frames);
/// Throws InputError naming the file unless it holds frames first_index .. + count - 1.
Shard ReadShard(const std::filesystem::path& path, int64_t first_index, int64_t count);

/// The part of a frame in a rectangle (pixels) inside its image; the camera is shifted.
LabelledFrame Cropped(const LabelledFrame& frame, int u0, int v0, int width, int height);

}  // namespace ossa::tools
