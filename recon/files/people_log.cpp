#include <algorithm>

#include "depth/base/atomic_file.h"
#include "recon/files/people_log_internal.h"
#include "recon/placed_joint.h"

namespace ossa::recon {

void PeopleLog::Append(const SkeletonFrame& frame) {
  for (const BodyRecord& body : frame.bodies) {
    const bool is_new = std::find(ids_.begin(), ids_.end(), body.id) == ids_.end();
    if (is_new && HasPlacedJoint(body)) ids_.push_back(body.id);
    seen_.try_emplace(body.id, folder_).first->second.Append(body, frame.time_s);
  }
  UpdatePresence(frame);
  times_s_.push_back(frame.time_s);
}

void PeopleLog::UpdatePresence(const SkeletonFrame& frame) {
  for (auto& [id, stays] : presence_) {
    const bool is_here = std::any_of(
        frame.bodies.begin(), frame.bodies.end(),
        [id = id](const BodyRecord& body) { return body.id == id && HasPlacedJoint(body); });
    if (!is_here && !stays.back().end_s) stays.back().end_s = frame.time_s;
  }
  for (const BodyRecord& body : frame.bodies) {
    if (!HasPlacedJoint(body)) continue;
    std::vector<PresenceInterval>& stays = presence_[body.id];
    if (stays.empty() || stays.back().end_s) stays.push_back({frame.time_s, std::nullopt});
  }
}

PeopleLog PeopleLog::First(int64_t frames) const {
  PeopleLog first(folder_);
  first.times_s_.assign(times_s_.begin(), times_s_.begin() + frames);
  const double end_s = first.times_s_.back();
  for (const int id : ids_) {
    const std::vector<PresenceInterval> stays = PresenceUntil(id, end_s);
    SightingLog seen = seen_.at(id).Until(end_s);
    if (stays.empty() || seen.size() == 0) continue;
    first.ids_.push_back(id);
    first.seen_.emplace(id, std::move(seen));
    first.presence_[id] = stays;
  }
  return first;
}

// Empty also for a person who first appears in the frame that was not fully appended.
std::vector<PresenceInterval> PeopleLog::PresenceUntil(int id, double end_s) const {
  const auto known = presence_.find(id);
  if (known == presence_.end()) return {};
  std::vector<PresenceInterval> stays;
  for (PresenceInterval stay : known->second) {
    if (stay.from_s > end_s) break;
    if (stay.end_s && *stay.end_s > end_s) stay.end_s.reset();
    stays.push_back(stay);
  }
  return stays;
}

void PeopleLog::LoadIntoMemory() {
  for (auto& [id, seen] : seen_) seen.LoadIntoMemory();
}

int64_t WriteWhatFits(PeopleLog& people, const std::function<void(const PeopleLog&)>& write) {
  people.LoadIntoMemory();
  for (int64_t frames = people.frame_count(); frames > 0; frames = frames * 3 / 4) {
    const PeopleLog first = people.First(frames);
    if (first.ids().empty()) return 0;
    try {
      write(first);
      return frames;
    } catch (const DiskFull&) {  // retry with fewer frames
    }
  }
  return 0;
}

}  // namespace ossa::recon
