#include "depth/sensor/frame_names.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include "depth/base/lower_case.h"
#include "depth/base/statistics.h"
#include "depth/sensor/clock_names.h"

// Constants: by hand, chosen to separate clock units in file names: the steps of depth cameras, 5
// ms to 2 s, do not overlap between units.
namespace ossa::depth {
namespace {

bool IsDigit(char c) { return c >= '0' && c <= '9'; }

size_t DigitsEnd(std::string_view text, size_t from) {
  while (from < text.size() && IsDigit(text[from])) ++from;
  return from;
}

std::string_view WithoutLeadingZeros(std::string_view digits) {
  return digits.substr(std::min(digits.find_first_not_of('0'), digits.size()));
}

// A name's last number and the text around it.
struct NumberedName {
  std::string_view before, whole, fraction, after;
};

std::optional<NumberedName> FindLastNumber(std::string_view stem) {
  size_t end = stem.size();
  while (end > 0 && !IsDigit(stem[end - 1])) --end;
  if (end == 0) return std::nullopt;
  size_t begin = end;
  while (begin > 0 && IsDigit(stem[begin - 1])) --begin;
  NumberedName name{stem.substr(0, begin), stem.substr(begin, end - begin), {}, stem.substr(end)};
  if (begin >= 2 && stem[begin - 1] == '.' && IsDigit(stem[begin - 2])) {
    name.fraction = name.whole;
    size_t whole = begin - 1;
    while (whole > 0 && IsDigit(stem[whole - 1])) --whole;
    name.whole = stem.substr(whole, begin - 1 - whole);
    name.before = stem.substr(0, whole);
  }
  return name;
}

// The last numbers of all names, if the names differ in nothing else; else empty.
std::vector<NumberedName> FindLastNumbers(const std::vector<std::string>& stems) {
  std::vector<NumberedName> names;
  for (const std::string& stem : stems) {
    const auto name = FindLastNumber(stem);
    if (!name) return {};
    names.push_back(*name);
    const NumberedName& first = names.front();
    if (name->before != first.before || name->after != first.after ||
        name->fraction.empty() != first.fraction.empty()) {
      return {};
    }
  }
  return names;
}

std::optional<std::vector<int64_t>> WholeNumbers(const std::vector<NumberedName>& names) {
  std::vector<int64_t> values;
  for (const NumberedName& name : names) {
    int64_t value = 0;
    const char* const end = name.whole.data() + name.whole.size();
    if (std::from_chars(name.whole.data(), end, value).ec != std::errc()) return std::nullopt;
    values.push_back(value);
  }
  return values;
}

// Whether these are decimals: integers do not have leading zeros of varying length.
bool AreDecimals(const std::vector<NumberedName>& names) {
  const auto is_longer = [&](const NumberedName& name) {
    return name.fraction.size() != names.front().fraction.size();
  };
  return std::none_of(names.begin(), names.end(), is_longer) ||
         std::any_of(names.begin(), names.end(), [](const NumberedName& name) {
           return name.fraction.size() > 1 && name.fraction.front() == '0';
         });
}

// Seconds from the earliest time. Integers are subtracted first, to keep the microseconds of times
// since 1970.
std::vector<double> Seconds(const std::vector<NumberedName>& names,
                            const std::vector<int64_t>& whole) {
  std::vector<double> times_s;
  for (size_t i = 0; i < names.size(); ++i) {
    double fraction = 0.0;
    const std::string text = "0." + std::string(names[i].fraction);
    std::from_chars(text.data(), text.data() + text.size(), fraction);
    times_s.push_back(static_cast<double>(whole[i] - whole[0]) + fraction);
  }
  const double first_s = times_s.empty() ? 0.0 : *std::min_element(times_s.begin(), times_s.end());
  for (double& time_s : times_s) time_s -= first_s;
  return times_s;
}

// Whether these are times of day after a date, as written by PCL's grabber and other programs:
// 20121214T142255.814212.
bool AreTimesOfDay(const std::vector<NumberedName>& names) {
  constexpr size_t kDate = 8, kTime = 6;  // digits
  return std::all_of(names.begin(), names.end(), [](const NumberedName& name) {
    const std::string_view before = name.before;
    if (name.whole.size() != kTime || before.size() <= kDate) return false;
    const size_t date = before.size() - 1 - kDate;
    const bool has_minutes = name.whole[2] < '6' && name.whole[4] < '6';
    return has_minutes && !IsDigit(before.back()) && DigitsEnd(before, date) == before.size() - 1;
  });
}

// Converts hours, minutes and seconds, two digits each, to seconds.
void CountSecondsOfDay(std::vector<int64_t>& whole) {
  for (int64_t& time : whole) {
    time = time / 10000 * 3600 + time / 100 % 100 * 60 + time % 100;
  }
}

template <typename T>
T MedianStep(const std::vector<T>& values) {
  std::vector<T> steps;
  for (size_t i = 1; i < values.size(); ++i) steps.push_back(values[i] - values[i - 1]);
  return Median(std::move(steps));
}

// Smaller steps are frame numbers or seconds, not milliseconds.
constexpr int64_t kLeastTimeStep = 15;

// Seconds per unit of integers that are times; none if they are not.
std::optional<double> GuessUnitOfNumbers(int64_t step, size_t digits) {
  constexpr size_t kSecondsSince1970 = 10, kNanosecondsSince1970 = 18;
  if (step < kLeastTimeStep) {
    return digits == kSecondsSince1970 ? std::optional(1.0) : std::nullopt;
  }
  const auto unit_s = GuessTimeUnit(static_cast<double>(step));
  return unit_s == 1e-9 && digits < kNanosecondsSince1970 ? std::nullopt : unit_s;
}

// Whether these are integers as long as milli-, micro- or nanoseconds since 1970.
bool AreEpochs(const std::vector<NumberedName>& names) {
  constexpr std::array<size_t, 3> kDigits = {13, 16, 19};  // from 2001 to 2286
  return !names.empty() && names.front().fraction.empty() &&
         std::find(kDigits.begin(), kDigits.end(), names.front().whole.size()) != kDigits.end();
}

bool SaysFrame(std::string_view before) {
  return LowerCase(before).find("frame") != std::string::npos;
}

// Whether numbers are zero-padded, as counters usually are and clocks are not: 000100, 000200.
bool ArePaddedWithZeros(const std::vector<NumberedName>& names) {
  bool any = false;
  for (const NumberedName& name : names) {
    if (name.whole.size() != names.front().whole.size()) return false;
    any = any || (name.whole.size() > 1 && name.whole.front() == '0');
  }
  return any;
}

// Whether the numbers count every n-th frame, like 0, 20, 40, 80 with one frame removed.
// Millisecond times of cameras faster than 30 Hz have uneven steps, such as 16 and 17, or 11 and
// 12.
bool CountEveryNthFrame(const std::vector<int64_t>& values, int64_t step, bool says_frame,
                        bool padded) {
  constexpr int64_t kLeastEvenTimeStep = 30;  // ms: of a program that sleeps between frames
  constexpr int64_t kMostEveryNth = 1000;     // largest n of data sets, by hand
  constexpr size_t kEnough = 3;               // a single step is always even
  const bool says_count = says_frame || (padded && step <= kMostEveryNth);
  const bool may_be_times = step >= kLeastEvenTimeStep && !says_count;
  if (values.size() < kEnough || step < 2 || may_be_times) return false;
  for (size_t i = 1; i < values.size(); ++i) {
    if ((values[i] - values[i - 1]) % step != 0) return false;
  }
  return true;
}

NamedTimes ReadTimesFromNumbers(const std::vector<NumberedName>& names,
                                const std::vector<int64_t>& values) {
  constexpr size_t kLongestCount = 8;  // digits: longer numbers are times or hashes
  const size_t digits = WithoutLeadingZeros(names.back().whole).size();
  const NumberedName& first = names.front();
  const bool alone = first.before.empty() && first.after.empty();
  const bool says_frame = SaysFrame(first.before);
  NamedTimes times;
  const int64_t step = values.size() > 1 ? MedianStep(values) : 1;
  const bool counts = digits <= kLongestCount &&
                      CountEveryNthFrame(values, step, says_frame, ArePaddedWithZeros(names));
  const auto unit_s = counts ? std::nullopt : GuessUnitOfNumbers(step, digits);
  if (unit_s) {
    times.kind = NamedTimes::Kind::kTimes;
    times.unit_s = *unit_s;
    for (const int64_t value : values) {
      times.times_s.push_back(static_cast<double>(value - values.front()) * *unit_s);
    }
  } else if (digits <= kLongestCount && (counts || step < kLeastTimeStep) &&
             (alone || says_frame || step == 1)) {
    times.kind = NamedTimes::Kind::kNumbers;
    times.numbers = values;
  }
  return times;
}

NamedTimes ReadTimesFromWholes(const std::vector<NumberedName>& names) {
  const auto values = WholeNumbers(names);
  if (!values) return {};
  const bool twice = std::adjacent_find(values->begin(), values->end()) != values->end();
  return twice ? NamedTimes{} : ReadTimesFromNumbers(names, *values);
}

// For names like "take2.0033", which all have the 2: the number after it. Else empty.
std::vector<NumberedName> TakeFractionsForNumbers(std::vector<NumberedName> names) {
  const std::string_view whole = names.front().whole;
  for (NumberedName& name : names) {
    if (name.whole != whole) return {};
    name.before = {name.before.data(), name.before.size() + name.whole.size() + 1};
    name.whole = std::exchange(name.fraction, {});
  }
  return names;
}

NamedTimes ReadTimesFromFractions(const std::vector<NumberedName>& names) {
  constexpr double kLeastStep_s = 0.004;  // of a camera of 200 frames a second, with a margin
  const auto counts = TakeFractionsForNumbers(names);
  const NamedTimes count = counts.empty() ? NamedTimes{} : ReadTimesFromWholes(counts);
  const bool has_words = !names.front().before.empty();
  if (has_words && count.kind == NamedTimes::Kind::kNumbers) return count;
  auto whole = WholeNumbers(names);
  if (!whole) return {};
  if (AreTimesOfDay(names)) CountSecondsOfDay(*whole);
  NamedTimes times{NamedTimes::Kind::kTimes, {}, Seconds(names, *whole)};
  std::vector<double> ordered = times.times_s;
  std::sort(ordered.begin(), ordered.end());
  if (!AreDecimals(names) && ordered != times.times_s) return {};
  const auto unit_s = ordered.size() < 2 ? std::nullopt : GuessTimeUnit(MedianStep(ordered));
  if (unit_s) {
    times.unit_s = *unit_s;
    for (double& time_s : times.times_s) time_s *= *unit_s;
    return times;
  }
  const bool is_cameras = ordered.size() < 2 || MedianStep(ordered) >= kLeastStep_s;
  return is_cameras ? times : count;
}

}  // namespace

bool NaturalLess(std::string_view a, std::string_view b) {
  size_t i = 0, k = 0;
  while (i < a.size() && k < b.size()) {
    if (IsDigit(a[i]) && IsDigit(b[k])) {
      const size_t end_a = DigitsEnd(a, i), end_b = DigitsEnd(b, k);
      const auto digits_a = WithoutLeadingZeros(a.substr(i, end_a - i));
      const auto digits_b = WithoutLeadingZeros(b.substr(k, end_b - k));
      if (digits_a.size() != digits_b.size()) return digits_a.size() < digits_b.size();
      if (digits_a != digits_b) return digits_a < digits_b;
      i = end_a;
      k = end_b;
    } else {
      if (a[i] != b[k]) return a[i] < b[k];
      ++i;
      ++k;
    }
  }
  const size_t left_a = a.size() - i, left_b = b.size() - k;
  return left_a != left_b ? left_a < left_b : a < b;  // 1 and 01: deterministic order
}

std::optional<double> GuessTimeUnit(double step) {
  if (step < kLeastTimeStep) return std::nullopt;
  if (step <= 2000) return 1e-3;
  if (step >= 5000 && step <= 2e6) return 1e-6;
  return step >= 5e6 && step <= 2e9 ? std::optional(1e-9) : std::nullopt;
}

std::string StripNumbers(std::string_view stem) {
  std::string family;
  for (size_t i = 0; i < stem.size(); ++i) {
    const bool point_in_number = stem[i] == '.' && i > 0 && IsDigit(stem[i - 1]) &&
                                 i + 1 < stem.size() && IsDigit(stem[i + 1]);
    if (IsDigit(stem[i]) || point_in_number) continue;
    const bool capital = stem[i] >= 'A' && stem[i] <= 'Z';
    family += capital ? static_cast<char>(stem[i] - 'A' + 'a') : stem[i];
  }
  return family;
}

NamedTimes ReadTimesFromNames(const std::vector<std::string>& stems) {
  const std::vector<NumberedName> names = FindLastNumbers(stems);
  auto times_s = AreEpochs(names) ? std::nullopt : ReadTimesFromClocks(stems);
  if (times_s) return {NamedTimes::Kind::kTimes, {}, std::move(*times_s)};
  if (names.empty()) return {};
  return names.front().fraction.empty() ? ReadTimesFromWholes(names)
                                        : ReadTimesFromFractions(names);
}

}  // namespace ossa::depth
