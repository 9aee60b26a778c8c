#include "tools/people/candidate.h"

#include <algorithm>
#include <cmath>

#include "depth/scene/region_pixels.h"
#include "depth/scene/silhouette.h"
#include "tools/people/planar_occluder.h"
#include "tools/people/split_regions.h"
#include "tools/people/track_prediction.h"

namespace ossa::people {

using Eigen::Vector3f;

bool MayBeReturning(const PointGrid& grid, const Candidate& candidate, const Track& other,
                    const std::vector<Track>& tracks, double time_s,
                    const CandidateOptions& options) {
  return std::any_of(candidate.may_return_as.begin(), candidate.may_return_as.end(), [&](int lost) {
    return IsRatherOf(grid, candidate.region, tracks[static_cast<size_t>(lost)], other, time_s,
                      options);
  });
}

std::vector<uint8_t> MaskPixels(const DepthFrame& frame, std::span<const int32_t> pixels) {
  std::vector<uint8_t> mask(frame.pixel_count(), 0);
  for (const int32_t pixel : pixels) mask[static_cast<size_t>(pixel)] = 1;
  return mask;
}

Decision DescribeRegion(const Region& region, Rule rule) {
  Decision decision;
  decision.rule = rule;
  decision.place_m = region.mean_m.cast<double>();
  decision.size_m = (region.high_m - region.low_m).cast<double>();
  decision.area_m2 = static_cast<double>(region.area_m2);
  return decision;
}

namespace {

bool IsAtTop(const Scene& scene, const Region& region) {
  constexpr int kBorder = 3;  // cells, by hand: sensors leave rows out
  return !region.cells.empty() && region.cells.front() < kBorder * scene.grid.width;
}

}  // namespace

Candidate MakeCandidate(const DepthFrame& frame, const Scene& scene, Region piece, bool has_head,
                        int region_index, const CandidateOptions& options) {
  const auto& foreground = scene.background.foreground;
  Candidate candidate;
  candidate.pixels = CollectPixels(frame, scene.grid, piece);
  candidate.has_head = has_head;
  candidate.flat_share = MeasureShare(piece, scene.surfaces.flat);
  candidate.plane = FitWholePlane(piece, scene.surfaces, options.occluder);
  candidate.foreground_share = MeasureShare(piece, foreground);
  candidate.foreground_m2 = MeasureForegroundArea_m2(scene.grid, piece.cells, foreground);
  if (scene.background.certain_share > kMajority)
    candidate.background_share = MeasureShare(piece, scene.background.certain);
  candidate.occluded_share =
      depth::MeasureOccludedShare(scene.grid, scene.floor, piece, options.silhouette);
  candidate.region_index = region_index;
  candidate.at_top = IsAtTop(scene, piece);
  candidate.region = std::move(piece);
  return candidate;
}

std::vector<Candidate> SplitCandidate(const Scene& scene, const DepthFrame& frame,
                                      const Candidate& candidate,
                                      const std::vector<Eigen::Vector3d>& heads_m,
                                      const CandidateOptions& options) {
  std::vector<Seed> seeds;
  for (const auto& head_m : heads_m) {
    auto cells =
        CollectHeadCells(scene.grid, candidate.region, head_m.cast<float>(), options.seeds);
    if (!cells.empty()) seeds.push_back({std::move(cells), options.seeds.max_reach_m, nullptr});
  }
  if (seeds.size() < 2) return {candidate};
  std::vector<Candidate> pieces;
  for (Region& piece : SplitBySeeds(scene.grid, candidate.region, seeds, options.seeds)) {
    if (!IsPersonSized(piece, options)) continue;
    Candidate part;
    part.pixels = CollectPixels(frame, scene.grid, piece);
    part.recently_rejected = candidate.recently_rejected;
    part.has_head = true;
    part.region_index = candidate.region_index;
    part.flat_share = candidate.flat_share;
    part.foreground_share = candidate.foreground_share;
    part.background_share = candidate.background_share;
    part.isolated = candidate.isolated;
    part.occluded_share = candidate.occluded_share;
    part.at_top = IsAtTop(scene, piece);
    part.region = std::move(piece);
    pieces.push_back(std::move(part));
  }
  return pieces;
}

Candidate MergeCandidates(const Scene& scene, const DepthFrame& frame, const Candidate& a,
                          const Candidate& b) {
  const auto cells = [](const Candidate& c) { return static_cast<double>(c.region.cells.size()); };
  Candidate whole;
  whole.region = UniteRegions(scene.grid, a.region, b.region);
  whole.pixels = CollectPixels(frame, scene.grid, whole.region);
  whole.track = a.track >= 0 ? a.track : b.track;
  whole.absorbed = a.absorbed;
  whole.absorbed.insert(whole.absorbed.end(), b.absorbed.begin(), b.absorbed.end());
  if (a.track >= 0 && b.track >= 0) whole.absorbed.push_back(b.track);
  whole.has_head = a.has_head || b.has_head;
  const double of_a = cells(a) / std::max(1.0, cells(a) + cells(b));
  whole.flat_share = of_a * a.flat_share + (1 - of_a) * b.flat_share;
  whole.foreground_share = of_a * a.foreground_share + (1 - of_a) * b.foreground_share;
  whole.foreground_m2 = a.foreground_m2 + b.foreground_m2;
  whole.background_share = of_a * a.background_share + (1 - of_a) * b.background_share;
  whole.may_return_as = a.may_return_as;
  whole.may_return_as.insert(whole.may_return_as.end(), b.may_return_as.begin(),
                             b.may_return_as.end());
  whole.isolated = a.isolated && b.isolated;
  whole.occluded_share = of_a * a.occluded_share + (1 - of_a) * b.occluded_share;
  whole.region_index = a.region_index;
  whole.at_top = a.at_top || b.at_top;
  return whole;
}

bool MeetAlongRim(const Scene& scene, const Candidate& a, const Candidate& b,
                  const ClassificationOptions& options) {
  const PointGrid& grid = scene.grid;
  const int reach = options.rim_cells;
  std::vector<uint8_t> of_b(static_cast<size_t>(grid.cells()), 0);
  for (const int cell : b.region.cells) of_b[static_cast<size_t>(cell)] = 1;
  const auto meets = [&](int cell) {
    const int x = cell % grid.width, y = cell / grid.width;
    for (int dy = -reach; dy <= reach; ++dy) {
      for (int dx = -reach; dx <= reach; ++dx) {
        if (!grid.Contains(x + dx, y + dy)) continue;
        const int other = grid.cell(x + dx, y + dy);
        if (of_b[static_cast<size_t>(other)] &&
            std::abs(grid.z(other) - grid.z(cell)) < options.rim_jump_m)
          return true;
      }
    }
    return false;
  };
  // Each column of the rim is counted for up to `reach` cells, one above the other.
  const auto rim = std::count_if(a.region.cells.begin(), a.region.cells.end(), meets);
  return static_cast<float>(rim) >
         static_cast<float>(reach) * grid.CellsOf(options.rim_m, a.region.mean_m.z());
}

bool Occludes(const Scene& scene, const Candidate& plane, const Candidate& person,
              const PlanarOccluderOptions& options) {
  return plane.plane && StandsBehind(scene.grid, person.region, *plane.plane, options);
}

void CropToBones(const Scene& scene, const DepthFrame& frame, std::span<const Bone> bones,
                 float reach_m, size_t min_cropped_cells, Candidate& candidate) {
  std::vector<int> kept;
  for (const int cell : candidate.region.cells) {
    const Vector3f& p = scene.grid.at(cell);
    const bool near = std::any_of(bones.begin(), bones.end(), [&](const Bone& bone) {
      const Vector3f along = bone.to_m - bone.from_m;
      const float share = (p - bone.from_m).dot(along) / std::max(1e-6F, along.squaredNorm());
      const Vector3f nearest = bone.from_m + std::clamp(share, 0.0F, 1.0F) * along;
      return (p - nearest).squaredNorm() < reach_m * reach_m;
    });
    if (near) kept.push_back(cell);
  }
  if (kept.size() + min_cropped_cells > candidate.region.cells.size() ||
      kept.size() < min_cropped_cells)
    return;
  candidate.region = MakeRegion(scene.grid, std::move(kept));
  candidate.pixels = CollectPixels(frame, scene.grid, candidate.region);
}

}  // namespace ossa::people
