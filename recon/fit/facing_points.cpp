#include "recon/fit/facing_points_internal.h"

#include <algorithm>
#include <cstring>
#include <limits>

#include "depth/base/cpu_dispatch.h"
#include "depth/base/lanes.h"
#include "recon/body/parts.h"

namespace ossa::recon {
namespace {

constexpr float kFarAway_m = 1e6F;  // derived: farther than any sensor sees
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Adjacent parts, by the labels of Shotton et al. 2011 (recon/body/parts.h).
constexpr std::array<std::array<uint8_t, 2>, 40> kTouching = {
    {{1, 2},   {1, 3},   {2, 4},   {3, 4},   {3, 5},   {4, 5},   {5, 6},   {5, 7},
     {5, 18},  {5, 19},  {6, 8},   {6, 18},  {8, 12},  {12, 10}, {10, 14}, {14, 16},
     {7, 9},   {7, 19},  {9, 13},  {13, 11}, {11, 15}, {15, 17}, {18, 19}, {18, 20},
     {19, 21}, {20, 21}, {20, 22}, {21, 23}, {22, 23}, {22, 26}, {26, 24}, {24, 28},
     {28, 30}, {23, 27}, {27, 25}, {25, 29}, {29, 31}, {8, 18},  {9, 19},  {16, 14}}};

// Bit mask of each part: itself and the parts adjacent to it.
constexpr std::array<uint32_t, kPartCount + 1> kAdjacent = [] {
  std::array<uint32_t, kPartCount + 1> adjacent{};
  for (uint32_t i = 0; i < adjacent.size(); ++i) adjacent[i] = uint32_t{1} << i;
  for (const auto& [a, b] : kTouching) {
    adjacent[a] |= uint32_t{1} << b;
    adjacent[b] |= uint32_t{1} << a;
  }
  return adjacent;
}();

// Coordinates of kLanes points.
struct PlaceLanes {
  Lanes x, y, z;

