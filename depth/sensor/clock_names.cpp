#include "depth/sensor/clock_names.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <regex>
#include <string_view>

#include "depth/base/statistics.h"
#include "depth/sensor/frame_names.h"

// Constants: of the decimal system and the calendar; digits.
namespace ossa::depth {
namespace {

constexpr int64_t kNanosecondsPerSecond = 1'000'000'000;

int64_t WholeOf(const std::ssub_match& digits) {
  int64_t value = 0;
  std::from_chars(&*digits.first, &*digits.first + digits.length(), value);
  return value;
}

// Nanoseconds of a fraction with `digits` digits: 5 of up to 3 digits are 5 ms, with or without
// zeros before it.
int64_t FractionOf_ns(const std::ssub_match& fraction, size_t digits) {
  constexpr size_t kMilli = 3, kMicro = 6;  // digits, by definition
  const int64_t unit_ns = digits <= kMilli ? 1'000'000 : digits <= kMicro ? 1'000 : 1;
  return WholeOf(fraction) * unit_ns;
}

int64_t TimeOfDay_s(const std::ssub_match& hour, const std::ssub_match& minute,
                    const std::ssub_match& second) {
  return (WholeOf(hour) * 60 + WholeOf(minute)) * 60 + WholeOf(second);
}

struct NameClock {
  std::regex form;
  size_t fraction;  // number of the group whose longest match tells the unit
  int64_t (*read_ns)(const std::smatch& match, size_t digits);
};

int64_t ReadDate_ns(const std::smatch& m, size_t digits) {
  using namespace std::chrono;
  const year_month_day date(year(static_cast<int>(WholeOf(m[2]))),
                            month(static_cast<unsigned>(WholeOf(m[3]))),
                            day(static_cast<unsigned>(WholeOf(m[4]))));
  constexpr int64_t kDay_s = 86400;  // by definition
  const int64_t days = sys_days(date).time_since_epoch().count();
  const int64_t whole_s = days * kDay_s + TimeOfDay_s(m[5], m[6], m[7]);
  return whole_s * kNanosecondsPerSecond + FractionOf_ns(m[8], digits);
}

int64_t ReadTimeOfDay_ns(const std::smatch& m, size_t digits) {
  return TimeOfDay_s(m[2], m[3], m[4]) * kNanosecondsPerSecond + FractionOf_ns(m[5], digits);
}

int64_t ReadSecondsAndFraction_ns(const std::smatch& m, size_t digits) {
  return WholeOf(m[2]) * kNanosecondsPerSecond + FractionOf_ns(m[3], digits);
}

int64_t ReadEpoch_ns(const std::smatch& m, size_t digits) {
  constexpr size_t kMilliseconds = 13, kMicroseconds = 16;  // digits, by definition until 2286
  const int64_t unit_ns = digits == kMilliseconds ? 1'000'000 : digits == kMicroseconds ? 1'000 : 1;
  return WholeOf(m[2]) * unit_ns;
}

const std::array<NameClock, 4>& Clocks() {
  static const std::array<NameClock, 4> clocks = {
      {{std::regex(
            R"((^|\D)(19\d\d|20\d\d)[-_.]?(0[1-9]|1[0-2])[-_.]?(0[1-9]|[12]\d|3[01])[-_T ]{0,2})"
            R"(([01]\d|2[0-3])[-_.:]?([0-5]\d)[-_.:]?([0-5]\d)[-_.,]?(\d{3,9})(?!\d))"),
        8, ReadDate_ns},
       {std::regex(R"((^|\D)(1\d{9})[-_](\d{1,9})(?!\d))"), 3, ReadSecondsAndFraction_ns},
       {std::regex(R"((^|\D)(1\d{18}|1\d{15}|1\d{12})(?!\d))"), 2, ReadEpoch_ns},
       {std::regex(R"((^|\D)([01]\d|2[0-3])[-_.:]([0-5]\d)[-_.:]([0-5]\d)[-_.,](\d{3,9})(?!\d))"),
        5, ReadTimeOfDay_ns}}};
  return clocks;
}

std::optional<std::vector<int64_t>> ReadClock_ns(const std::vector<std::string>& stems,
                                                 const NameClock& clock) {
  std::vector<std::smatch> matches(stems.size());
  size_t digits = 0;
  for (size_t i = 0; i < stems.size(); ++i) {
    if (!std::regex_search(stems[i], matches[i], clock.form)) return std::nullopt;
    digits = std::max(digits, static_cast<size_t>(matches[i].length(clock.fraction)));
  }
  std::vector<int64_t> times_ns;
  for (const std::smatch& match : matches) times_ns.push_back(clock.read_ns(match, digits));
  return times_ns;
}

// Whether all names are different moments in the steps of a camera.
bool AreTimesOfACamera(std::vector<int64_t> times_ns) {
  constexpr int64_t kLeast_ns = 4'000'000, kMost_ns = 2'000'000'000;  // by hand: 250 to 0.5 Hz
  std::sort(times_ns.begin(), times_ns.end());
  std::vector<int64_t> steps_ns;
  for (size_t i = 1; i < times_ns.size(); ++i) steps_ns.push_back(times_ns[i] - times_ns[i - 1]);
  if (steps_ns.empty() || std::find(steps_ns.begin(), steps_ns.end(), 0) != steps_ns.end()) {
    return false;
  }
  const int64_t step_ns = Median(std::move(steps_ns));
  return step_ns >= kLeast_ns && step_ns <= kMost_ns;
}

}  // namespace

std::optional<std::vector<double>> ReadTimesFromClocks(const std::vector<std::string>& stems) {
  if (stems.empty()) return std::nullopt;
  const std::string family = StripNumbers(stems.front());
  const bool are_alike = std::all_of(stems.begin(), stems.end(), [&](const std::string& stem) {
    return StripNumbers(stem) == family;
  });
  if (!are_alike) return std::nullopt;
  for (const NameClock& clock : Clocks()) {
    const auto times_ns = ReadClock_ns(stems, clock);
    if (!times_ns || !AreTimesOfACamera(*times_ns)) continue;
    const int64_t first_ns = *std::min_element(times_ns->begin(), times_ns->end());
    std::vector<double> times_s;
    for (const int64_t time_ns : *times_ns) {
      times_s.push_back(static_cast<double>(time_ns - first_ns) / kNanosecondsPerSecond);
    }
    return times_s;
  }
  return std::nullopt;
}

}  // namespace ossa::depth
