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

/// The joints of a body seen at one time; unseen joints are empty.
struct Sighting {
  double time_s = 0.0;
  JointArray<std::optional<Eigen::Vector3d>> joint;
};

/// The sightings of one body in order of time. Only the latest are in memory: an hour takes 53 MB.
class SightingLog {
 public:
  /// `folder`: its disk holds the others.
  explicit SightingLog(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Ignores sightings that are not later than the last one: repeated frames add nothing. Throws
  /// DiskFull.
  void Append(const BodyRecord& body, double time_s);
  size_t size() const { return in_file_ + latest_.size(); }
  /// The sightings up to a time, in memory.
  SightingLog Until(double time_s) const;
  /// Moves everything into memory and frees the disk space.
  void LoadIntoMemory();
  /// A sighting by index; fast if adjacent to the last one accessed.
  Sighting operator[](size_t index) const;

 private:
  /// File format.
  struct Packed {
    double time_s = 0.0;
    uint64_t seen = 0;  // one bit per joint
    std::array<double, size_t{3} * kJointCount> position_m{};
  };
  static constexpr size_t kBlock = 128;  // sightings per I/O block, 64 kB; by hand

  static Sighting Unpacked(const Packed& packed);
  const Packed& PackedAt(size_t index) const;

  std::filesystem::path folder_;
  UnnamedFile file_;
  size_t in_file_ = 0;  // number of sightings in the file, whole blocks
  std::vector<Packed> latest_;
  mutable std::vector<Packed> block_;  // last block read
  mutable size_t block_begin_ = 0;
};

/// The sightings of body `id`, or of the body in most frames. Throws InputError if there is none.
SightingLog CollectSightings(const SkeletonSequence& sequence, std::optional<int> id,
                             const std::filesystem::path& folder);

/// The longest interval without a sighting.
struct SightingGap {
  double begin_s = 0.0;
  double length_s = 0.0;
};

/// A body at equal time steps from `begin_s` to its last sighting, generated one at a time: a day
/// of them would be gigabytes. Joints are interpolated linearly; before the first sighting they are
/// constant.
class EvenSightings {
 public:
  /// `seen` must outlive it.
  EvenSightings(const SightingLog& seen, double begin_s, double step_s);

  /// Number of steps; a double, because damaged times may exceed size_t.
  double Count() const;
  SightingGap LongestGap() const;
  const SightingLog& seen() const { return seen_; }
  /// The next step; call it Count() times.
  Sighting Next();

 private:
  const SightingLog& seen_;
  double begin_s_;
  double step_s_;
  size_t step_ = 0;
  size_t after_ = 0;  // first index in seen_ not before step_
};

/// WriteSkeletonAsBvh (bvh.h) of a body's sightings, from `begin_s` on.
void WriteSightingsAsBvh(const SightingLog& seen, double begin_s, const std::filesystem::path& path,
                         const BvhExportOptions& options);

}  // namespace ossa::recon
