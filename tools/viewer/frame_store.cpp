#include <utility>

#include "recon/files/skeleton_jsonl.h"
#include "tools/viewer/find_parts_internal.h"
#include "tools/viewer/frame_store_internal.h"

namespace ossa::viewer {

FrameStore::FrameStore(bool keeps, std::shared_ptr<const forest::ForestModel> forest,
                       std::shared_ptr<const recon::BodyMesh> body)
    : forest_(std::move(forest)),
      body_(std::move(body)),
      spools_(keeps ? std::make_unique<Spools>() : nullptr) {}

void FrameStore::Add(DisplayFrame display) {
  if (!keeps()) {
    auto newest = std::make_shared<const DisplayFrame>(std::move(display));
    const std::lock_guard lock(mutex_);
    newest_.swap(newest);
    packed_.reset();
    ++count_.frames;
    return;
  }
  const PackedFrame packed = Pack(display, display.parts, body_.get());
  const std::string line = recon::SkeletonJsonLine(display.skeletons());
  const std::lock_guard lock(mutex_);
  spools_->frames.Append(packed.members + packed.pictures + packed.meshes);
  spools_->lines.Append(line);
  spools_->kept.push_back({packed.width, packed.height, packed.planes, packed.members.size(),
                           packed.pictures.size(), display.skeletons().time_s});
  for (const FittedBody& fit : display.fits) shapes_[fit.id] = fit.pose.shape;
  ++count_.frames;
}

void FrameStore::Complete() {
  const std::lock_guard lock(mutex_);
  count_.complete = true;
}

void FrameStore::Clear() {
  const std::lock_guard lock(mutex_);
  count_ = {.frames = 0, .generation = count_.generation + 1, .complete = false};
  newest_.reset();
  packed_.reset();
  shapes_.clear();
  if (!keeps()) return;
  spools_->frames.Clear();
  spools_->lines.Clear();
  spools_->kept.clear();
}

FrameStore::Count FrameStore::count() const {
  const std::lock_guard lock(mutex_);
  return count_;
}

std::shared_ptr<const PackedFrame> FrameStore::ReadKept(int64_t number) const {
  const auto i = static_cast<size_t>(number);
  const Kept& kept = spools_->kept[i];
  auto packed = std::make_shared<PackedFrame>();
  packed->width = kept.width;
  packed->height = kept.height;
  packed->planes = kept.planes;
  std::string record = spools_->frames.Read(i);
  packed->pictures = record.substr(kept.members, kept.pictures);
  packed->meshes = record.substr(kept.members + kept.pictures);
  record.resize(kept.members);
  packed->members = std::move(record);
  return packed;
}

PackedFrame FrameStore::PackWithParts(const DisplayFrame& display) const {
  const bool are_wanted = forest_ && display.is_upright && display.parts.data.empty() &&
                          display.users.data.size() == display.depth.depth_mm.size();
  if (!are_wanted) return Pack(display, display.parts, body_.get());
  return Pack(display, FindParts(*forest_, display.depth, display.users), body_.get());
}

std::shared_ptr<const PackedFrame> FrameStore::At(int64_t& number) const {
  std::shared_ptr<const DisplayFrame> newest;
  {
    const std::lock_guard lock(mutex_);
    if (keeps()) return number >= 0 && number < count_.frames ? ReadKept(number) : nullptr;
    number = count_.frames - 1;
    if (packed_ || !newest_) return packed_;
    newest = newest_;
  }
  // Outside the lock, which would block the tracker at its next frame.
  auto packed = std::make_shared<const PackedFrame>(PackWithParts(*newest));
  const std::lock_guard lock(mutex_);
  if (newest == newest_) packed_ = packed;
  return packed;
}

std::string FrameStore::Line(int64_t number) const {
  const std::lock_guard lock(mutex_);
  if (!keeps()) return newest_ ? recon::SkeletonJsonLine(newest_->skeletons()) : std::string();
  if (number < 0 || number >= count_.frames) return {};
  return spools_->lines.Read(static_cast<size_t>(number));
}

std::map<int, recon::ShapeVector> FrameStore::shapes() const {
  const std::lock_guard lock(mutex_);
  return shapes_;
}

double FrameStore::TimeOf(int64_t number) const {
  const std::lock_guard lock(mutex_);
  const bool known = keeps() && number >= 0 && number < count_.frames;
  return known ? spools_->kept[static_cast<size_t>(number)].time_s : 0.0;
}

}  // namespace ossa::viewer
