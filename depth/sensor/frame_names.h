#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ossa::depth {

/// Natural order: digit sequences compare as numbers of any length, so img_2 comes before img_10.
bool NaturalLess(std::string_view a, std::string_view b);

/// A name's pattern: lower case with all numbers removed ("depth_", "frame-.depth", "").
std::string StripNumbers(std::string_view stem);

/// Seconds per unit of times with typical step `step`: 1e-3, 1e-6 or 1e-9 if that gives a camera's
/// frame rate, 0.5 to 200 Hz; else none.
std::optional<double> GuessTimeUnit(double step);

/// Times of the frames of a sequence, from their file names without extension.
struct NamedTimes {
  enum class Kind { kPlaces, kNumbers, kTimes };
  Kind kind = Kind::kPlaces;
  std::vector<int64_t> numbers;  // kNumbers: frame numbers; a missing one was dropped
  std::vector<double> times_s;   // kTimes: of each name, since the earliest
  double unit_s = 1.0;           // kTimes: unit of the numbers in the names
};

/// Names in natural order, which differs from time order for seconds without trailing zeros (0.1
/// comes before 0.033). Clocks are read first (clock_names.h). Numbers with a fraction are seconds,
/// or a smaller unit if that gives a plausible frame rate, except for a word with a number
/// followed by a count (take2.0033). Integers are frame numbers if their steps are small; otherwise
/// milliseconds, microseconds or nanoseconds if that gives a plausible frame rate; else only their
/// order is used.
NamedTimes ReadTimesFromNames(const std::vector<std::string>& stems);

}  // namespace ossa::depth
