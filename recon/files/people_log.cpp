#include <algorithm>

#include "recon/files/people_log_internal.h"

namespace ossa::recon {
namespace {

bool IsSomewhere(const BodyRecord& body) {
  return std::any_of(body.joints.begin(), body.joints.end(),
                     [](const auto& joint) { return joint && HasPlace(*joint); });
}

}  // namespace

void PeopleLog::Append(const SkeletonFrame& frame) {
  if (!begin_s_) begin_s_ = frame.time_s;
  for (const BodyRecord& body : frame.bodies) {
    const bool is_new = std::find(ids_.begin(), ids_.end(), body.id) == ids_.end();
    if (is_new && IsSomewhere(body)) ids_.push_back(body.id);
    seen_.try_emplace(body.id, folder_).first->second.Append(body, frame.time_s);
  }
  NoteStays(frame);
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

double PeopleLog::BeginFor(int id) const { return std::min(*begin_s_, seen_.at(id)[0].time_s); }

}  // namespace ossa::recon
