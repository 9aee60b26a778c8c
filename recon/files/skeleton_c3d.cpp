// C3D (c3d.org): points of the 3D data section, as integers or floats in the formats of Intel, DEC
// and MIPS processors. Debian has no package that reads C3D. Labels that name joints are used
// directly; otherwise joint centres are computed from Plug-in Gait markers. Laboratories use z as
// the up axis.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <map>

#include "recon/files/binary_bytes_internal.h"
#include "recon/files/origin_points_internal.h"

namespace ossa::recon {
namespace {

// Constants: of the C3D format.

constexpr size_t kBlock = 512;
constexpr size_t kLastByHeader = 65535;  // the header's frame numbers have 16 bits

struct C3d {
  size_t points = 0;
  size_t first = 0;  // first frame number in the header
  size_t last = 0;
  size_t frames = 0;
  size_t words_per_frame = 0;  // points and analog samples
  double scale = 1;
  bool floats = false;
  size_t data = 0;  // byte offset of the first frame
  double rate_Hz = 0;
  double metres_per_unit = 1e-3;
  std::vector<std::string> labels;
};

void NeedBytes(const std::string& name, std::string_view bytes, size_t offset, size_t count,
               const char* what) {
  if (offset > bytes.size() || count > bytes.size() - offset) {
    FailAtByte(name, bytes.size(), fmt::format("{} up to byte {}", what, offset + count));
  }
}

/// Number format of the file; values by the format.
enum class Processor { kIntel = 84, kDec = 85, kMips = 86 };

/// The bytes of a file, read as numbers. The caller has checked that enough bytes are there.
class C3dBytes {
 public:
  C3dBytes(std::string_view bytes, Processor processor) : bytes_(bytes), processor_(processor) {}

  std::string_view all() const { return bytes_; }
  uint16_t Word(size_t at) const {
    const uint32_t low = Byte(at), high = Byte(at + 1);
    return static_cast<uint16_t>(processor_ == Processor::kMips ? (low << 8) + high
                                                                : (high << 8) + low);
  }
  double Integer(size_t at) const { return static_cast<int16_t>(Word(at)); }
  double Real(size_t at) const {
    // DEC floats have their 16-bit halves exchanged, and an exponent that is larger by two.
    const bool high_first = processor_ != Processor::kIntel;
    const uint32_t high = Word(high_first ? at : at + 2), low = Word(high_first ? at + 2 : at);
    const auto value = static_cast<double>(std::bit_cast<float>((high << 16) + low));
    return processor_ == Processor::kDec ? value / 4 : value;
  }

 private:
  uint32_t Byte(size_t at) const { return static_cast<uint8_t>(bytes_[at]); }

