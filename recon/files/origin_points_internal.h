#pragma once
#include <limits>
#include <set>

#include "recon/files/point_bodies_internal.h"

namespace ossa::recon {

/// Tells the two meanings of a point at the origin apart. Like the Kinect SDK 1, programs write the
/// origin for points that were not seen. Skeletons relative to a joint have that joint there: in
/// all frames, with all other points around it.
class OriginPoints {
 public:
  /// Takes the place of a point in one frame, metres.
  void Add(size_t point, const Eigen::Vector3d& place_m);
  /// The points to which all others are relative, by all places taken so far.
  std::set<size_t> FindRoots() const;

 private:
  std::set<size_t> at_origin_, elsewhere_;
  double nearest_m_ = std::numeric_limits<double>::infinity();  // of the points elsewhere
  double farthest_m_ = 0.0;
};

/// Removes points at the origin that are no root: they were not seen. `rows` is [frame][point],
/// metres.
void RemoveUnseenAtOrigin(std::vector<std::vector<SeenPoint>>& rows);

/// The same for the joints of a recording of one person.
void RemoveUnseenAtOrigin(SkeletonSequence& sequence);

}  // namespace ossa::recon
