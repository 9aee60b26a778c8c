#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "recon/skeleton_sequence.h"

namespace ossa::recon {

/// What was seen of a body at one time; empty joints were not.
struct Sighting {
  double time_s = 0.0;
  JointArray<std::optional<Eigen::Vector3d>> joint;
};

/// Of the body `id`, without `id` of the one in most frames; their times grow. Throws InputError
/// when there is none.
std::vector<Sighting> SightingsOf(const SkeletonSequence& sequence, std::optional<int> id);

/// The longest time without a sighting.
struct SightingGap {
  double begin_s = 0.0;
  double length_s = 0.0;
};

/// A body at even steps of time from `begin_s` to its last sighting, made one at a time: a day of
/// them is gigabytes. Between two sightings joints move straight and evenly; before the first all
/// is as in it.
class EvenSightings {
 public:
  EvenSightings(std::vector<Sighting> seen, double begin_s, double step_s);

  /// How many steps there are; not a size_t, since damaged times make more than it holds.
  double Count() const;
  SightingGap LongestGap() const;
  const std::vector<Sighting>& seen() const { return seen_; }
  /// The next one, Count() times.
  Sighting Next();

 private:
  std::vector<Sighting> seen_;
  double begin_s_;
  double step_s_;
  size_t step_ = 0;
  size_t after_ = 0;  // the first in seen_ that is not before step_
};

}  // namespace ossa::recon
