#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ossa::depth {

/// Natural order: runs of digits compare as numbers of any length, so img_2 comes before img_10.
bool NaturalLess(std::string_view a, std::string_view b);

/// What the names of one kind of file share: small letters, with every number left out ("depth_",
/// "frame-.depth", "").
std::string StripNumbers(std::string_view stem);

/// Seconds a unit of times that mostly go up by `step`: a thousandth, a millionth or a billionth,
/// where that makes one of the 0.5 to 200 frames a second that cameras give; else nothing.
std::optional<double> GuessTimeUnit(double step);

/// When the frames of a sequence were taken, by their files' names without extension.
struct NamedTimes {
  enum class Kind { kPlaces, kNumbers, kTimes };
  Kind kind = Kind::kPlaces;
  std::vector<int64_t> numbers;  // kNumbers: of the frames; one that is missing was dropped
  std::vector<double> times_s;   // kTimes: of each name, from the earliest on
  double unit_s = 1.0;           // kTimes: of the numbers in the names
};

/// Names in natural order, which is not that of seconds whose last zeros are left out (0.1 comes
/// before 0.033). Numbers with a fraction are seconds, but for a word with a number and a count
/// after it (take2.0033); whole ones are frame numbers where they count in small steps, and else
/// milliseconds, microseconds or nanoseconds where that makes a frame rate that cameras have; what
/// is neither says no more than the order.
NamedTimes ReadTimesFromNames(const std::vector<std::string>& stems);

}  // namespace ossa::depth
