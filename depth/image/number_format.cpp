#include "depth/image/number_format.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "depth/base/error.h"

namespace ossa::depth {
namespace {

// A half-precision float, which C++20 lacks.
struct Half {
  uint16_t bits = 0;
  explicit operator double() const {
    return static_cast<float>(Eigen::half(Eigen::half_impl::raw_uint16_to_half(bits)));
  }
};

// Calls `take(i, number)` for each number, as double.
template <typename T, typename Take>
void ForEachOf(std::span<const uint8_t> numbers, bool is_swapped, const Take& take) {
  std::array<uint8_t, sizeof(T)> bytes;
  for (size_t i = 0; i < numbers.size() / sizeof(T); ++i) {
    std::memcpy(bytes.data(), &numbers[i * sizeof(T)], sizeof(T));
    if (is_swapped) std::reverse(bytes.begin(), bytes.end());
    T number;
    std::memcpy(&number, bytes.data(), sizeof(T));
    take(i, static_cast<double>(number));
  }
}

template <typename T1, typename T2, typename T4, typename T8, typename Take>
void ForEachOfKind(const NumberFormat& format, std::span<const uint8_t> numbers, const Take& take) {
  switch (format.size) {
    case 1:
      return ForEachOf<T1>(numbers, format.is_swapped, take);
    case 2:
      return ForEachOf<T2>(numbers, format.is_swapped, take);
    case 4:
      return ForEachOf<T4>(numbers, format.is_swapped, take);
    case 8:
      return ForEachOf<T8>(numbers, format.is_swapped, take);
    default:
      throw InputError("numbers of " + std::to_string(format.size) + " bytes");
  }
}

template <typename Take>
void ForEach(const NumberFormat& format, std::span<const uint8_t> numbers, const Take& take) {
  switch (format.kind) {
    case NumberKind::kUnsigned:
      return ForEachOfKind<uint8_t, uint16_t, uint32_t, uint64_t>(format, numbers, take);
    case NumberKind::kSigned:
      return ForEachOfKind<int8_t, int16_t, int32_t, int64_t>(format, numbers, take);
    case NumberKind::kFloat:
      return ForEachOfKind<uint8_t, Half, float, double>(format, numbers, take);
  }
}

}  // namespace

std::string NameOf(const NumberFormat& format) {
  const char* kind = format.kind == NumberKind::kUnsigned ? "uint"
                     : format.kind == NumberKind::kSigned ? "int"
                                                          : "float";
  return kind + std::to_string(8 * format.size);
}

bool HoldsDepths(const NumberFormat& format) { return format.size > 1; }

std::optional<double> GuessUnit_mm(const NumberFormat& format, std::span<const uint8_t> numbers) {
  constexpr double kFarthest_m = 100.0;  // by hand: beyond any depth camera; as millimetres none
  constexpr size_t kNear =
      10;  // one in so many, by hand: an artefact may be nearer, 1e10 is common
  std::vector<double> readings;
  ForEach(format, numbers, [&](size_t, double number) {
    if (std::isfinite(number) && number > 0) readings.push_back(number);
  });
  if (readings.empty()) return std::nullopt;
  const auto near = readings.begin() + static_cast<ptrdiff_t>(readings.size() / kNear);
  std::nth_element(readings.begin(), near, readings.end());
  return *near < kFarthest_m ? 1000.0 : 1.0;
}

std::vector<uint16_t> DepthsOf(const NumberFormat& format, std::span<const uint8_t> numbers,
                               double unit_mm) {
  const double scale = format.kind == NumberKind::kFloat ? unit_mm : 1.0;
  std::vector<uint16_t> depths(numbers.size() / static_cast<size_t>(format.size));
  ForEach(format, numbers, [&](size_t i, double number) {
    const double depth = std::round(number * scale);
    if (depth >= 0 && depth <= 65535) depths[i] = static_cast<uint16_t>(depth);
  });
  return depths;
}

std::vector<double> ValuesOf(const NumberFormat& format, std::span<const uint8_t> numbers) {
  std::vector<double> values(numbers.size() / static_cast<size_t>(format.size));
  ForEach(format, numbers, [&](size_t i, double number) { values[i] = number; });
  return values;
}

}  // namespace ossa::depth
