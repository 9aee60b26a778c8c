#include "tools/synth/dataset.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>
#include <fstream>
#include <mutex>

#include "depth/base/error.h"
#include "depth/base/open_file.h"
#include "depth/image/depth_png.h"
#include "recon/body/parts.h"
#include "tools/synth/manifest_internal.h"
#include "tools/synth/shard_internal.h"

namespace ossa::tools {
namespace {

namespace fs = std::filesystem;

// Constants: by hand, for speed.

constexpr size_t kCachedShards = 6;  // several threads read neighbouring shards

fs::path ImagePath(const fs::path& folder, const char* kind, int64_t index) {
  char name[32];
  std::snprintf(name, sizeof(name), "%06lld.png", static_cast<long long>(index));
  return folder / kind / name;
}

std::vector<std::string> ReadTruthLines(const fs::path& path, int64_t expected) {
  std::ifstream file = OpenFile(path);
  if (!file) throw InputError(path.string() + ": cannot be read: expected the truth of a data set");
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(std::move(line));
  if (static_cast<int64_t>(lines.size()) != expected) {
    throw InputError(path.string() + ": expected " + std::to_string(expected) + " lines, found " +
                     std::to_string(lines.size()));
  }
  return lines;
}

depth::Image<uint8_t> ReadLabels(const fs::path& path, const depth::Camera& camera) {
  auto labels = depth::ReadLabelPng(path);
  if (labels.width != camera.width || labels.height != camera.height) {
    throw InputError(path.string() + ": expected the size in manifest.json, " +
                     std::to_string(camera.width) + "x" + std::to_string(camera.height));
  }
  return labels;
}

// Without users/ (allowed with one person a frame) every labelled pixel belongs to that person.
depth::Image<uint8_t> UsersFromParts(const LabelledFrame& frame, const std::string& place) {
  if (frame.bodies.size() > 1) throw InputError(place + ": missing, with several people in it");
  auto users = frame.parts;
  const auto id = static_cast<uint8_t>(frame.bodies.empty() ? 1 : frame.bodies[0].id);
  for (uint8_t& user : users.data) user = user > 0 && user <= recon::kPartCount ? id : 0;
  return users;
}

void CheckLabels(const LabelledFrame& frame, const std::string& place) {
  for (size_t i = 0; i < frame.parts.data.size(); ++i) {
    if (frame.parts.data[i] < recon::kLabelCount) continue;
    throw InputError(place + ": pixel " + std::to_string(i) + ": expected a part label below " +
                     std::to_string(recon::kLabelCount) + ", found " +
                     std::to_string(frame.parts.data[i]));
  }
}

}  // namespace

struct DatasetReader::State {
  fs::path folder;
  DatasetManifest manifest;
  std::vector<std::string> truth;  // of the PNG form

  std::mutex mutex;
  std::deque<std::shared_ptr<const Shard>> cache;  // most recently read first

