#include "tools/people/join_pieces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "tools/people/pose_evidence.h"
#include "tools/people/split_regions.h"

namespace ossa::people {
namespace {

// The index of the piece that each cell belongs to; -1 for none.
std::vector<int> LabelCells(const PointGrid& grid, const std::vector<Region>& pieces) {
  std::vector<int> label(static_cast<size_t>(grid.cells()), -1);
  for (size_t i = 0; i < pieces.size(); ++i) {
    for (const int cell : pieces[i].cells) label[static_cast<size_t>(cell)] = static_cast<int>(i);
  }
  return label;
}

// Calls `meets` with the label of each other piece along a direction until background behind both
// is seen. Adjacency is symmetrical, so two of the four directions are enough.
template <typename Meets>
void VisitAdjacent(const PointGrid& grid, const std::vector<int>& label, int from,
                   const std::array<int, 2>& direction, const JoinOptions& options,
                   const Meets& meets) {
  const int mine = label[static_cast<size_t>(from)];
  const float from_m = grid.z(from);
  const int reach = static_cast<int>(grid.CellsOf(options.occluder_m, from_m));
  float farthest_m = 0;  // largest depth so far
  for (int i = 1; i <= reach; ++i) {
    const int x = from % grid.width + i * direction[0], y = from / grid.width + i * direction[1];
    if (!grid.Contains(x, y)) return;
    const int cell = grid.cell(x, y);
    if (!grid.valid(cell)) continue;  // the shadow that the nearer surface casts
    const int other = label[static_cast<size_t>(cell)];
    if (other == mine) return;  // that cell continues the search
    const float here_m = grid.z(cell);
    if (other >= 0 && std::abs(here_m - from_m) < options.step_m &&
        farthest_m < std::max(from_m, here_m) + options.farther_m) {
      meets(mine, other);
    }
    farthest_m = std::max(farthest_m, here_m);
    if (farthest_m > from_m + options.step_m + options.farther_m) return;
  }
}

// Tries the largest pieces first.
Detection GrowFrom(const PointGrid& grid, const std::vector<Region>& pieces, size_t first,
                   const std::vector<std::vector<size_t>>& meeting, const ClassifyRegion& classify,
                   const JoinOptions& options, std::vector<uint8_t>& joined) {
  Detection whole = classify(pieces[first]);
  std::vector<uint8_t> tried(pieces.size(), 0);
  tried[first] = 1;
  std::vector<size_t> beside = meeting[first];
  for (size_t n = 0; n < beside.size(); ++n) {
    const size_t k = beside[n];
    const Region& body = whole.candidate.region;
    if (tried[k] || body.area_m2 + pieces[k].area_m2 > options.person_m2) continue;
    tried[k] = 1;
    Detection more = classify(UniteRegions(grid, body, pieces[k]));
    if (GetPersonScore(more) <= GetPersonScore(whole)) continue;
    whole = std::move(more);
    joined[k] = 1;
    if (pieces[k].area_m2 >= options.first_m2) joined[first] = 1;
    beside.insert(beside.end(), meeting[k].begin(), meeting[k].end());
  }
  return whole;
}

}  // namespace

double GetPersonScore(const Detection& detection) {
  const double score = detection.evidence.score;
  if (detection.verifier != Verifier::kSurfaceFit || !detection.pose) return score;
  return ComputeScoreWithPose(score, MeasureCertainty(*detection.pose));
}

std::vector<std::vector<size_t>> FindAdjacentPieces(const PointGrid& grid,
                                                    const std::vector<Region>& pieces,
                                                    const JoinOptions& options) {
  const std::vector<int> label = LabelCells(grid, pieces);
  std::vector<std::vector<size_t>> meeting(pieces.size());
  const auto meets = [&](int a, int b) {
    meeting[static_cast<size_t>(a)].push_back(static_cast<size_t>(b));
    meeting[static_cast<size_t>(b)].push_back(static_cast<size_t>(a));
  };
  for (const Region& piece : pieces) {
    for (const int cell : piece.cells) {
      VisitAdjacent(grid, label, cell, {1, 0}, options, meets);
      VisitAdjacent(grid, label, cell, {0, 1}, options, meets);
    }
  }
  for (std::vector<size_t>& others : meeting) {
    std::sort(others.begin(), others.end());
    others.erase(std::unique(others.begin(), others.end()), others.end());
  }
  return meeting;
}

bool IsCutByLowerBorder(const PointGrid& grid, const Region& region, const JoinOptions& options) {
  const int lowest = (grid.height - options.border_cells) * grid.width;
  return !region.cells.empty() && region.cells.back() >= lowest;
}

std::vector<Detection> GrowAcrossDepthEdges(const PointGrid& grid,
                                            const std::vector<Region>& pieces,
                                            const ClassifyRegion& classify,
                                            const CandidateOptions& options) {
  const auto meeting = FindAdjacentPieces(grid, pieces, options.join);
  std::vector<uint8_t> joined(pieces.size(), 0);
  std::vector<Detection> wholes;
  for (size_t i = 0; i < pieces.size(); ++i) {
    if (joined[i] || pieces[i].area_m2 < options.join.first_m2) continue;
    const bool is_cut_off =
        !IsPersonSized(pieces[i], options) && IsCutByLowerBorder(grid, pieces[i], options.join);
    if (meeting[i].empty() && !is_cut_off) continue;
    Detection whole = GrowFrom(grid, pieces, i, meeting, classify, options.join, joined);
    if (joined[i] || is_cut_off) wholes.push_back(std::move(whole));
  }
  return wholes;
}

}  // namespace ossa::people
