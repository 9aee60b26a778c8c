#include <algorithm>
#include <cmath>
#include <limits>
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

}  // namespace

void SightingLog::Append(const BodyRecord& body, double time_s) {
  if (size() > 0 && !(time_s > (*this)[size() - 1].time_s)) return;
  Packed packed{time_s, 0, {}};
  for (size_t j = 0; j < kJointCount; ++j) {
    const auto& joint = body.joints[j];
    if (!joint || !HasPlace(*joint)) continue;
    packed.seen |= uint64_t{1} << j;
    Eigen::Map<Vector3d>(&packed.position_m[3 * j]) = joint->position_m;
  }
  latest_.push_back(packed);
  // The last sighting stays in memory: the next one is compared with it.
  if (latest_.size() <= kBlock) return;
  if (!file_.is_open()) file_ = UnnamedFile(folder_);
  file_.WriteAt(in_file_ * sizeof(Packed), latest_.data(), kBlock * sizeof(Packed));
  latest_.erase(latest_.begin(), latest_.begin() + kBlock);
  in_file_ += kBlock;
}

SightingLog SightingLog::Until(double time_s) const {
  SightingLog until(folder_);
  for (size_t i = 0; i < size() && PackedAt(i).time_s <= time_s; ++i) {
    until.latest_.push_back(PackedAt(i));
  }
  return until;
}

void SightingLog::LoadIntoMemory() { *this = Until(std::numeric_limits<double>::infinity()); }

Sighting SightingLog::operator[](size_t index) const { return Unpacked(PackedAt(index)); }

const SightingLog::Packed& SightingLog::PackedAt(size_t index) const {
  if (index >= in_file_) return latest_[index - in_file_];
  const size_t begin = index - index % kBlock;
  if (block_.empty() || block_begin_ != begin) {
    block_.resize(kBlock);
    file_.ReadAt(begin * sizeof(Packed), block_.data(), kBlock * sizeof(Packed));
    block_begin_ = begin;
  }
  return block_[index - begin];
}

Sighting SightingLog::Unpacked(const Packed& packed) {
  Sighting sighting{packed.time_s, {}};
  for (size_t j = 0; j < kJointCount; ++j) {
    if ((packed.seen >> j & 1U) == 0) continue;
    sighting.joint[j] = Eigen::Map<const Vector3d>(&packed.position_m[3 * j]);
  }
  return sighting;
}

SightingLog CollectSightings(const SkeletonSequence& sequence, std::optional<int> id,
                             const std::filesystem::path& folder) {
  const int wanted = id ? *id : MostSeenBody(sequence);
  SightingLog sightings(folder);
  for (const SkeletonFrame& frame : sequence.frames) {
    for (const BodyRecord& body : frame.bodies) {
      if (body.id == wanted) sightings.Append(body, frame.time_s);
    }
  }
  if (sightings.size() == 0) {
    throw InputError(sequence.source + ": expected body " + std::to_string(wanted) +
                     ", found no frame of it");
  }
  return sightings;
}

EvenSightings::EvenSightings(const SightingLog& seen, double begin_s, double step_s)
    : seen_(seen), begin_s_(begin_s), step_s_(step_s) {}

double EvenSightings::Count() const {
  // Times with six decimals lag a few milliseconds behind the steps after an hour.
  constexpr double kRounded_steps = 0.1;
  return std::floor((seen_[seen_.size() - 1].time_s - begin_s_) / step_s_ + kRounded_steps) + 1.0;
}

SightingGap EvenSightings::LongestGap() const {
  SightingGap longest;
  double last_s = begin_s_;
  for (size_t i = 0; i < seen_.size(); ++i) {
    const double time_s = seen_[i].time_s;
    if (time_s - last_s > longest.length_s) longest = {last_s, time_s - last_s};
    last_s = time_s;
  }
  return longest;
}

Sighting EvenSightings::Next() {
  const double time_s = begin_s_ + static_cast<double>(step_++) * step_s_;
  while (after_ + 1 < seen_.size() && seen_[after_].time_s < time_s - kSameTime_s) ++after_;
  const Sighting next = seen_[after_];
  const Sighting last = seen_[after_ == 0 ? 0 : after_ - 1];
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
