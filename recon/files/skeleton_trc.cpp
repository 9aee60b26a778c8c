// OpenSim's TRC marker table: five header lines, then a row a frame, tab separated.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "recon/files/origin_points_internal.h"
#include "recon/files/skeleton_formats_internal.h"

namespace ossa::recon {
namespace {

struct TrcHeader {
  double metres_per_unit = 0.0;
  size_t markers = 0;
  std::optional<size_t> frames;
  double rate_hz = 0.0;  // by which the times are doubted only; 0: none is stated
};

std::vector<std::string> NotEmpty(const std::vector<std::string_view>& fields) {
  std::vector<std::string> filled;
  for (const std::string_view field : fields) {
    if (!field.empty()) filled.emplace_back(field);
  }
  return filled;
}

// Header names and values are in the same columns, or in the same order if a program doubled some
// tabs.
TrcHeader ReadHeader(TextLines& lines) {
  lines.Expect("a TRC header");
  if (!lines.line().starts_with("PathFileType")) lines.Fail("PathFileType", lines.line());
  lines.Expect("the line that names the header's fields");
  const auto keys_at = Split(lines.line(), '\t');
  std::vector<std::string> keys(keys_at.begin(), keys_at.end());
  const std::vector<std::string> keys_filled = NotEmpty(keys_at);
  lines.Expect("the header's values");
  const auto values_at = Split(lines.line(), '\t');
  std::vector<std::string> values(values_at.begin(), values_at.end());
  if (const auto filled = NotEmpty(values_at); filled.size() == keys_filled.size()) {
    keys = keys_filled;
    values = filled;
  }
  TrcHeader header;
  for (size_t i = 0; i < std::min(keys.size(), values.size()); ++i) {
    if (keys[i] == "NumMarkers") {
      header.markers = static_cast<size_t>(WholeNumberIn(lines, values[i], "NumMarkers", 1, 10000));
    } else if (keys[i] == "NumFrames" && !values[i].empty()) {
      header.frames = static_cast<size_t>(WholeNumberIn(lines, values[i], "NumFrames", 0, 1e9));
    } else if (keys[i] == "DataRate") {
      std::from_chars(values[i].data(), values[i].data() + values[i].size(), header.rate_hz);
    } else if (keys[i] == "Units") {
      const auto unit = MetresPerUnit(values[i]);
      if (!unit) lines.Fail("Units mm, cm, m or inches", values[i]);
      header.metres_per_unit = *unit;
    }
  }
  if (header.markers == 0) lines.Fail("NumMarkers", lines.line());
  if (header.metres_per_unit == 0) lines.Fail("Units", lines.line());
  return header;
}

// Marker names in the order of their columns; "" for a marker without a name.
std::vector<std::string> ReadMarkerNames(TextLines& lines, const TrcHeader& header) {
  lines.Expect("the line of marker names");
  if (!lines.line().starts_with("Frame#")) lines.Fail("Frame#, Time and names", lines.line());
  const auto fields = Split(lines.line(), '\t');
  std::vector<std::string> names = NotEmpty(fields);
  names.erase(names.begin(), names.begin() + std::min<std::ptrdiff_t>(
                                                 2, static_cast<std::ptrdiff_t>(names.size())));
  if (names.size() != header.markers) {
    lines.Fail(fmt::format("{} marker names as NumMarkers says", header.markers),
               fmt::format("{} names", names.size()));
  }
  return names;
}

void ReadColumnNames(TextLines& lines) {
  lines.Expect("the line of column names");
  const std::string_view first = Trimmed(lines.line());
  const bool numbered = first.size() > 1 && (first[0] == 'X' || first[0] == 'x') &&
                        first[1] >= '0' && first[1] <= '9';
  if (!numbered) lines.Fail("X1, Y1, Z1, ...", lines.line());
}

size_t CountDecimalPlaces(std::string_view number) {
  const size_t point = number.find('.');
  return point == std::string_view::npos ? 0 : number.size() - point - 1;
}

// Motion Analysis' programs write 9999999 for coordinates that were not seen.
bool IsNoPlace(const Eigen::Vector3d& place) {
  constexpr double kNoPlace = 99999.0;  // no unit, by hand: nobody is as far along all axes
  return place.x() >= kNoPlace && place.x() == place.y() && place.y() == place.z();
}

// Rows of a TRC: frame number, time, then x y z of each marker.
class TrcRows {
 public:
  TrcRows(TextLines& lines, size_t markers, double metres_per_unit)
      : lines_(lines), markers_(markers), metres_per_unit_(metres_per_unit) {}

