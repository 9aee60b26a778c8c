#include "depth/sensor/readers/matroska_length.h"

#include <bit>
#include <cstdint>

namespace ossa::depth {
namespace {

// Element ids, by definition.
constexpr uint64_t kLargestHead = 4096;  // bytes, a bound by hand: headers have about forty
constexpr uint64_t kEbmlHead = 0x1A45DFA3, kSegment = 0x18538067;

// An EBML variable-length integer: the zeros before its first set bit give the number of further
// bytes.
struct Number {
  uint64_t raw = 0;         // including the length marker, as in element ids
  uint64_t value = 0;       // without the marker
  bool is_unknown = false;  // all ones: a size unknown at the time of writing
};

std::optional<Number> ReadNumber(std::istream& in) {
  const int first = in.get();
  if (first <= 0) return std::nullopt;
  const int more = std::countl_zero(static_cast<uint8_t>(first));
  Number number{static_cast<uint64_t>(first), 0, false};
  for (int i = 0; i < more; ++i) {
    const int next = in.get();
    if (next < 0) return std::nullopt;
    number.raw = number.raw << 8 | static_cast<uint64_t>(next);
  }
  const uint64_t marker = uint64_t{1} << (7 * (more + 1));
  number.value = number.raw & (marker - 1);
  number.is_unknown = number.value == marker - 1;
  return number;
}

}  // namespace

std::optional<std::string> CheckForCut(std::istream& in) {
  const auto head = ReadNumber(in), head_size = ReadNumber(in);
  if (!head || !head_size || head->raw != kEbmlHead) return std::nullopt;
  if (head_size->value > kLargestHead) return std::nullopt;
  in.seekg(static_cast<std::streamoff>(head_size->value), std::ios::cur);
  const auto segment = ReadNumber(in), size = ReadNumber(in);
  if (!segment || !size || segment->raw != kSegment) return std::nullopt;
  if (size->is_unknown)
    return "its recorder was stopped before it finished the file; what is there is read";
  const uint64_t whole = static_cast<uint64_t>(in.tellg()) + size->value;
  in.seekg(0, std::ios::end);
  const auto there = static_cast<uint64_t>(in.tellg());
  if (there >= whole) return std::nullopt;
  return "it is cut short, " + std::to_string(there) + " of " + std::to_string(whole) +
         " bytes; the whole frames before the cut are read";
}

}  // namespace ossa::depth