  std::shared_ptr<const Shard> Get(int64_t number);
  LabelledFrame ReadPngs(int64_t index) const;
};

std::shared_ptr<const Shard> DatasetReader::State::Get(int64_t number) {
  const int64_t first = number * manifest.frames_per_shard;
  {
    const std::lock_guard lock(mutex);
    for (const auto& shard : cache) {
      if (shard->first_index == first) return shard;
    }
  }
  const int64_t count = std::min(manifest.frames_per_shard, manifest.frames - first);
  auto shard = std::make_shared<const Shard>(ReadShard(ShardPath(folder, number), first, count));
  const std::lock_guard lock(mutex);
  cache.push_front(shard);
  if (cache.size() > kCachedShards) cache.pop_back();
  return shard;
}

LabelledFrame DatasetReader::State::ReadPngs(int64_t index) const {
  LabelledFrame frame;
  const std::string place =
      (folder / "truth.jsonl").string() + ": line " + std::to_string(index + 1);
  ParseTruthLine(truth[static_cast<size_t>(index)], place, &frame);
  if (frame.depth.index != index) {
    throw InputError(place + ": expected frame " + std::to_string(index) + ", found " +
                     std::to_string(frame.depth.index));
  }
  frame.depth.camera = manifest.camera;
  const auto depth_path = ImagePath(folder, "depth", index);
  auto depth = depth::ReadDepthPng(depth_path);
  if (depth.width != manifest.camera.width || depth.height != manifest.camera.height) {
    throw InputError(depth_path.string() + ": expected the size in manifest.json");
  }
  frame.depth.depth_mm = std::move(depth.data);
  frame.parts = ReadLabels(ImagePath(folder, "parts", index), manifest.camera);
  const auto users_path = ImagePath(folder, "users", index);
  frame.users = fs::exists(users_path) ? ReadLabels(users_path, manifest.camera)
                                       : UsersFromParts(frame, users_path.string());
  CheckLabels(frame, ImagePath(folder, "parts", index).string());
  return frame;
}

bool IsDataset(const fs::path& folder) {
  std::error_code ignored;
  return fs::is_regular_file(folder / "manifest.json", ignored);
}

bool IsUnfinishedDataset(const fs::path& folder) {
  std::error_code ignored;
  return !IsDataset(folder) && fs::is_regular_file(folder / kWorkFolder / kPlanFile, ignored);
}

DatasetReader::DatasetReader(const fs::path& folder) : state_(std::make_unique<State>()) {
  if (!fs::is_directory(folder)) {
    throw InputError(folder.string() + ": expected the folder of a data set, found none");
  }
  state_->folder = folder;
  state_->manifest = ReadManifest(folder);
  if (!state_->manifest.packed) {
    state_->truth = ReadTruthLines(folder / "truth.jsonl", state_->manifest.frames);
  }
}

DatasetReader::~DatasetReader() = default;
DatasetReader::DatasetReader(DatasetReader&&) noexcept = default;
DatasetReader& DatasetReader::operator=(DatasetReader&&) noexcept = default;

const DatasetManifest& DatasetReader::manifest() const { return state_->manifest; }

LabelledFrame DatasetReader::Read(int64_t index) const {
  if (index < 0 || index >= frame_count()) {
    throw InputError(state_->folder.string() + ": frame " + std::to_string(index) +
                     ": expected one of " + std::to_string(frame_count()));
  }
  if (!state_->manifest.packed) return state_->ReadPngs(index);
  const auto shard = state_->Get(index / state_->manifest.frames_per_shard);
  LabelledFrame frame = UnpackFrame(*shard, index);
  CheckLabels(frame, shard->file + ": frame " + std::to_string(index));
  return frame;
}

LabelledFrame Uncropped(const LabelledFrame& frame, const depth::Camera& of_data_set) {
  const depth::Camera& whole = frame.whole ? *frame.whole : of_data_set;
  const depth::Camera& crop = frame.depth.camera;
  if (crop.width > whole.width || crop.height > whole.height) return frame;
  const auto offset = [](double whole_centre, double crop_centre, int slack) {
    return std::clamp(static_cast<int>(std::lround(whole_centre - crop_centre)), 0, slack);
  };
  const int u0 = offset(whole.cx, crop.cx, whole.width - crop.width);
  const int v0 = offset(whole.cy, crop.cy, whole.height - crop.height);
  LabelledFrame out;
  out.depth.camera = crop;
  out.depth.camera.width = whole.width;
  out.depth.camera.height = whole.height;
  out.depth.camera.cx += u0;
  out.depth.camera.cy += v0;
  out.depth.time_s = frame.depth.time_s;
  out.depth.index = frame.depth.index;
  const auto pasted = [&](const auto& from, auto into) {
    into.resize(static_cast<size_t>(whole.width) * static_cast<size_t>(whole.height));
    for (int v = 0; v < crop.height; ++v) {
      std::copy_n(from.begin() + static_cast<ptrdiff_t>(v) * crop.width, crop.width,
                  into.begin() + static_cast<ptrdiff_t>(v + v0) * whole.width + u0);
    }
    return into;
  };
  out.depth.depth_mm = pasted(frame.depth.depth_mm, std::vector<uint16_t>());
  for (const auto& [from, into] :
       {std::pair(&frame.parts, &out.parts), {&frame.users, &out.users}}) {
    *into = depth::Image<uint8_t>(whole.width, whole.height);
    into->data = pasted(from->data, std::vector<uint8_t>());
  }
  out.bodies = frame.bodies;
  out.floor = frame.floor;
  return out;
}

}  // namespace ossa::tools
