#include <zstd.h>

#include <algorithm>
#include <cstdio>
#include <memory>

#include "depth/base/checksummed_container.h"
#include "depth/base/error.h"
#include "tools/synth/shard_internal.h"

namespace ossa::tools {
namespace {

constexpr ContainerFormat kShardFormat{{'O', 'S', 'S', 'A', 'S', 'H', 'R', 'D'}, 1, "frame shard"};
// Constants: by hand; the largest sizes are bounds, against damaged files.

constexpr int kCropBorder = 4;        // pixels of background kept around the labelled ones
constexpr int kCompressionLevel = 1;  // of zstd, the fastest; higher levels save less than 10 %
constexpr uint64_t kLargestFrame_bytes = uint64_t{1} << 28;
constexpr int kLargestSide = 8192;
// Bits of a byte of the format: optional content of a frame.
constexpr uint8_t kHasFloor = 1, kHasWhole = 2;

struct ContextDeleter {
  void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
  void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
};

// Differences to the pixel on the left, low bytes before high bytes, compress to about half the
// size of plain millimetres.
std::vector<uint8_t> DepthPlanes(const std::vector<uint16_t>& depth_mm) {
  std::vector<uint8_t> planes(depth_mm.size() * 2);
  uint16_t last = 0;
  for (size_t i = 0; i < depth_mm.size(); ++i) {
    const auto step = static_cast<uint16_t>(depth_mm[i] - last);
    planes[i] = static_cast<uint8_t>(step & 255);
    planes[depth_mm.size() + i] = static_cast<uint8_t>(step >> 8);
    last = depth_mm[i];
  }
  return planes;
}

std::vector<uint16_t> DepthFromPlanes(const std::vector<uint8_t>& planes) {
  std::vector<uint16_t> depth_mm(planes.size() / 2);
  uint16_t last = 0;
  for (size_t i = 0; i < depth_mm.size(); ++i) {
    last = static_cast<uint16_t>(last + planes[i] + (planes[depth_mm.size() + i] << 8));
    depth_mm[i] = last;
  }
  return depth_mm;
}

template <typename T>
std::vector<T> CropPixels(const std::vector<T>& pixels, int stride, int u0, int v0, int width,
                          int height) {
  std::vector<T> crop;
  crop.reserve(static_cast<size_t>(width) * static_cast<size_t>(height));
  for (int v = v0; v < v0 + height; ++v) {
    const auto row = pixels.begin() + static_cast<ptrdiff_t>(v) * stride + u0;
    crop.insert(crop.end(), row, row + width);
  }
  return crop;
}

LabelledFrame CroppedToPeople(const LabelledFrame& frame) {
  const auto& parts = frame.parts;
  int u0 = parts.width, u1 = -1, v0 = parts.height, v1 = -1;
  for (int v = 0; v < parts.height; ++v) {
    for (int u = 0; u < parts.width; ++u) {
      if (parts.at(u, v) == 0) continue;
      u0 = std::min(u0, u), u1 = std::max(u1, u);
      v0 = std::min(v0, v), v1 = std::max(v1, v);
    }
  }
  if (u1 < 0) return Cropped(frame, 0, 0, 1, 1);
  u0 = std::max(0, u0 - kCropBorder), v0 = std::max(0, v0 - kCropBorder);
  u1 = std::min(parts.width - 1, u1 + kCropBorder);
  v1 = std::min(parts.height - 1, v1 + kCropBorder);
  return Cropped(frame, u0, v0, u1 - u0 + 1, v1 - v0 + 1);
}

void WriteBodies(PayloadWriter& writer, const std::vector<TruthBody>& bodies) {
  writer.Put(static_cast<uint32_t>(bodies.size()));
  for (const TruthBody& body : bodies) {
    writer.Put(static_cast<int32_t>(body.id));
    for (size_t j = 0; j < recon::kJointCount; ++j) {
      const Eigen::Vector3f p = body.joints_m.position_m[j].cast<float>();
      writer.Put(std::array{p.x(), p.y(), p.z()});
      writer.Put(static_cast<uint8_t>(body.visible[j] ? 1 : 0));
    }
  }
}

std::vector<TruthBody> GetBodies(PayloadReader& reader) {
  const auto count = reader.Get<uint32_t>("number of bodies");
  if (count > 255) reader.Fail("number of bodies", "expected at most 255");
  std::vector<TruthBody> bodies(count);
  for (TruthBody& body : bodies) {
    body.id = reader.Get<int32_t>("body id");
    for (size_t j = 0; j < recon::kJointCount; ++j) {
      const auto p = reader.Get<std::array<float, 3>>("joint");
      body.joints_m.position_m[j] = Eigen::Vector3d(p[0], p[1], p[2]);
      if (!body.joints_m.position_m[j].allFinite()) reader.Fail("joint", "not a finite position");
      body.visible[j] = reader.Get<uint8_t>("visible") != 0;
    }
  }
  return bodies;
}

LabelledFrame ParseFrame(std::span<const std::byte> bytes, const std::string& name, int64_t index) {
  PayloadReader reader(bytes, name);
  LabelledFrame frame;
  frame.depth.index = index;
  frame.depth.camera = reader.Get<depth::Camera>("camera");
  const auto& camera = frame.depth.camera;
  if (camera.width < 1 || camera.height < 1 || camera.width > kLargestSide ||
      camera.height > kLargestSide || !(camera.fx > 0) || !(camera.fy > 0)) {
    reader.Fail("camera", "not the camera of an image");
  }
  frame.depth.time_s = reader.Get<double>("time");
  const auto floor = reader.Get<std::array<double, 4>>("floor");
  const auto has = reader.Get<uint8_t>("what there is");
  if ((has & kHasFloor) != 0) frame.floor = Eigen::Vector4d(floor.data());
  frame.bodies = GetBodies(reader);
  const auto pixels = static_cast<size_t>(camera.width) * static_cast<size_t>(camera.height);
  const auto planes = reader.GetVector<uint8_t>("depth");
  if (planes.size() != 2 * pixels) reader.Fail("depth", "not of the image's size");
  frame.depth.depth_mm = DepthFromPlanes(planes);
  for (auto* image : {&frame.parts, &frame.users}) {
    image->width = camera.width;
    image->height = camera.height;
    image->data = reader.GetVector<uint8_t>("labels");
    if (image->data.size() != pixels) reader.Fail("labels", "not of the image's size");
  }
  if ((has & kHasWhole) != 0) {
    frame.whole = reader.Get<depth::Camera>("whole camera");
    depth::CheckCamera(*frame.whole, name + ": whole camera");
  }
  reader.ExpectEnd();
  return frame;
}

}  // namespace

std::filesystem::path ShardPath(const std::filesystem::path& folder, int64_t shard) {
  char name[32];
  std::snprintf(name, sizeof(name), "%06lld.shard", static_cast<long long>(shard));
  return folder / "shards" / name;
}

LabelledFrame Cropped(const LabelledFrame& frame, int u0, int v0, int width, int height) {
  LabelledFrame crop;
  crop.depth.camera = frame.depth.camera;
  crop.depth.camera.width = width;
  crop.depth.camera.height = height;
  crop.depth.camera.cx -= u0;
  crop.depth.camera.cy -= v0;
  crop.depth.time_s = frame.depth.time_s;
  crop.depth.index = frame.depth.index;
  const int stride = frame.depth.camera.width;
  crop.depth.depth_mm = CropPixels(frame.depth.depth_mm, stride, u0, v0, width, height);
  crop.parts = depth::Image<uint8_t>(width, height);
  crop.parts.data = CropPixels(frame.parts.data, stride, u0, v0, width, height);
  crop.users = depth::Image<uint8_t>(width, height);
  crop.users.data = CropPixels(frame.users.data, stride, u0, v0, width, height);
  crop.bodies = frame.bodies;
  crop.floor = frame.floor;
  crop.whole = frame.whole;
  return crop;
}

std::vector<uint8_t> PackFrame(const LabelledFrame& whole) {
  const LabelledFrame frame = CroppedToPeople(whole);
  PayloadWriter writer;
  writer.Put(frame.depth.camera);
  writer.Put(frame.depth.time_s);
  const Eigen::Vector4d floor = frame.floor.value_or(Eigen::Vector4d::Zero());
  writer.Put(std::array{floor[0], floor[1], floor[2], floor[3]});
  writer.Put(static_cast<uint8_t>((frame.floor ? kHasFloor : 0) | (frame.whole ? kHasWhole : 0)));
  WriteBodies(writer, frame.bodies);
  writer.PutVector(DepthPlanes(frame.depth.depth_mm));
  writer.PutVector(frame.parts.data);
  writer.PutVector(frame.users.data);
  if (frame.whole) writer.Put(*frame.whole);

  const auto& raw = writer.bytes();
  std::vector<uint8_t> blob(ZSTD_compressBound(raw.size()));
  thread_local const std::unique_ptr<ZSTD_CCtx, ContextDeleter> context(ZSTD_createCCtx());
  blob.resize(ZSTD_compressCCtx(context.get(), blob.data(), blob.size(), raw.data(), raw.size(),
                                kCompressionLevel));
  return blob;
}

LabelledFrame UnpackFrame(const Shard& shard, int64_t index) {
  const auto place = static_cast<size_t>(index - shard.first_index);
  const std::string name = shard.file + ": frame " + std::to_string(index);
  const uint8_t* blob = shard.blobs.data() + shard.offsets[place];
  const size_t size = shard.offsets[place + 1] - shard.offsets[place];
  const auto raw_size = ZSTD_getFrameContentSize(blob, size);
  if (raw_size > kLargestFrame_bytes) {  // zstd's error codes are the largest numbers
    throw InputError(name + ": expected a zstd frame of known size, found other bytes");
  }
  std::vector<std::byte> raw(raw_size);
  thread_local const std::unique_ptr<ZSTD_DCtx, ContextDeleter> context(ZSTD_createDCtx());
  const size_t got = ZSTD_decompressDCtx(context.get(), raw.data(), raw.size(), blob, size);
  if (ZSTD_isError(got) != 0 || got != raw.size()) {
    throw InputError(name + ": damaged: its compressed bytes cannot be unpacked");
  }
  return ParseFrame(raw, name, index);
}

void WriteShard(const std::filesystem::path& path, int64_t first_index,
                std::span<const std::vector<uint8_t>> frames) {
  std::vector<uint64_t> offsets{0};
  std::vector<uint8_t> blobs;
  for (const auto& frame : frames) {
    blobs.insert(blobs.end(), frame.begin(), frame.end());
    offsets.push_back(blobs.size());
  }
  PayloadWriter writer;
  writer.Put(first_index);
  writer.PutVector(offsets);
  writer.PutVector(blobs);
  WriteContainer(path, kShardFormat, writer.bytes());
}

Shard ReadShard(const std::filesystem::path& path, int64_t first_index, int64_t count) {
  const auto payload = ReadContainer(path, kShardFormat);
  PayloadReader reader(payload, path.string());
  Shard shard;
  shard.file = path.string();
  shard.first_index = reader.Get<int64_t>("first frame");
  shard.offsets = reader.GetVector<uint64_t>("offsets");
  shard.blobs = reader.GetVector<uint8_t>("frames");
  reader.ExpectEnd();
  if (shard.first_index != first_index || shard.count() != count) {
    reader.Fail("frames", "expected " + std::to_string(count) + " from " +
                              std::to_string(first_index) + " on, found " +
                              std::to_string(shard.count()) + " from " +
                              std::to_string(shard.first_index));
  }
  if (shard.offsets.back() != shard.blobs.size() || shard.offsets.front() != 0 ||
      !std::is_sorted(shard.offsets.begin(), shard.offsets.end())) {
    reader.Fail("offsets", "expected to cover the frames' bytes in order");
  }
  return shard;
}

}  // namespace ossa::tools
