#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace ossa::recon {

/// Reads a mocap text file by words or lines and tracks its position, so that every error names
/// file, line, expectation and what was found.
class TextScanner {
 public:
  TextScanner(std::string text, std::string source);

  /// Next word, "" at the end; '{' and '}' are words of their own. Skips line ends.
  std::string_view Word();
  std::string_view PeekWord();
  /// The remaining words of the current line, up to '{' or the line's end; does not continue on the
  /// next line.
  std::vector<std::string_view> ReadRestOfLine();
  /// Words of the next non-blank line; empty at the end of the file.
  std::vector<std::string_view> ReadWordsOfLine();

  void Expect(std::string_view word);
  double Number(const std::string& what);
  double ToNumber(std::string_view word, const std::string& what) const;

  /// Whether the text ends, without a line end, in a number with fewer decimals than all earlier
  /// numbers of the line, which have the same: then it is truncated.
  bool IsCutInLastNumber() const;

  int line() const { return word_line_; }
  /// Bytes left: an upper bound for any announced size.
  size_t BytesLeft() const { return text_.size() - at_; }
  const std::string& source() const { return source_; }
  [[noreturn]] void Fail(const std::string& expected, std::string_view found) const;

 private:
  void SkipBlank();
  bool AtEndOfLine() const;
  std::string_view CutWord();

  std::string text_;
  std::string source_;
  size_t at_ = 0;
  int line_ = 1;       // line of at_
  int word_line_ = 1;  // line of the last word or line returned
};

/// The whole file; throws InputError when it cannot be read or is larger than 1 GiB.
std::string ReadTextFile(const std::filesystem::path& path);

}  // namespace ossa::recon
