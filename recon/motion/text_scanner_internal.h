#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace ossa::recon {

/// Reads a text file of mocap word by word or line by line and knows where it is, so that every
/// refusal names file, line, what was expected and what stands there.
class TextScanner {
 public:
  TextScanner(std::string text, std::string source);

  /// Next word, "" at the end; '{' and '}' are words of their own. Skips line ends.
  std::string_view Word();
  std::string_view PeekWord();
  /// The words left on the line last begun, up to '{' or the line's end; does not go on to the
  /// next.
  std::vector<std::string_view> ReadRestOfLine();
  /// Words of the next line that has any; empty at the end of the file.
  std::vector<std::string_view> ReadWordsOfLine();

  void Expect(std::string_view word);
  double Number(const std::string& what);
  double ToNumber(std::string_view word, const std::string& what) const;

  /// Whether the text ends without a line end in a number of fewer decimals than all numbers of the
  /// line before have, which are alike: whoever wrote it did not come to its end.
  bool IsCutInLastNumber() const;

  int line() const { return word_line_; }
  /// Nothing that is announced can be longer than what is left.
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
  int line_ = 1;       // of at_
  int word_line_ = 1;  // of the word or line given last
};

/// The whole file; throws InputError when it cannot be read or is larger than 1 GiB.
std::string ReadTextFile(const std::filesystem::path& path);

/// ASCII lower case.
std::string Lower(std::string_view text);

}  // namespace ossa::recon
