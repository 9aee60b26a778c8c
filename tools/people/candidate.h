#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "tools/people/decision.h"
#include "tools/people/geometry.h"
#include "tools/people/options.h"
#include "tools/people/track.h"

namespace ossa::people {

/// A segment of the scene that may be one person, by geometry and the tracks of earlier frames.
struct Candidate {
  std::vector<int32_t> pixels;       // v * width + u of the full image, ascending
  Region region;                     // on the grid
  int track = -1;                    // index of the track with which it overlaps, or -1
  int owner = -1;                    // index of the track that most of its cells belonged to, or -1
  std::vector<int> absorbed;         // other tracks that proved to be parts of the same person
  std::vector<int> may_return_as;    // lost tracks, as indices, that are expected near here
  bool recently_rejected = false;    // it had a low score in a recent frame
  bool holds_likely_person = false;  // what lately seemed a person alone is a part of it
  bool has_head = false;             // a head was detected in it by shape
  bool at_top = false;               // it reaches the image's upper border
  double flat_share = 0;             // share of its cells that lie on flat surface
  double foreground_share = 0;  // share of its cells in front of the known background; 0 where it
                                // may be part of a tracked person
  float foreground_m2 = 0;      // surface in front of the background, without its rims
  double background_share = 1;  // share of its cells that are certainly unchanged background; 1
                                // where the scene is not known
  bool isolated = true;         // no tracked person is beside it
  double occluded_share = 0;    // share of its silhouette beyond which a part may be occluded
  int region_index = -1;        // of the connected region that contains it
  std::optional<FlatPlane> plane{};  // where it is nearly planar
};

/// Whether most of it is foreground, i.e. in front of the known background.
inline bool IsForeground(const Candidate& candidate) {
  return candidate.foreground_share > kMajority;
}

/// Whether enough of it is not the room as it was.
inline bool StandsOut(const Candidate& candidate, const RestOptions& options) {
  return candidate.foreground_share > options.foreground_share ||
         candidate.background_share < options.background_share;
}

/// Whether a candidate may be a lost track that comes into view again, rather than a part of
/// `other` (IsRatherOf).
bool MayBeReturning(const PointGrid& grid, const Candidate& candidate, const Track& other,
                    const std::vector<Track>& tracks, double time_s,
                    const CandidateOptions& options);

/// A mask of the frame, row-major: 1 for these pixels (v * width + u).
std::vector<uint8_t> MaskPixels(const DepthFrame& frame, std::span<const int32_t> pixels);

/// The decision record of a region that was not classified.
Decision DescribeRegion(const Region& region, Rule rule);

/// A candidate with all its geometric attributes. `region_index`: of the connected region that
/// contains it; -1 for several.
Candidate MakeCandidate(const DepthFrame& frame, const Scene& scene, Region segment, bool has_head,
                        int region_index, const CandidateOptions& options);

/// Splits a candidate into one per head (camera space, metres), none with its track, without
/// segments too small for a person; returns it unchanged where fewer than two of the heads lie on
/// it.
std::vector<Candidate> SplitCandidate(const Scene& scene, const DepthFrame& frame,
                                      const Candidate& candidate,
                                      const std::vector<Eigen::Vector3d>& heads_m,
                                      const CandidateOptions& options);

/// Merges two candidates; the result continues the track of `a`, or of `b` where `a` has none.
Candidate MergeCandidates(const Scene& scene, const DepthFrame& frame, const Candidate& a,
                          const Candidate& b);

/// Whether two candidates share a rim: at a shirt's hem or a belt the depth jump is larger than
/// within a connected region.
bool MeetAlongRim(const Scene& scene, const Candidate& a, const Candidate& b,
                  const ClassificationOptions& options);

/// Whether one is nearly planar, as the back of a seat is, and the other is behind it; such a pair
/// is not merged, whatever its score.
bool Occludes(const Scene& scene, const Candidate& plane, const Candidate& person,
              const PlanarOccluderOptions& options);

struct Bone {
  Eigen::Vector3f from_m = Eigen::Vector3f::Zero(), to_m = Eigen::Vector3f::Zero();
};
/// Removes the cells that are farther than `reach_m` from every bone: furniture that touches the
/// person.
void CropToBones(const Scene& scene, const DepthFrame& frame, std::span<const Bone> bones,
                 float reach_m, size_t min_cropped_cells, Candidate& candidate);

}  // namespace ossa::people
