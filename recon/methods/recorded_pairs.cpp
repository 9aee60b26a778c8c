#include "recon/methods/recorded_pairs.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "recon/methods/person_internal.h"

namespace ossa::recon {
namespace {

constexpr double kSameTime_s = 0.02;
// Farther off than this the observation shows another limb; there is no offset to learn from it.
constexpr double kFarthestResidual_m = 0.5;

/// The truth frame of each observed frame, or null.
std::vector<const SkeletonFrame*> Matched(const SkeletonSequence& observed,
                                          const SkeletonSequence& truth) {
  std::map<int64_t, const SkeletonFrame*> by_number;
  std::map<double, const SkeletonFrame*> by_time;
  for (const SkeletonFrame& frame : truth.frames) {
    by_number[frame.frame] = &frame;
    by_time[frame.time_s] = &frame;
  }
  std::vector<const SkeletonFrame*> matched;
  size_t found = 0;
  for (const SkeletonFrame& frame : observed.frames) {
    const auto it = by_number.find(frame.frame);
    const bool same = it != by_number.end() &&
                      std::abs(it->second->time_s - frame.time_s) < 0.5;  // numbering that agrees
    matched.push_back(same ? it->second : nullptr);
    found += same ? 1 : 0;
  }
  if (found > 0) return matched;
  for (size_t i = 0; i < matched.size(); ++i) {
    const double time_s = observed.frames[i].time_s;
    const auto it = by_time.lower_bound(time_s - kSameTime_s);
    if (it != by_time.end() && it->first <= time_s + kSameTime_s) matched[i] = it->second;
  }
  return matched;
}

const BodyRecord* BodyOf(const SkeletonFrame& frame, int id) {
  for (const BodyRecord& body : frame.bodies) {
    if (body.id == id) return &body;
  }
  return frame.bodies.empty() ? nullptr : &frame.bodies.front();
}

}  // namespace

size_t AddPairs(const SkeletonSequence& observed, const SkeletonSequence& truth,
                std::vector<PosturePair>& pairs, int group) {
  const auto matched = Matched(observed, truth);
  const size_t before = pairs.size();
  std::map<int, Person> people;
  std::map<int, int> clips;
  for (size_t f = 0; f < matched.size(); ++f) {
    for (const BodyRecord& body : observed.frames[f].bodies) {
      const PreparedPosture prepared =
          people[body.id].Prepare({TrackedPostureOf(body), observed.frames[f].time_s, nullptr});
      const BodyRecord* true_body = matched[f] ? BodyOf(*matched[f], body.id) : nullptr;
      if (true_body == nullptr) continue;
      Posture truth_in_camera = prepared.in_camera;
      PosturePair pair;
      pair.group = group;
      double known = 0.0;
      for (size_t i = 0; i < kJointCount; ++i) {
        if (!true_body->joints[i] || prepared.present[i] == 0.0) continue;
        const Eigen::Vector3d& p = true_body->joints[i]->position_m;
        const double off_m = (p - prepared.in_camera.position_m[i]).norm();
        pair.worst_m = std::max(pair.worst_m, off_m);
        if (!(off_m < kFarthestResidual_m)) continue;
        truth_in_camera.position_m[i] = p;
        pair.known[i] = 1.0;
        known += 1.0;
      }
      if (known < 4.0) continue;
      pair.observed = prepared.scaled;
      pair.placement = prepared.placement;
      pair.scale = prepared.scale;
      pair.time_s = observed.frames[f].time_s;
      pair.clip = clips.try_emplace(body.id, static_cast<int>(pairs.size())).first->second;
      const Posture true_scaled =
          Scaled(Normalised(truth_in_camera, prepared.placement), 1.0 / prepared.scale);
      for (size_t i = 0; i < kJointCount; ++i) {
        pair.residual.position_m[i] = true_scaled.position_m[i] - prepared.scaled.position_m[i];
      }
      pairs.push_back(pair);
    }
  }
  return pairs.size() - before;
}

}  // namespace ossa::recon
