#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <istream>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ossa::recon {

/// Longest line that a text reader accepts. The widest real formats (NTU, six bodies a frame, one
/// joint a line; KERAAL, 175 numbers a line) stay below 20 kB. A file that is one endless line is
/// refused at this size instead of being held in memory.
inline constexpr size_t kLongestLine = size_t{1} << 20;

/// Reads a text line by line, with bounded memory, without line ends (\n, \r\n or \r) and without a
/// leading byte-order mark. It knows its position, so errors name file and line.
class TextLines {
 public:
  TextLines(std::istream& stream, std::string source)
      : stream_(stream), source_(std::move(source)) {}

  /// False at the end of the text. Throws InputError for a line longer than kLongestLine.
  bool Next();
  /// As Next(), but skips blank lines.
  bool NextFilled();
  /// As NextFilled(), but the end of the text is an error: `what` was expected.
  void Expect(std::string_view what);

  std::string_view line() const { return line_; }
  /// Whether the line had a line end: the last line of a truncated text has none.
  bool ended() const { return ended_; }
  size_t number() const { return number_; }
  const std::string& source() const { return source_; }

  /// Throws InputError "FILE: line N: expected EXPECTED, found FOUND"; FOUND is cut short and made
  /// printable.
  [[noreturn]] void Fail(std::string_view expected, std::string_view found) const;

 private:
  std::istream& stream_;
  std::string source_;
  std::string line_;
  bool ended_ = false;
  size_t number_ = 0;
};

/// A short, quoted, printable form of any bytes, for messages. Names in any language are unchanged.
std::string Quoted(std::string_view bytes);

/// The fields between separators; a separator at the very end starts no further field.
std::vector<std::string_view> Split(std::string_view line, char separator);
/// The fields between white space.
std::vector<std::string_view> Words(std::string_view line);
std::string_view Trimmed(std::string_view text);

/// Whether the field consists of number characters only, for format detection; NumberIn parses
/// numbers.
bool LooksLikeNumber(std::string_view field);
/// A finite number that fills the whole field. Throws with file and line otherwise; `what` names
/// the field.
double NumberIn(const TextLines& lines, std::string_view field, std::string_view what);
/// Whether a field is some spelling of NaN, which programs write for unseen joints.
bool IsNan(std::string_view field);
/// A point of three numbers; none if all fields are blank or one is NaN.
std::optional<Eigen::Vector3d> PlaceIn(const TextLines& lines,
                                       const std::array<std::string_view, 3>& fields,
                                       std::string_view what);
/// A whole number in [low, high].
long WholeNumberIn(const TextLines& lines, std::string_view field, std::string_view what, long low,
                   long high);
/// Describes what is wrong with a time step, seconds; "" if nothing is. Times may repeat (loggers
/// poll faster than sensors deliver), but must not run backwards or jump by more than a day (an
/// adjusted clock, or another unit).
std::string WrongStep(double step_s);
/// Checks the time steps between rows; throws with file and line.
class RowTimes {
 public:
  void Take(const TextLines& lines, double time_s);

 private:
  std::optional<double> last_s_;
};

/// All fields of a line as finite numbers, exactly `count` of them.
std::vector<double> NumbersIn(const TextLines& lines, std::span<const std::string_view> fields,
                              size_t count, std::string_view what);

}  // namespace ossa::recon
