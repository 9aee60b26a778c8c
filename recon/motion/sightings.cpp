#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "depth/base/error.h"
#include "recon/motion/sightings_internal.h"

namespace ossa::recon {
namespace {

using Eigen::Vector3d;

// Constants: rounding of printed times, by hand.

constexpr double kSameTime_s = 1e-6;

int MostSeenBody(const SkeletonSequence& sequence) {
  std::map<int, int> seen;
  for (const SkeletonFrame& frame : sequence.frames) {
    for (const BodyRecord& body : frame.bodies) ++seen[body.id];
  }
  const auto most = std::max_element(
      seen.begin(), seen.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  if (most == seen.end()) throw InputError(sequence.source + ": expected a body, found none");
  return most->first;
}

Sighting SightingIn(const BodyRecord& body, double time_s) {
  Sighting sighting{time_s, {}};
  for (size_t j = 0; j < kJointCount; ++j) {
    const auto& joint = body.joints[j];
    if (joint && HasPlace(*joint)) sighting.joint[j] = joint->position_m;
  }
  return sighting;
}

}  // namespace

std::vector<Sighting> SightingsOf(const SkeletonSequence& sequence, std::optional<int> id) {
  const int wanted = id ? *id : MostSeenBody(sequence);
  std::vector<Sighting> sightings;
  for (const SkeletonFrame& frame : sequence.frames) {
    for (const BodyRecord& body : frame.bodies) {
      // Times must go forward; a repeated frame brings nothing new.
      const bool later = sightings.empty() || frame.time_s > sightings.back().time_s;
      if (body.id == wanted && later) sightings.push_back(SightingIn(body, frame.time_s));
    }
  }
  if (sightings.empty()) {
    throw InputError(sequence.source + ": expected body " + std::to_string(wanted) +
                     ", found no frame of it");
  }
  return sightings;
}

EvenSightings::EvenSightings(std::vector<Sighting> seen, double begin_s, double step_s)
    : seen_(std::move(seen)), begin_s_(begin_s), step_s_(step_s) {}

double EvenSightings::Count() const {
  // Times of six decimals are a few milliseconds short of the step's after an hour.
  constexpr double kRounded_steps = 0.1;
  return std::floor((seen_.back().time_s - begin_s_) / step_s_ + kRounded_steps) + 1.0;
}

SightingGap EvenSightings::LongestGap() const {
  SightingGap longest;
  double last_s = begin_s_;
  for (const Sighting& sighting : seen_) {
    const double length_s = sighting.time_s - last_s;
    if (length_s > longest.length_s) longest = {last_s, length_s};
    last_s = sighting.time_s;
  }
  return longest;
}

Sighting EvenSightings::Next() {
  const double time_s = begin_s_ + static_cast<double>(step_++) * step_s_;
  while (after_ + 1 < seen_.size() && seen_[after_].time_s < time_s - kSameTime_s) ++after_;
  const Sighting& next = seen_[after_];
  const Sighting& last = seen_[after_ == 0 ? 0 : after_ - 1];
  const double gap_s = next.time_s - last.time_s;
  const double mix = gap_s > 0 ? std::clamp((time_s - last.time_s) / gap_s, 0.0, 1.0) : 1.0;
  Sighting sighting{time_s, {}};
  for (size_t j = 0; j < kJointCount; ++j) {
    if (last.joint[j] && next.joint[j]) {
      sighting.joint[j] = *last.joint[j] + mix * (*next.joint[j] - *last.joint[j]);
    } else {
      sighting.joint[j] = mix < 0.5 ? last.joint[j] : next.joint[j];
    }
  }
  return sighting;
}

}  // namespace ossa::recon
