#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <optional>

#include "depth/base/error.h"
#include "depth/base/lower_case.h"
#include "depth/base/open_file.h"
#include "recon/motion/text_scanner_internal.h"

namespace ossa::recon {
namespace {

constexpr uintmax_t kMaxFileBytes = uintmax_t{1} << 30;
// Constants: bounds, by hand.

// No length, angle or time of a motion file is larger; in any unit: no unit
constexpr double kMaxMagnitude = 1e9;
constexpr size_t kQuotedCharacters = 40;

bool IsBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v'; }

size_t CountDecimals(std::string_view number) {
  const size_t point = number.find('.');
  return point == std::string_view::npos ? 0 : number.size() - point - 1;
}

std::string InQuotes(std::string_view found) {
  if (found.empty()) return "the end of the file";
  std::string shown;
  for (const char c : found.substr(0, kQuotedCharacters)) shown += (c < 32 || c == 127) ? '?' : c;
  return "'" + shown + (found.size() > kQuotedCharacters ? "...'" : "'");
}

}  // namespace

TextScanner::TextScanner(std::string text, std::string source)
    : text_(std::move(text)), source_(std::move(source)) {
  // Some exporters write a UTF-8 byte order mark.
  if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;
  // Others end lines with \r only.
  for (size_t at = text_.find('\r'); at != std::string::npos; at = text_.find('\r', at + 1)) {
    if (at + 1 == text_.size() || text_[at + 1] != '\n') text_[at] = '\n';
  }
}

void TextScanner::Fail(const std::string& expected, std::string_view found) const {
  throw InputError(source_ + ": line " + std::to_string(word_line_) + ": expected " + expected +
                   ", found " + InQuotes(found));
}

void TextScanner::SkipBlank() {
  while (at_ < text_.size() && (IsBlank(text_[at_]) || text_[at_] == '\n')) {
    if (text_[at_] == '\n') ++line_;
    ++at_;
  }
}

bool TextScanner::AtEndOfLine() const { return at_ >= text_.size() || text_[at_] == '\n'; }

std::string_view TextScanner::CutWord() {
  const size_t begin = at_;
  if (at_ < text_.size() && (text_[at_] == '{' || text_[at_] == '}')) {
    ++at_;
  } else {
    while (!AtEndOfLine() && !IsBlank(text_[at_]) && text_[at_] != '{' && text_[at_] != '}') ++at_;
  }
  return std::string_view(text_).substr(begin, at_ - begin);
}

std::string_view TextScanner::Word() {
  SkipBlank();
  word_line_ = line_;
  return CutWord();
}

std::string_view TextScanner::PeekWord() {
  SkipBlank();
  const size_t at = at_;
  const std::string_view word = CutWord();
  at_ = at;
  return word;
}

std::vector<std::string_view> TextScanner::ReadRestOfLine() {
  std::vector<std::string_view> words;
  while (true) {
    while (!AtEndOfLine() && IsBlank(text_[at_])) ++at_;
    if (AtEndOfLine() || text_[at_] == '{') return words;
    words.push_back(CutWord());
  }
}

std::vector<std::string_view> TextScanner::ReadWordsOfLine() {
  SkipBlank();
  word_line_ = line_;
  std::vector<std::string_view> words;
  while (true) {
    while (!AtEndOfLine() && IsBlank(text_[at_])) ++at_;
    if (AtEndOfLine()) return words;
    words.push_back(CutWord());
  }
}

bool TextScanner::IsCutInLastNumber() const {
  const std::string_view text = text_;
  if (text.empty() || text.back() == '\n' || IsBlank(text.back())) return false;
  const size_t last_begin = text.rfind('\n') + 1;  // 0 without one
  if (last_begin < 2) return false;
  const size_t before_begin = text.rfind('\n', last_begin - 2) + 1;
  std::optional<size_t> alike;
  std::string_view before = text.substr(before_begin, last_begin - before_begin);
  while (!before.empty()) {
    const size_t begin = before.find_first_not_of(" \t\r\n");
    if (begin == std::string_view::npos) break;
    const size_t end = std::min(before.find_first_of(" \t\r\n", begin), before.size());
    const size_t decimals = CountDecimals(before.substr(begin, end - begin));
    if (decimals != alike.value_or(decimals)) return false;
    alike = decimals;
    before.remove_prefix(end);
  }
  const std::string_view last = text.substr(text.find_last_of(" \t\n") + 1);
  return alike && CountDecimals(last) < *alike;
}

void TextScanner::Expect(std::string_view word) {
  const std::string_view found = Word();
  if (LowerCase(found) != LowerCase(word)) Fail("'" + std::string(word) + "'", found);
}

double TextScanner::Number(const std::string& what) { return ToNumber(Word(), what); }

double TextScanner::ToNumber(std::string_view word, const std::string& what) const {
  double value = 0.0;
  const std::string_view digits = word.starts_with('+') ? word.substr(1) : word;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool whole = end == digits.data() + digits.size();
  if (error == std::errc::result_out_of_range && whole) value = 0.0;  // underflow: 1e-400
  if ((error != std::errc() && error != std::errc::result_out_of_range) || !whole ||
      digits.empty()) {
    Fail(what + " (a number)", word);
  }
  if (!std::isfinite(value) || std::abs(value) > kMaxMagnitude) {
    Fail(what + " (a number below 1e9)", word);
  }
  return value;
}

std::string ReadTextFile(const std::filesystem::path& path) {
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  if (error) throw InputError(path.string() + ": cannot be read: " + error.message());
  if (size > kMaxFileBytes) {
    throw InputError(path.string() + ": expected a text of at most 1 GiB, found " +
                     std::to_string(size) + " bytes");
  }
  std::ifstream file = OpenFile(path);
  std::string text(size, '\0');
  file.read(text.data(), static_cast<std::streamsize>(size));
  if (!file) throw InputError(path.string() + ": cannot be read: expected a text file");
  return text;
}

}  // namespace ossa::recon
