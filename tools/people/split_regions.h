#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "tools/people/geometry.h"
#include "tools/people/head_detector.h"
#include "tools/people/options.h"

// Splitting a connected region into segments that may be one person each.
namespace ossa::people {

/// The start of a segment, and its largest extent over the surface.
struct Seed {
  std::vector<int> cells;
  float reach_m = 0;
  const std::vector<uint8_t>* background = nullptr;  // 1: a cell that it enters by a rim only
};

/// Splits a region into one segment per seed: each cell goes to the seed with the shortest path
/// over the surface. Cells beyond reach go to none, because a body is bounded and a sofa beside it
/// is not part of it.
std::vector<Region> SplitBySeeds(const PointGrid& grid, const Region& region,
                                 const std::vector<Seed>& seeds, const SeedOptions& options = {});

/// The cells around a head, which belong to it whatever their distance over the surface.
std::vector<int> CollectHeadCells(const PointGrid& grid, const Region& region,
                                  const Eigen::Vector3f& head_m, const SeedOptions& options = {});

/// The people in one region: tracks by their predicted cells (`owner`, an index or -1 per cell),
/// others by their heads, best first. Tracks do not grow into `background` cells (1 = yes), to
/// which the result refers.
std::vector<Seed> FindSeeds(const PointGrid& grid, const Region& region,
                            std::span<const HeadBlob> heads, const std::vector<int>& owner,
                            size_t tracks, const std::vector<uint8_t>& background,
                            const CandidateOptions& options);

/// One segment per person. A seed whose segment is too small for a person is dropped, and its cells
/// go to the other seeds. If no seed is a track's, connected parts beyond the reach of all seeds
/// follow as segments of their own if they are large enough for a person, whose head may not have
/// been detected.
std::vector<Region> CutAtSeeds(const PointGrid& grid, const Region& region, std::vector<Seed> seeds,
                               const CandidateOptions& options);

/// Whether a region is large enough for a person, or for the visible part of one who came into view
/// in front of known background (`foreground`, 1 per cell).
bool IsPersonSized(const Region& region, const CandidateOptions& options);
bool IsForegroundPersonSized(const Region& region, const std::vector<uint8_t>& foreground,
                             const CandidateOptions& options);

}  // namespace ossa::people