  PlaceLanes(const FacingPoints::Places& places_m, size_t first) {
    LoadLanes(places_m[0].data() + first, &x);
    LoadLanes(places_m[1].data() + first, &y);
    LoadLanes(places_m[2].data() + first, &z);
  }
};

// A query point, and the distance penalties.
struct Search {
  float x_m, y_m, z_m;
  uint8_t part;  // query part; 0: any
  float adjacent_m2, other_m2;
};

// The nearest point so far.
struct Found {
  float square_m2 = kInfinity;
  int32_t point = -1;
};

[[gnu::always_inline]] inline float Least(const Lanes& lanes) {
  Lanes of = lanes, other = __builtin_shufflevector(of, of, 4, 5, 6, 7, 0, 1, 2, 3);
  of = other < of ? other : of;
  other = __builtin_shufflevector(of, of, 2, 3, 0, 1, 6, 7, 4, 5);
  of = other < of ? other : of;
  other = __builtin_shufflevector(of, of, 1, 0, 3, 2, 5, 4, 7, 6);
  of = other < of ? other : of;
  return of[0];
}

// Searches the points of a run. `more` is added to each squared distance.
[[gnu::always_inline]] inline void SearchRun(const FacingPoints::Places& places_m,
                                             const FacingPoints::Run& run, const Search& search,
                                             float more, Found* found) {
  Lanes least = Lanes{} + kInfinity;
  IntLanes number{};
  const auto count = static_cast<int32_t>(run.end - run.begin);
  for (int32_t i = 0; i < count; i += static_cast<int32_t>(kLanes)) {
    const PlaceLanes at(places_m, run.first_place + static_cast<size_t>(i));
    const Lanes x = at.x - search.x_m, y = at.y - search.y_m, z = at.z - search.z_m;
    const Lanes square = x * x + (y * y + z * z);
    const IntLanes nearer = square < least;
    least = nearer ? square : least;
    number = nearer ? IntLanes{} + i : number;
  }
  const float square = Least(least);
  if (square + more >= found->square_m2) return;
  found->square_m2 = square + more;
  size_t l = 0;
  while (least[l] != square) ++l;
  found->point = static_cast<int32_t>(run.begin + l) + number[l];
}

// Adds the squared distance of a coordinate from each interval.
[[gnu::always_inline]] inline void AddBeyond(const Lanes& low, const Lanes& high, float at,
                                             Lanes* squares) {
  const Lanes below = low - at, above = at - high;
  Lanes off = below > above ? below : above;
  off = off > 0.0F ? off : Lanes{};
  *squares += off * off;
}

// The penalty of each run's part. The pixel's own part was searched already.
[[gnu::always_inline]] inline void CountFarther(const Search& search, uint32_t adjacent,
                                                const IntLanes& part, Lanes* more) {
  *more = Lanes{};
  if (search.part == 0) return;
  const IntLanes touches = ((IntLanes{} + static_cast<int32_t>(adjacent)) >> part) & 1;
  *more = touches != 0 ? Lanes{} + search.adjacent_m2 : Lanes{} + search.other_m2;
  *more = part == static_cast<int32_t>(search.part) ? Lanes{} + kInfinity : *more;
}

[[gnu::always_inline]] inline bool IsAny(const IntLanes& lanes) {
  std::array<uint64_t, sizeof(IntLanes) / sizeof(uint64_t)> halves;
  std::memcpy(halves.data(), &lanes, sizeof(lanes));
  return (halves[0] | halves[1] | halves[2] | halves[3]) != 0;
}

OSSA_CPU_DISPATCH int32_t FindNearest(const FacingPoints::Places& places_m,
                                      const FacingPoints::Runs& runs, const Search& search,
                                      uint32_t adjacent) {
  Found found;
  // The pixel's own part first: a near point there prunes most other parts.
  for (const FacingPoints::Run& run : runs.runs) {
    if (run.part == search.part) SearchRun(places_m, run, search, 0.0F, &found);
  }
  for (size_t first = 0; first < runs.runs.size(); first += kLanes) {
    const PlaceLanes low(runs.low_m, first), high(runs.high_m, first);
    IntLanes part;
    std::memcpy(&part, runs.part.data() + first, sizeof(part));
    Lanes more;
    CountFarther(search, adjacent, part, &more);
    Lanes bound = more;
    AddBeyond(low.x, high.x, search.x_m, &bound);
    AddBeyond(low.y, high.y, search.y_m, &bound);
    AddBeyond(low.z, high.z, search.z_m, &bound);
    if (!IsAny(bound < found.square_m2)) continue;
    for (size_t l = 0; l < kLanes && first + l < runs.runs.size(); ++l) {
      if (bound[l] < found.square_m2) {
        SearchRun(places_m, runs.runs[first + l], search, more[l], &found);
      }
    }
  }
  return found.point;
}

void FillLanes(FacingPoints::Places* places_m) {
  for (auto& of_axis : *places_m) of_axis.resize(PaddedToLanes(of_axis.size()), kFarAway_m);
}

}  // namespace

void FacingPoints::Runs::Clear() {
  runs.clear();
  part.clear();
  for (Places* places_m : {&low_m, &high_m}) {
    for (auto& of_axis : *places_m) of_axis.clear();
  }
}

void FacingPoints::Runs::Add(const Run& run, const Places& places_m) {
  runs.push_back(run);
  part.push_back(run.part);
  for (size_t axis = 0; axis < places_m.size(); ++axis) {
    const auto first = places_m[axis].begin() + static_cast<std::ptrdiff_t>(run.first_place);
    const auto [low, high] =
        std::minmax_element(first, first + static_cast<std::ptrdiff_t>(run.end - run.begin));
    low_m[axis].push_back(*low);
    high_m[axis].push_back(*high);
  }
}

void FacingPoints::Gather(const PosedSurface& posed) {
  points_.clear();
  runs_.Clear();
  for (auto& of_axis : places_m_) of_axis.clear();
  const auto& points = posed.surface().points;
  Run run;
  const auto end_run = [&] {
    run.end = points_.size();
    if (run.end > run.begin) runs_.Add(run, places_m_);
    FillLanes(&places_m_);
    run = {.begin = run.end, .first_place = places_m_[0].size()};
  };
  for (size_t i = 0; i < points.size(); ++i) {
    if (!posed.FacesCamera(i)) continue;
    if (points[i].part != run.part) end_run();
    run.part = points[i].part;
    points_.push_back(static_cast<uint32_t>(i));
    const Eigen::Vector3f at_m = posed.at_m()[i].cast<float>();
    for (int axis = 0; axis < 3; ++axis) places_m_[static_cast<size_t>(axis)].push_back(at_m[axis]);
  }
  end_run();
  FillLanes(&runs_.low_m);
  FillLanes(&runs_.high_m);
  runs_.part.resize(PaddedToLanes(runs_.part.size()), 0);
}

int FacingPoints::Nearest(const SeenPerson::Pixel& pixel, const SurfaceFitOptions& options) const {
  const auto square = [](double of) { return static_cast<float>(of * of); };
  const Eigen::Vector3f at_m = pixel.at_m.cast<float>();
  const Search search{at_m.x(),
                      at_m.y(),
                      at_m.z(),
                      pixel.part,
                      square(options.adjacent_part_m),
                      square(options.other_part_m)};
  const int32_t found = FindNearest(places_m_, runs_, search, kAdjacent[pixel.part]);
  return found < 0 ? -1 : static_cast<int>(points_[static_cast<size_t>(found)]);
}

}  // namespace ossa::recon
