#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

#include "depth/base/unnamed_file.h"
#include "recon/motion/bvh.h"
#include "recon/skeleton_sequence.h"

namespace ossa::recon {

/// What was seen of a body at one time; empty joints were not.
struct Sighting {
  double time_s = 0.0;
  JointArray<std::optional<Eigen::Vector3d>> joint;
};

/// The sightings of one body, in order of their times, of which only the latest are in memory: an
/// hour is 53 MB.
class SightingLog {
 public:
  /// `folder`: on whose disk the others are.
  explicit SightingLog(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Nothing is done with one that is not later than the last: a repeated frame brings nothing new.
  /// Throws DiskFull.
  void Append(const BodyRecord& body, double time_s);
  size_t size() const { return in_file_ + latest_.size(); }
  /// Those until a time, in memory.
  SightingLog Until(double time_s) const;
  /// Takes all into memory: what they took on the disk is free.
  void LeaveDisk();
  /// One of them, by its number; quick where the one before or after was asked for last.
  Sighting operator[](size_t index) const;

 private:
  /// As it lies in the file.
  struct Packed {
    double time_s = 0.0;
    uint64_t seen = 0;  // a bit a joint
    std::array<double, size_t{3} * kJointCount> position_m{};
  };
  static constexpr size_t kBlock = 128;  // sightings, 64 kB: written and read at a time; by hand

  static Sighting Unpacked(const Packed& packed);
  const Packed& PackedAt(size_t index) const;

  std::filesystem::path folder_;
  UnnamedFile file_;
  size_t in_file_ = 0;  // sightings, whole blocks
  std::vector<Packed> latest_;
  mutable std::vector<Packed> block_;  // read last
  mutable size_t block_begin_ = 0;
};

/// Of the body `id`, without `id` of the one in most frames. Throws InputError when there is none.
SightingLog CollectSightings(const SkeletonSequence& sequence, std::optional<int> id,
                             const std::filesystem::path& folder);

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
  /// `seen` outlives it.
  EvenSightings(const SightingLog& seen, double begin_s, double step_s);

  /// How many steps there are; not a size_t, since damaged times make more than it holds.
  double Count() const;
  SightingGap LongestGap() const;
  const SightingLog& seen() const { return seen_; }
  /// The next one, Count() times.
  Sighting Next();

 private:
  const SightingLog& seen_;
  double begin_s_;
  double step_s_;
  size_t step_ = 0;
  size_t after_ = 0;  // the first in seen_ that is not before step_
};

/// WriteSkeletonAsBvh (bvh.h) of a body's sightings, from `begin_s` on.
void WriteSightingsAsBvh(const SightingLog& seen, double begin_s, const std::filesystem::path& path,
                         const BvhExportOptions& options);

}  // namespace ossa::recon
