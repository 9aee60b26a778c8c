#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace ossa::depth {

enum class NumberKind : uint8_t { kUnsigned, kSigned, kFloat };

/// How the numbers of an image or array are stored.
struct NumberFormat {
  NumberKind kind = NumberKind::kUnsigned;
  int size = 2;             // bytes of each: 1, 2, 4 or 8
  bool is_swapped = false;  // in the byte order that is not this machine's
  bool operator==(const NumberFormat&) const = default;
};

/// "uint16", "float32": NumPy's name.
std::string NameOf(const NumberFormat& format);

/// Whether depths can be stored so: floats, and integers of 16 bits or more.
bool HoldsDepths(const NumberFormat& format);

/// Millimetres per unit of depths that are floats: of metres if the near ones are below 100, else
/// of millimetres. Far ones may be a background without a surface. None if there is no reading, a
/// finite number above 0.
std::optional<double> GuessUnit_mm(const NumberFormat& format, std::span<const uint8_t> numbers);

/// Depths of numbers: integers as they are, floats times `unit_mm`, rounded. What is not finite or
/// does not fit 16 bits is no reading, 0. Precondition: HoldsDepths, whole numbers.
std::vector<uint16_t> DepthsOf(const NumberFormat& format, std::span<const uint8_t> numbers,
                               double unit_mm);

/// All numbers as double, in their order. Precondition: whole numbers of a known size.
std::vector<double> ValuesOf(const NumberFormat& format, std::span<const uint8_t> numbers);

}  // namespace ossa::depth