  // False at the end. A truncated row is refused: its last digits are missing.
  bool Next() {
    if (!lines_.NextFilled()) return false;
    fields_ = Split(lines_.line(), '\t');
    if (lines_.line().ends_with('\t')) fields_.emplace_back();  // Split drops an empty last field
    while (fields_.size() > Columns() && fields_.back().empty()) fields_.pop_back();
    if (fields_.size() < 2 || fields_.size() > Columns()) {
      lines_.Fail(fmt::format("2 to {} columns", Columns()),
                  fmt::format("{} columns", fields_.size()));
    }
    if (!lines_.ended() && IsCut()) {
      lines_.Fail(fmt::format("a whole row of {} columns", Columns()), lines_.line());
    }
    decimals_ = CountCommonDecimals().value_or(0);
    return true;
  }

  double ReadTime_s() const { return NumberIn(lines_, fields_[1], "Time"); }

  // TRC marks unseen markers by blank columns, NaN, or columns missing at the end.
  std::vector<SeenPoint> ReadPoints() const {
    std::vector<SeenPoint> points(markers_);
    for (size_t m = 0; m < markers_; ++m) {
      const size_t column = 2 + 3 * m;
      if (column >= fields_.size()) continue;
      const auto field = [&](size_t i) {
        return column + i < fields_.size() ? fields_[column + i] : std::string_view();
      };
      points[m] = PlaceIn(lines_, {field(0), field(1), field(2)}, "a marker");
      if (points[m] && IsNoPlace(*points[m])) points[m].reset();
      if (points[m]) *points[m] *= metres_per_unit_;
    }
    return points;
  }

 private:
  size_t Columns() const { return 2 + 3 * markers_; }

  // Number of decimals of all numbers in the row; none if they differ.
  std::optional<size_t> CountCommonDecimals() const {
    std::optional<size_t> decimals;
    for (size_t f = 2; f < fields_.size(); ++f) {
      if (fields_[f].empty() || IsNan(fields_[f])) continue;
      const size_t own = CountDecimalPlaces(fields_[f]);
      if (own != decimals.value_or(own)) return std::nullopt;
      decimals = own;
    }
    return decimals;
  }

  // Whether a row without a line end is truncated: columns are missing, or its last number has
  // fewer digits than the uniform row before.
  bool IsCut() const {
    if (fields_.size() < Columns()) return true;
    const std::string_view last = fields_.back();
    return !last.empty() && !IsNan(last) && CountDecimalPlaces(last) < decimals_;
  }

  TextLines& lines_;
  size_t markers_;
  double metres_per_unit_;
  std::vector<std::string_view> fields_;
  size_t decimals_ = 0;  // decimals of the previous row, if uniform
};

using RowPoints = std::vector<std::vector<SeenPoint>>;  // [row][marker]

// Times of another unit than seconds pass for a recording of another length.
void WarnOfOtherRate(const TrcHeader& header, SkeletonSequence& sequence) {
  constexpr double kFar = 10.0;  // a ratio, by hand: programs thin out rows and leave the DataRate
  const double length_s = sequence.frames.back().time_s - sequence.frames.front().time_s;
  if (!(header.rate_hz > 0) || !(length_s > 0)) return;
  const double found_hz = static_cast<double>(sequence.frames.size() - 1) / length_s;
  if (found_hz < kFar * header.rate_hz && header.rate_hz < kFar * found_hz) return;
  sequence.warnings.push_back(fmt::format(
      "{}: DataRate says {:g} frames a second, the times are those of {:.3g}: the times "
      "are read, as seconds",
      sequence.source, header.rate_hz, found_hz));
}

}  // namespace

SkeletonSequence ReadTrc(SkeletonInput& input) {
  TextLines lines(input.stream, input.name);
  const TrcHeader header = ReadHeader(lines);
  const std::vector<std::string> names = ReadMarkerNames(lines, header);
  SkeletonSequence sequence{input.name, {}};
  const auto bodies =
      FindPointBodies(names, input.mapping, {input.name, fmt::format("line {}", lines.number())},
                      sequence.warnings);
  ReadColumnNames(lines);
  TrcRows rows(lines, header.markers, header.metres_per_unit);
  RowTimes times;
  std::vector<double> times_s;
  RowPoints points;
  while (rows.Next()) {
    times_s.push_back(rows.ReadTime_s());
    times.Take(lines, times_s.back());
    points.push_back(rows.ReadPoints());
  }
  RemoveUnseenAtOrigin(points);
  for (size_t f = 0; f < points.size(); ++f) {
    sequence.frames.push_back(MakeFrame(bodies, points[f], f, times_s[f]));
  }
  RequireFrames(sequence);
  if (header.frames && sequence.frames.size() != *header.frames) {
    sequence.warnings.push_back(
        fmt::format("{}: NumFrames says {} frames, the file has {}: those "
                    "are read",
                    input.name, *header.frames, sequence.frames.size()));
  }
  WarnOfOtherRate(header, sequence);
  RemoveEmptyBodies(sequence);
  RotateUpright(sequence, {'z', Eigen::Vector3d::UnitZ()});
  return sequence;
}

}  // namespace ossa::recon
