#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "tools/people/geometry.h"
#include "tools/people/head_detector.h"
#include "tools/people/options.h"

// How a connected region is cut into pieces that may be one person each.
namespace ossa::people {

/// Where a piece begins, and how far it may go from there over the surface.
struct Seed {
  std::vector<int> cells;
  float reach_m = 0;
  const std::vector<uint8_t>* background = nullptr;  // 1: a cell that it enters by a rim only
};

/// Cuts a region into one piece per seed: each cell goes to the seed it is joined to by the
/// shortest way over the surface. Cells beyond reach go to nobody: a person ends somewhere, a sofa
/// does not.
std::vector<Region> SplitBySeeds(const PointGrid& grid, const Region& region,
                                 const std::vector<Seed>& seeds, const SeedOptions& options = {});

/// The disc around a head: it belongs to it before anything is measured over the surface.
std::vector<int> CollectHeadCells(const PointGrid& grid, const Region& region,
                                  const Eigen::Vector3f& head_m, const SeedOptions& options = {});

/// Who is in one region: tracks by the cells they held (`owner`, an index or -1 a cell), others by
/// the heads, best first. Tracks do not grow into `background` cells (1 = yes), which the result
/// refers to.
std::vector<Seed> FindSeeds(const PointGrid& grid, const Region& region,
                            std::span<const HeadBlob> heads, const std::vector<int>& owner,
                            size_t tracks, const std::vector<uint8_t>& background,
                            const CandidateOptions& options);

/// One piece per person. A seed whose piece could not be a person was no head: its piece goes back
/// to the others.
std::vector<Region> CutAtSeeds(const PointGrid& grid, const Region& region, std::vector<Seed> seeds,
                               const CandidateOptions& options);

/// Whether a region is large enough for a person, or for what shows of one who came into view where
/// the room behind was seen before (`foreground`, 1 a cell = yes).
bool IsPersonSized(const Region& region, const CandidateOptions& options);
bool IsForegroundPersonSized(const Region& region, const std::vector<uint8_t>& foreground,
                             const CandidateOptions& options);

}  // namespace ossa::people
