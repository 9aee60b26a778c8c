#include "depth/sensor/body_bulge.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "depth/sensor/parabola_internal.h"

// Constants: chosen on 840 rendered images of every noise, view, background and two sizes, and on
// the 250 real ones of depth_units_test.cpp, each alone and in threes: none looks hollow; inverted,
// 96 % do alone, and 99 % in threes if hollow stretches need be only twice as many as round ones.
// DepthCensus decides with SurfaceBend.
namespace ossa::depth {
namespace {

constexpr double kStep_mm = 40.0;  // maximum depth step between pixels of one surface
constexpr int kShortest = 5;       // shortest evaluated stretch, pixels

// A row or column of an image.
struct Line {
  const DepthView& image;
  double units_per_mm;
  bool is_column;
  int index;

  int size() const { return is_column ? image.height : image.width; }
  int at(int i) const { return is_column ? image.at(index, i) : image.at(i, index); }
  bool IsAlone(int i) const {  // a reading on none of its neighbours' surfaces
    return i >= 0 && i < size() && at(i) > 0 && !Goes(i, i - 1) && !Goes(i, i + 1);
  }
  bool Goes(int from, int to) const {  // whether it continues on the same surface
    return to >= 0 && to < size() && at(from) > 0 && at(to) > 0 &&
           std::abs(at(from) - at(to)) <= kStep_mm * units_per_mm;
  }
};

// The pixels of a line on one surface, both ends included.
struct Stretch {
  int begin = 0, end = 0;
  int size() const { return end - begin + 1; }
};

Stretch StretchAt(const Line& line, int i) {
  Stretch stretch{i, i};
  while (line.Goes(stretch.begin, stretch.begin - 1)) --stretch.begin;
  while (line.Goes(stretch.end, stretch.end + 1)) ++stretch.end;
  return stretch;
}

// The depth next to an end of a run, beyond a projector's shadow.
enum class Beside { kNothing, kLarger, kSmaller, kSame };

Beside LookBeside(const Line& line, int end, int step) {
  constexpr int kShadows = 20;  // shadow width, as a fraction of the image: one in this many
  constexpr int kNarrowest = 2;
  const int shadow = std::max(kNarrowest, line.image.width / kShadows);
  for (int i = end + step; i != end + step * (shadow + 1); i += step) {
    if (i < 0 || i >= line.size()) return Beside::kNothing;
    if (line.at(i) == 0) continue;
    // Smoothing leaves a ramp of pixels between a surface and a hole.
    if (line.IsAlone(i) && line.IsAlone(i + step)) return Beside::kNothing;
    const double further = (line.at(i) - line.at(end)) / line.units_per_mm;
    if (further > kStep_mm / 2.0) return Beside::kLarger;
    return further < -kStep_mm / 2.0 ? Beside::kSmaller : Beside::kSame;
  }
  return Beside::kNothing;
}

// Whether a surface is in front of its surroundings or behind them. If both, like a wall between a
// person and a corner, it is not evidence.
enum class Place { kAlone, kInFront, kBehind, kOther };

Place FindPlace(const Line& line, const Stretch& stretch) {
  const Beside before = LookBeside(line, stretch.begin, -1);
  const Beside after = LookBeside(line, stretch.end, 1);
  if (before == Beside::kSame || after == Beside::kSame) return Place::kOther;
  if (before == Beside::kNothing && after == Beside::kNothing) return Place::kAlone;
  if (before != Beside::kSmaller && after != Beside::kSmaller) return Place::kInFront;
  return before == Beside::kLarger || after == Beside::kLarger ? Place::kOther : Place::kBehind;
}

// Whether the line crosses a limb instead of following it: a lap is hollow along a column.
bool GoesAcross(const Line& line, const Stretch& stretch) {
  constexpr double kLonger = 1.2;  // ratio of length to width
  const Line other{line.image, line.units_per_mm, !line.is_column,
                   (stretch.begin + stretch.end) / 2};
  return StretchAt(other, line.index).size() >= kLonger * stretch.size();
}

// Sign of z''; 0 if it is not significant.
int ComputeBendSign(const Line& line, const Stretch& stretch) {
  constexpr int kMostEdge = 1;     // mixed pixels at either end
  constexpr double kSigmas = 3.0;  // standard deviations of the bend
  constexpr double kLeast_mm = 2.0;
  const int edge = std::min(kMostEdge, (stretch.size() - kShortest) / 2);
  std::vector<double> z;
  for (int i = stretch.begin + edge; i <= stretch.end - edge; ++i) z.push_back(line.at(i));
  const Parabola::Fit fit = Parabola(static_cast<int>(z.size())).Through(z);
  if (std::abs(fit.bend) <= std::max(kLeast_mm * line.units_per_mm, kSigmas * fit.bend_error))
    return 0;
  return fit.bend > 0.0 ? 1 : -1;
}

struct Count {
  int64_t round = 0, hollow = 0;
};

Count CountStretches(const Line& line) {
  Count count;
  for (int i = 0; i < line.size(); ++i) {
    if (line.at(i) == 0) continue;
    const Stretch stretch = StretchAt(line, i);
    i = stretch.end;
    const bool cut_off = stretch.begin == 0 || stretch.end == line.size() - 1;
    if (cut_off || stretch.size() < kShortest) continue;
    const Place place = FindPlace(line, stretch);
    if (place == Place::kOther || !GoesAcross(line, stretch)) continue;
    const int bend = ComputeBendSign(line, stretch);
    count.round += bend > 0 && place != Place::kBehind ? 1 : 0;
    count.hollow += bend < 0 && place != Place::kInFront ? 1 : 0;
  }
  return count;
}

// Consecutive images show the same few stretches, wrongly bent by the same few pixels: one or two
// per image are not evidence.
bool IsMostly(int64_t some, int64_t others, int64_t images) {
  constexpr int64_t kLeast = 12, kLeastAnImage = 2;  // stretches in all, and per image
  constexpr double kMostly = 3.0;                    // majority ratio
  return some >= std::max(kLeast, kLeastAnImage * images) &&
         static_cast<double>(some) > kMostly * static_cast<double>(others);
}

}  // namespace

void BodyBulge::Add(const DepthView& image) {
  constexpr int kLines = 160;  // evaluated lines per image width
  const int step = std::max(1, image.width / kLines);
  ++images_;
  for (const bool columns : {false, true}) {
    const int lines = columns ? image.width : image.height;
    for (int i = 0; i < lines; i += step) {
      const Count count = CountStretches({image, units_per_mm_, columns, i});
      round_ += count.round;
      hollow_ += count.hollow;
    }
  }
}

bool BodyBulge::IsEnough() const {
  constexpr int64_t kEnough = 40;
  return round_ + hollow_ >= kEnough;
}

bool BodyBulge::IsHollow() const { return IsMostly(hollow_, round_, images_); }

bool BodyBulge::IsRound() const { return IsMostly(round_, hollow_, images_); }

}  // namespace ossa::depth
