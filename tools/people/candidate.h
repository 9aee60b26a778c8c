#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "tools/people/decision.h"
#include "tools/people/geometry.h"
#include "tools/people/options.h"

namespace ossa::people {

/// A piece of the scene that may be one person, by geometry and the tracks of the frames before.
struct Candidate {
  std::vector<int32_t> pixels;  // v * width + u of the full image, ascending
  Region region;                // on the grid
  int track = -1;               // index of the track that it continues by its cells, or -1
  std::vector<int> absorbed;    // other tracks that turned out to be parts of the same person
  bool may_return = false;      // a lost track is expected about here
  bool rejected = false;        // it scored low a moment ago
  bool has_head = false;        // its shape has something like a head on shoulders
  double flat_share = 0;        // of its cells that lie on flat pieces
  double foreground_share = 0;  // of its cells before a known background; 0 for what may be the
                                // rest of somebody who is seen
  float foreground_m2 = 0;      // the same as surface, without its rims
  bool isolated = true;         // nobody who is seen is beside it
  double occluded_share = 0;    // of its silhouette along which more of it may be out of sight
  int region_index = -1;        // the connected region that it is of
  std::optional<FlatPlane> plane{};  // of what is all but one plane
};

/// Whether most of it stands before a known background: it came into a known room.
inline bool IsForeground(const Candidate& candidate) {
  return candidate.foreground_share > kMostly;
}

/// A decision on what was not classified.
Decision DescribeRegion(const Region& region, Rule rule);

/// A piece of the scene with all that geometry says of it. `region_index`: of the connected region
/// that it is of; -1 for several.
Candidate MakeCandidate(const DepthFrame& frame, const Scene& scene, Region piece, bool has_head,
                        int region_index, const CandidateOptions& options);

/// A candidate cut into one for each of several heads (camera space, metres), without those too
/// small for a person; as it is where fewer than two of the heads lie on it.
std::vector<Candidate> SplitCandidate(const Scene& scene, const DepthFrame& frame,
                                      const Candidate& candidate,
                                      const std::vector<Eigen::Vector3d>& heads_m,
                                      const CandidateOptions& options);

/// Two candidates as one; it continues the track of `a`, or of `b` where `a` has none.
Candidate MergeCandidates(const Scene& scene, const DepthFrame& frame, const Candidate& a,
                          const Candidate& b);

/// Whether two candidates meet along a rim: at a shirt's hem or a belt the surface may jump by more
/// than connected surface does.
bool MeetAlongRim(const Scene& scene, const Candidate& a, const Candidate& b,
                  const ClassificationOptions& options);

/// Whether one is all but one plane, as the back of a seat is, and the other is behind it: they are
/// not one person, however they look together.
bool Occludes(const Scene& scene, const Candidate& plane, const Candidate& person,
              const PlanarOccluderOptions& options);

struct Bone {
  Eigen::Vector3f from_m, to_m;
};
/// Takes off a candidate what is farther than `reach_m` from every bone of the person in it: the
/// sofa that the person touches.
void CropToBones(const Scene& scene, const DepthFrame& frame, std::span<const Bone> bones,
                 float reach_m, size_t min_cropped_cells, Candidate& candidate);

}  // namespace ossa::people
