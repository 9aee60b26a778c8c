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

/// Longest line a text reader accepts. The widest real format (NTU, six bodies a frame, one joint a
/// line; KERAAL, 175 numbers a line) stays under 20 kB; a file of one endless line is refused after
/// this many bytes instead of being held in memory.
inline constexpr size_t kLongestLine = size_t{1} << 20;

/// Lines of a text, one at a time, bounded, without their line ends (\n, \r\n or \r) and without a
/// leading byte-order mark. Knows where it is, so that every complaint names file and line.
class TextLines {
 public:
  TextLines(std::istream& stream, std::string source)
      : stream_(stream), source_(std::move(source)) {}

  /// False at the end of the text. Throws InputError for a line longer than kLongestLine.
  bool Next();
  /// As Next(), but skips lines that hold only white space.
  bool NextFilled();
  /// As NextFilled(), but the end of the text is an error: `what` was expected.
  void Expect(std::string_view what);

  std::string_view line() const { return line_; }
  /// Whether the line had a line end: the last one of a text that was cut has none.
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

/// A short, printable form of any bytes, in quotes, for messages; names in any language stay what
/// they are.
std::string Quoted(std::string_view bytes);

/// The pieces of a line between separators; a separator at the very end opens no last piece.
std::vector<std::string_view> Split(std::string_view line, char separator);
/// The pieces of a line between white space.
std::vector<std::string_view> Words(std::string_view line);
std::string_view Trimmed(std::string_view text);

/// Whether the field is made of what numbers are made of, to tell formats apart: NumberIn reads
/// them.
bool LooksLikeNumber(std::string_view field);
/// A finite number that fills the whole field. Throws with file and line otherwise; `what` names
/// the field.
double NumberIn(const TextLines& lines, std::string_view field, std::string_view what);
/// Whether a field says "not a number", as programs write what they have not seen.
bool IsNan(std::string_view field);
/// Three numbers; none where all fields are blank or one is not a number.
std::optional<Eigen::Vector3d> PlaceIn(const TextLines& lines,
                                       const std::array<std::string_view, 3>& fields,
                                       std::string_view what);
/// A whole number in [low, high].
long WholeNumberIn(const TextLines& lines, std::string_view field, std::string_view what, long low,
                   long high);
/// What is wrong with a frame that comes this much after the one before it, seconds; "" when
/// nothing is: times may stand still for a frame (loggers ask faster than sensors answer), but not
/// run backwards, nor leap by more than a day (a clock that was set, or another unit).
std::string WrongStep(double step_s);
/// Asks that of each row's time in turn, and throws with file and line.
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