  std::string_view bytes_;
  Processor processor_;
};

bool IsC3d(const SkeletonSample& sample) {
  return sample.head.size() >= kBlock && sample.head[1] == 0x50 && sample.head[0] > 1;
}

size_t FindParameters(const std::string& name, std::string_view bytes) {
  NeedBytes(name, bytes, 0, kBlock, "a C3D header");
  const size_t begin = (static_cast<size_t>(static_cast<uint8_t>(bytes[0])) - 1) * kBlock;
  NeedBytes(name, bytes, begin, 4, "the parameter section");
  return begin;
}

Processor ReadProcessor(const std::string& name, std::string_view bytes) {
  const size_t at = FindParameters(name, bytes) + 3;
  const auto type = static_cast<uint8_t>(bytes[at]);
  if (type < 84 || type > 86) {
    FailAtByte(name, at,
               fmt::format("processor type 84, 85 or 86 (Intel, DEC, MIPS), found {}", type));
  }
  return static_cast<Processor>(type);
}

C3d ReadC3dHeader(const std::string& name, const C3dBytes& bytes) {
  C3d c3d;
  const auto word = [&](size_t number) { return bytes.Word(2 * (number - 1)); };
  c3d.points = word(2);
  const size_t analog = word(3);
  c3d.first = word(4);
  c3d.last = word(5);
  const double scale = bytes.Real(12);
  c3d.rate_Hz = bytes.Real(20);
  if (!std::isfinite(scale) || scale == 0) FailAtByte(name, 12, "a scale factor");
  c3d.floats = scale < 0;
  c3d.scale = c3d.floats ? 1.0 : scale;
  if (word(9) < 2) FailAtByte(name, 16, "the block where the data begins");
  c3d.data = (static_cast<size_t>(word(9)) - 1) * kBlock;
  if (c3d.points == 0) FailAtByte(name, 2, "at least one point");
  c3d.words_per_frame = 4 * c3d.points + analog;
  return c3d;
}

// A parameter's value.
struct Parameter {
  int type = 0;       // -1: text; else bytes per number, 4 for floats
  size_t begin = 0;   // byte offset in the file
  size_t size = 0;    // bytes
  size_t length = 0;  // length of each text
};
using Parameters = std::map<std::string, Parameter>;  // by GROUP:NAME

// At `at`: element size, number of dimensions, dimensions, data.
Parameter ReadParameter(const std::string& name, std::string_view bytes, size_t at) {
  NeedBytes(name, bytes, at, 2, "a parameter's type");
  Parameter parameter;
  parameter.type = static_cast<int8_t>(bytes[at]);
  const size_t dimensions = static_cast<uint8_t>(bytes[at + 1]);
  NeedBytes(name, bytes, at + 2, dimensions, "a parameter's dimensions");
  auto count = static_cast<size_t>(std::abs(parameter.type));
  for (size_t d = 0; d < dimensions; ++d) {
    count *= static_cast<uint8_t>(bytes[at + 2 + d]);
    if (count > bytes.size()) FailAtByte(name, at + 2 + d, "dimensions that fit the file");
  }
  NeedBytes(name, bytes, at + 2 + dimensions, count, "a parameter's data");
  parameter.begin = at + 2 + dimensions;
  parameter.size = count;
  parameter.length = dimensions > 0 ? static_cast<uint8_t>(bytes[at + 2]) : size_t{1};
  return parameter;
}

// Names are the same in any case; most programs write capitals.
std::string UpperCase(std::string_view name) {
  std::string upper(name);
  for (char& c : upper) {
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  }
  return upper;
}

// Walks the records: name length, group id, name, offset to the next record; parameters (positive
// ids) then have their values. A group's name may follow its parameters.
Parameters ReadParameters(const std::string& name, const C3dBytes& numbers) {
  const std::string_view bytes = numbers.all();
  std::map<std::pair<int, std::string>, Parameter> by_id;
  std::map<int, std::string> groups;
  for (size_t at = FindParameters(name, bytes) + 4;;) {
    NeedBytes(name, bytes, at, 2, "a parameter");
    const auto name_length =
        static_cast<size_t>(std::abs(static_cast<int>(static_cast<int8_t>(bytes[at]))));
    const int id = static_cast<int8_t>(bytes[at + 1]);
    if (name_length == 0 || id == 0) break;
    NeedBytes(name, bytes, at, 2 + name_length + 2, "a parameter's name");
    const std::string key = UpperCase(bytes.substr(at + 2, name_length));
    const size_t next_at = at + 2 + name_length;
    const size_t next = numbers.Word(next_at);
    if (id < 0) groups[-id] = key;
    if (id > 0) by_id[{id, key}] = ReadParameter(name, bytes, next_at + 2);
    if (next == 0) break;
    at = next_at + next;
  }
  groups.try_emplace(1, "POINT");
  Parameters parameters;
  for (const auto& [key, parameter] : by_id) {
    parameters[groups[key.first] + ":" + key.second] = parameter;
  }
  return parameters;
}

// A frame count: unsigned 16 bits, or two 16-bit words (low first), or a float; 0 if it is none of
// these.
size_t ReadFrameCount(const C3dBytes& bytes, const Parameters& parameters, const char* key) {
  const auto found = parameters.find(key);
  if (found == parameters.end()) return 0;
  const Parameter& parameter = found->second;
  if (parameter.type == 4 && parameter.size >= sizeof(float)) {
    constexpr double kMost = 4294967040.0;  // frames, of the format: the last float below 2^32
    const double count = bytes.Real(parameter.begin);
    return count >= 1 && count <= kMost ? static_cast<size_t>(count) : 0;
  }
  if (parameter.type != 2 || parameter.size < 2) return 0;
  const size_t high = parameter.size < 4 ? 0 : bytes.Word(parameter.begin + 2);
  return (high << 16) + bytes.Word(parameter.begin);
}

// The header's count, unless it is saturated: then that of the parameters, which programs write for
// long recordings.
size_t CountFrames(const std::string& name, const C3dBytes& bytes, const C3d& c3d,
                   const Parameters& parameters) {
  const auto read = [&](const char* key) { return ReadFrameCount(bytes, parameters, key); };
  const size_t end = read("TRIAL:ACTUAL_END_FIELD");
  const size_t start = read("TRIAL:ACTUAL_START_FIELD");
  if (end > kLastByHeader && end >= start) return end - (start > 0 ? start : c3d.first) + 1;
  const size_t count = std::max(read("POINT:FRAMES"), read("POINT:LONG_FRAMES"));
  if (c3d.first + count > kLastByHeader + 1) return count;
  if (c3d.last < c3d.first) FailAtByte(name, 8, "a last frame after the first");
  return c3d.last - c3d.first + 1;
}

// The rate in the header, else in the parameters: some programs write it only there.
double ReadRate_Hz(const std::string& name, const C3dBytes& bytes, const C3d& c3d,
                   const Parameters& parameters) {
  const auto is_rate = [](double rate_Hz) { return std::isfinite(rate_Hz) && rate_Hz > 0; };
  if (is_rate(c3d.rate_Hz)) return c3d.rate_Hz;
  const auto found = parameters.find("POINT:RATE");
  if (found != parameters.end() && found->second.type == 4 && found->second.size >= sizeof(float)) {
    const double rate_Hz = bytes.Real(found->second.begin);
    if (is_rate(rate_Hz)) return rate_Hz;
  }
  FailAtByte(name, 20, "a frame rate, there or in POINT:RATE");
}

std::string_view ReadText(const C3dBytes& bytes, const Parameter& parameter) {
  return bytes.all().substr(parameter.begin, parameter.size);
}

// Texts have a fixed length and are padded with blanks, by some programs with zeros.
std::string_view TrimPadding(std::string_view text) {
  return Trimmed(text.substr(0, text.find('\0')));
}

// Files of more than 255 points continue their labels in LABELS2, LABELS3, ...
void ReadLabels(const std::string& name, const C3dBytes& bytes, const Parameters& parameters,
                C3d& c3d) {
  for (size_t more = 1; c3d.labels.size() < c3d.points; ++more) {
    const std::string key = "POINT:LABELS" + (more == 1 ? "" : std::to_string(more));
    const auto labels = parameters.find(key);
    if (labels == parameters.end() || labels->second.length == 0) break;
    const std::string_view text = ReadText(bytes, labels->second);
    const size_t length = labels->second.length;
    for (size_t at = 0; at + length <= text.size(); at += length) {
      c3d.labels.emplace_back(TrimPadding(text.substr(at, length)));
    }
  }
  if (c3d.labels.empty()) FailAtByte(name, kBlock, "the parameter POINT:LABELS");
  c3d.labels.resize(std::min(c3d.labels.size(), c3d.points));
}

void ReadUnits(const std::string& name, const C3dBytes& bytes, const Parameters& parameters,
               C3d& c3d) {
  const auto units = parameters.find("POINT:UNITS");
  if (units == parameters.end()) return;
  const std::string_view unit = TrimPadding(ReadText(bytes, units->second));
  if (unit.empty()) return;
  const auto metres = MetresPerUnit(unit);
  if (!metres) {
    FailAtByte(name, units->second.begin, "POINT:UNITS mm, cm or m, found " + Quoted(unit));
  }
  c3d.metres_per_unit = *metres;
}

// Whether Y_SCREEN says that y points up the screen. Not all programs mean the vertical by it.
bool StatesYUp(const C3dBytes& bytes, const Parameters& parameters) {
  const auto screen = parameters.find("POINT:Y_SCREEN");
  if (screen == parameters.end()) return false;
  const std::string_view axis = TrimPadding(ReadText(bytes, screen->second));
  return axis == "+Y" || axis == "Y";
}

// A negative fourth word, the residual, means that the point was not seen; so does NaN. `marks`
// says whether there was one of either.
SeenPoint ReadPoint(const std::string& name, const C3dBytes& bytes, const C3d& c3d, size_t at,
                    bool& marks) {
  std::array<double, 4> v{};
  for (size_t i = 0; i < 4; ++i) {
    v[i] = c3d.floats ? bytes.Real(at + 4 * i) : bytes.Integer(at + 2 * i);
  }
  if (v[3] < 0 || std::isnan(v[0]) || std::isnan(v[1]) || std::isnan(v[2])) {
    marks = true;
    return std::nullopt;
  }
  const Eigen::Vector3d at_m = c3d.scale * c3d.metres_per_unit * Eigen::Vector3d(v[0], v[2], -v[1]);
  if (!at_m.allFinite()) FailAtByte(name, at, "finite coordinates");
  return at_m;
}

// [frame][point]. Some programs write the origin for points that were not seen, with the residual
// of a seen one: their files mark none as unseen.
std::vector<std::vector<SeenPoint>> ReadPoints(const std::string& name, const C3dBytes& bytes,
                                               const C3d& c3d) {
  const size_t word = c3d.floats ? 4 : 2;
  NeedBytes(name, bytes.all(), c3d.data, c3d.frames * c3d.words_per_frame * word, "all frames");
  std::vector<std::vector<SeenPoint>> rows(c3d.frames);
  bool marks = false;
  for (size_t f = 0; f < c3d.frames; ++f) {
    for (size_t p = 0; p < c3d.labels.size(); ++p) {
      const size_t at = c3d.data + (f * c3d.words_per_frame + 4 * p) * word;
      rows[f].push_back(ReadPoint(name, bytes, c3d, at, marks));
    }
  }
  if (!marks) RemoveUnseenAtOrigin(rows);
  return rows;
}

SkeletonSequence ReadC3d(SkeletonInput& input) {
  const std::string text = ReadAllBytes(input);
  const C3dBytes bytes(text, ReadProcessor(input.name, text));
  C3d c3d = ReadC3dHeader(input.name, bytes);
  const Parameters parameters = ReadParameters(input.name, bytes);
  c3d.frames = CountFrames(input.name, bytes, c3d, parameters);
  c3d.rate_Hz = ReadRate_Hz(input.name, bytes, c3d, parameters);
  ReadLabels(input.name, bytes, parameters, c3d);
  ReadUnits(input.name, bytes, parameters, c3d);
  SkeletonSequence sequence{input.name, {}};
  const auto bodies =
      FindPointBodies(c3d.labels, input.mapping, {input.name, "POINT:LABELS"}, sequence.warnings);
  const double step_s = 1.0 / c3d.rate_Hz;
  const auto rows = ReadPoints(input.name, bytes, c3d);
  for (size_t f = 0; f < rows.size(); ++f) {
    sequence.frames.push_back(MakeFrame(bodies, rows[f], f, static_cast<double>(f) * step_s));
  }
  RemoveEmptyBodies(sequence);
  // The file's y axis in the coordinates of ReadPoint.
  RotateUpright(sequence, {'y', -Eigen::Vector3d::UnitZ(), StatesYUp(bytes, parameters)});
  return sequence;
}

constexpr SkeletonFormat kC3dFormats[] = {{"c3d", IsC3d, ReadC3d}};

}  // namespace

std::span<const SkeletonFormat> C3dFormats() { return kC3dFormats; }

}  // namespace ossa::recon
