#include <algorithm>
#include <charconv>
#include <string_view>

#include "depth/base/error.h"
#include "depth/image/number_image_internal.h"

namespace ossa::depth {
namespace {

constexpr std::string_view kMagic = "\x93NUMPY";

[[noreturn]] void Refuse(const std::string& prefix, const std::string& expected,
                         std::string_view found) {
  constexpr size_t kShown = 40;  // characters, by hand
  throw InputError(prefix + "expected " + expected + ", found '" +
                   std::string(found.substr(0, kShown)) + "'");
}

// What follows a key of the header's dictionary, up to its end.
std::string_view ValueOf(std::string_view text, std::string_view key, const std::string& prefix) {
  const size_t at = text.find(key);
  const size_t colon = at == std::string_view::npos ? at : text.find(':', at);
  if (colon == std::string_view::npos)
    Refuse(prefix, "a NumPy header with " + std::string(key), text);
  const size_t begin = text.find_first_not_of(' ', colon + 1);
  return text.substr(std::min(begin, text.size()));
}

NumberFormat ParseType(std::string_view value, const std::string& prefix) {
  const bool is_plain = value.size() >= 5 && value[0] == '\'' && value[4] == '\'';
  const std::string_view type = is_plain ? value.substr(1, 3) : std::string_view();
  constexpr std::string_view kOrders = "<>|=", kKinds = "uif", kSizes = "1248";
  if (!is_plain || kOrders.find(type[0]) == kOrders.npos || kKinds.find(type[1]) == kKinds.npos ||
      kSizes.find(type[2]) == kSizes.npos || type.substr(1) == "f1") {
    Refuse(prefix, "an array of integers or floats", value.substr(0, value.find(", '")));
  }
  const NumberKind kind = type[1] == 'u'   ? NumberKind::kUnsigned
                          : type[1] == 'i' ? NumberKind::kSigned
                                           : NumberKind::kFloat;
  return {kind, type[2] - '0', type[0] == '>'};
}

std::vector<size_t> ParseShape(std::string_view value, const std::string& prefix) {
  const size_t end = value.find(')');
  if (!value.starts_with('(') || end == std::string_view::npos) {
    Refuse(prefix, "a NumPy shape in brackets", value);
  }
  std::vector<size_t> shape;
  const char* at = value.data() + 1;
  const char* const last = value.data() + end;
  while (at < last) {
    size_t length = 0;
    const auto parsed = std::from_chars(at, last, length);
    if (parsed.ec != std::errc())
      Refuse(prefix, "a NumPy shape of numbers", value.substr(0, end + 1));
    shape.push_back(length);
    at = std::find_if(parsed.ptr, last, [](char c) { return c != ',' && c != ' ' && c != 'L'; });
  }
  return shape;
}

}  // namespace

std::string ShapeText(std::span<const size_t> shape) {
  std::string text;
  for (const size_t side : shape) text.append(text.empty() ? "" : "x").append(std::to_string(side));
  return text.empty() ? "one number" : text;
}

NpyHeader ParseNpyHeader(std::span<const uint8_t> bytes, const std::string& prefix) {
  const std::string_view file(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  constexpr size_t kShortBegin = 10, kLongBegin = 12;  // the format's: magic, version, length
  if (!file.starts_with(kMagic) || file.size() < kLongBegin || bytes[6] < 1 || bytes[6] > 3) {
    throw InputError(prefix + "expected a NumPy array (.npy, versions 1 to 3)");
  }
  const size_t begin = bytes[6] == 1 ? kShortBegin : kLongBegin;
  size_t length = 0;
  for (size_t i = begin; i > 8; --i) length = length << 8 | bytes[i - 1];
  if (length > file.size() - begin) {
    throw InputError(prefix + "its NumPy header is cut short, or longer than that of numbers");
  }
  const std::string_view text = file.substr(begin, length);
  return {ParseType(ValueOf(text, "'descr'", prefix), prefix),
          ValueOf(text, "'fortran_order'", prefix).starts_with("True"),
          ParseShape(ValueOf(text, "'shape'", prefix), prefix), begin + length};
}

}  // namespace ossa::depth
