#include <algorithm>

#include "depth/base/atomic_file.h"
#include "recon/files/people_log_internal.h"

namespace ossa::recon {
namespace {

bool IsSomewhere(const BodyRecord& body) {
  return std::any_of(body.joints.begin(), body.joints.end(),
                     [](const auto& joint) { return joint && HasPlace(*joint); });
}

}  // namespace

void PeopleLog::Append(const SkeletonFrame& frame) {
  for (const BodyRecord& body : frame.bodies) {
    const bool is_new = std::find(ids_.begin(), ids_.end(), body.id) == ids_.end();
    if (is_new && IsSomewhere(body)) ids_.push_back(body.id);
    seen_.try_emplace(body.id, folder_).first->second.Append(body, frame.time_s);
  }
  NoteStays(frame);
  times_s_.push_back(frame.time_s);
}

void PeopleLog::NoteStays(const SkeletonFrame& frame) {
  for (auto& [id, stays] : stays_) {
    const bool is_here = std::any_of(
        frame.bodies.begin(), frame.bodies.end(),
        [id = id](const BodyRecord& body) { return body.id == id && IsSomewhere(body); });
    if (!is_here && !stays.back().gone_s) stays.back().gone_s = frame.time_s;
  }
  for (const BodyRecord& body : frame.bodies) {
    if (!IsSomewhere(body)) continue;
    std::vector<Stay>& stays = stays_[body.id];
    if (stays.empty() || stays.back().gone_s) stays.push_back({frame.time_s, std::nullopt});
  }
}

double PeopleLog::BeginFor(int id) const {
  return std::min(times_s_.front(), seen_.at(id)[0].time_s);
}

PeopleLog PeopleLog::First(int64_t frames) const {
  PeopleLog first(folder_);
  first.times_s_.assign(times_s_.begin(), times_s_.begin() + frames);
  const double end_s = *std::max_element(first.times_s_.begin(), first.times_s_.end());
  for (const int id : ids_) {
    const std::vector<Stay> stays = StaysUntil(id, end_s);
    SightingLog seen = seen_.at(id).Until(end_s);
    if (stays.empty() || seen.size() == 0) continue;
    first.ids_.push_back(id);
    first.seen_.emplace(id, std::move(seen));
    first.stays_[id] = stays;
  }
  return first;
}

// None also of somebody who is new in the frame that was not appended whole.
std::vector<Stay> PeopleLog::StaysUntil(int id, double end_s) const {
  const auto known = stays_.find(id);
  if (known == stays_.end()) return {};
  std::vector<Stay> stays;
  for (Stay stay : known->second) {
    if (stay.from_s > end_s) break;
    if (stay.gone_s && *stay.gone_s > end_s) stay.gone_s.reset();
    stays.push_back(stay);
  }
  return stays;
}

void PeopleLog::LeaveDisk() {
  for (auto& [id, seen] : seen_) seen.LeaveDisk();
}

int64_t WriteWhatFits(PeopleLog& people, const std::function<void(const PeopleLog&)>& write) {
  people.LeaveDisk();
  for (int64_t frames = people.frame_count(); frames > 0; frames = frames * 3 / 4) {
    const PeopleLog first = people.First(frames);
    if (first.ids().empty()) return 0;
    try {
      write(first);
      return frames;
    } catch (const DiskFull&) {  // fewer, then
    }
  }
  return 0;
}

}  // namespace ossa::recon
