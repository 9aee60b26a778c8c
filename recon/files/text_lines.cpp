#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "depth/base/error.h"
#include "depth/base/one_line.h"
#include "recon/files/text_lines_internal.h"

namespace ossa::recon {
namespace {

// Constants: chosen by hand unless stated otherwise.

constexpr std::string_view kWhiteSpace = " \t\v\f\r";

}  // namespace

bool TextLines::Next() {
  line_.clear();
  ++number_;
  std::streambuf* buffer = stream_.rdbuf();
  int c = buffer->sbumpc();
  if (c == std::char_traits<char>::eof()) return false;
  for (; c != std::char_traits<char>::eof() && c != '\n' && c != '\r'; c = buffer->sbumpc()) {
    line_.push_back(static_cast<char>(c));
    if (line_.size() > kLongestLine) Fail("a line of at most 1 MiB", line_);
  }
  ended_ = c != std::char_traits<char>::eof();
  if (c == '\r' && buffer->sgetc() == '\n') buffer->sbumpc();
  if (number_ == 1 && line_.starts_with("\xEF\xBB\xBF")) line_.erase(0, 3);
  return true;
}

bool TextLines::NextFilled() {
  while (Next()) {
    if (!Trimmed(line_).empty()) return true;
  }
  return false;
}

void TextLines::Expect(std::string_view what) {
  if (!NextFilled()) Fail(what, "the end of the file");
}

void TextLines::Fail(std::string_view expected, std::string_view found) const {
  const std::string shown = found == "the end of the file" ? std::string(found) : Quoted(found);
  throw InputError(source_ + ": line " + std::to_string(number_) + ": expected " +
                   std::string(expected) + ", found " + shown);
}

std::string Quoted(std::string_view bytes) {
  constexpr size_t kShown = 40, kLongestTail = 3;  // bytes: by hand; of a UTF-8 character
  size_t end = std::min(kShown, bytes.size());
  // Do not cut within a UTF-8 character.
  for (size_t back = 0; back < kLongestTail && end < bytes.size(); ++back) {
    if ((static_cast<unsigned char>(bytes[end]) & 0xC0U) == 0x80) --end;
  }
  std::string shown(bytes.substr(0, end));
  const auto is_control = [](unsigned char c) { return c < ' ' || c == 0x7F; };
  std::replace_if(shown.begin(), shown.end(), is_control, '?');
  std::string quoted = "'";
  quoted += OnOneLine(shown);
  quoted += end < bytes.size() ? "...'" : "'";
  return quoted;
}

std::vector<std::string_view> Split(std::string_view line, char separator) {
  std::vector<std::string_view> fields;
  while (!line.empty()) {
    const size_t end = line.find(separator);
    fields.push_back(Trimmed(line.substr(0, end)));
    if (end == std::string_view::npos) break;
    line.remove_prefix(end + 1);
  }
  return fields;
}

std::vector<std::string_view> Words(std::string_view line) {
  std::vector<std::string_view> words;
  size_t begin = line.find_first_not_of(kWhiteSpace);
  while (begin != std::string_view::npos) {
    const size_t end = line.find_first_of(kWhiteSpace, begin);
    words.push_back(line.substr(begin, end - begin));
    begin = end == std::string_view::npos ? end : line.find_first_not_of(kWhiteSpace, end);
  }
  return words;
}

std::string_view Trimmed(std::string_view text) {
  const size_t begin = text.find_first_not_of(kWhiteSpace);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kWhiteSpace) - begin + 1);
}

bool LooksLikeNumber(std::string_view field) {
  return !field.empty() && field.find_first_not_of("+-.0123456789eE") == std::string_view::npos;
}

double NumberIn(const TextLines& lines, std::string_view field, std::string_view what) {
  const std::string_view digits = field.starts_with('+') ? field.substr(1) : field;
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size() || !std::isfinite(value)) {
    const bool has_comma = field.find(',') != field.npos;
    lines.Fail("a finite number for " + std::string(what) +
                   (has_comma ? ", with a decimal point and no comma between thousands" : ""),
               field);
  }
  return value;
}

bool IsNan(std::string_view field) {
  if (field.starts_with('-') || field.starts_with('+')) field.remove_prefix(1);
  std::string lower;
  for (const char c : field) lower += static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  // NaN as printed by printf and by old and new Microsoft libraries.
  return lower == "nan" || lower.starts_with("nan(") || lower.starts_with("1.#qnan") ||
         lower.starts_with("1.#ind");
}

std::optional<Eigen::Vector3d> PlaceIn(const TextLines& lines,
                                       const std::array<std::string_view, 3>& fields,
                                       std::string_view what) {
  const auto is_blank = [](std::string_view field) { return field.empty(); };
  if (std::all_of(fields.begin(), fields.end(), is_blank)) return std::nullopt;
  if (std::any_of(fields.begin(), fields.end(), IsNan)) return std::nullopt;
  Eigen::Vector3d place;
  for (size_t axis = 0; axis < 3; ++axis) {
    place[static_cast<int>(axis)] = NumberIn(lines, fields[axis], what);
  }
  return place;
}

long WholeNumberIn(const TextLines& lines, std::string_view field, std::string_view what, long low,
                   long high) {
  long value = 0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc() || end != field.data() + field.size() || value < low || value > high) {
    lines.Fail(std::string(what) + " as a whole number from " + std::to_string(low) + " to " +
                   std::to_string(high),
               field);
  }
  return value;
}

std::string WrongStep(double step_s) {
  constexpr double kLongestPause_s = 86400;  // a day, by hand
  if (step_s < 0) return "times that grow";
  if (step_s > kLongestPause_s) return "seconds, and at most a day after the frame before";
  return {};
}

void RowTimes::Take(const TextLines& lines, double time_s) {
  const std::string wrong = last_s_ ? WrongStep(time_s - *last_s_) : "";
  if (!wrong.empty()) lines.Fail(wrong, fmt::format("{} after {}", time_s, *last_s_));
  last_s_ = time_s;
}

std::vector<double> NumbersIn(const TextLines& lines, std::span<const std::string_view> fields,
                              size_t count, std::string_view what) {
  if (fields.size() != count) {
    lines.Fail(std::to_string(count) + " numbers (" + std::string(what) + ")",
               std::to_string(fields.size()) + " fields");
  }
  std::vector<double> numbers;
  numbers.reserve(count);
  for (size_t i = 0; i < count; ++i) {
    numbers.push_back(NumberIn(lines, fields[i], "column " + std::to_string(i + 1)));
  }
  return numbers;
}

}  // namespace ossa::recon
