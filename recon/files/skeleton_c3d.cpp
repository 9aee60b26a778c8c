// C3D (c3d.org): points of the 3D data section, little-endian ("Intel") files, integers or
// floats. No Debian package reads C3D, hence these pages. Labels that name joints are taken as they
// are; else Plug-in Gait markers give joint centres. Laboratories have z up.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>

#include "recon/files/binary_bytes_internal.h"
#include "recon/files/joint_names_internal.h"
#include "recon/files/marker_centres_internal.h"

namespace ossa::recon {
namespace {

// Constants: of the C3D format.

constexpr size_t kBlock = 512;
constexpr size_t kLastByHeader = 65535;  // the header counts in 16 bits

struct C3d {
  size_t points = 0;
  size_t first = 0;  // by the header
  size_t last = 0;
  size_t frames = 0;
  size_t words_per_frame = 0;  // of points and analog samples
  double scale = 1;
  bool floats = false;
  size_t data = 0;  // byte where the frames begin
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

bool IsC3d(const SkeletonSample& sample) {
  return sample.head.size() >= kBlock && sample.head[1] == 0x50 && sample.head[0] > 1;
}

C3d ReadC3dHeader(const std::string& name, std::string_view bytes) {
  NeedBytes(name, bytes, 0, kBlock, "a C3D header");
  C3d c3d;
  const auto word = [&](size_t number) { return ValueAt<uint16_t>(bytes, 2 * (number - 1)); };
  c3d.points = word(2);
  const size_t analog = word(3);
  c3d.first = word(4);
  c3d.last = word(5);
  const auto scale = ValueAt<float>(bytes, 12);
  const auto rate = ValueAt<float>(bytes, 20);
  if (!std::isfinite(scale) || scale == 0) FailAtByte(name, 12, "a scale factor");
  if (!std::isfinite(rate) || rate <= 0) FailAtByte(name, 20, "a frame rate");
  c3d.floats = scale < 0;
  c3d.scale = c3d.floats ? 1.0 : static_cast<double>(scale);
  c3d.rate_Hz = static_cast<double>(rate);
  if (word(9) < 2) FailAtByte(name, 16, "the block where the data begins");
  c3d.data = (static_cast<size_t>(word(9)) - 1) * kBlock;
  if (c3d.points == 0) FailAtByte(name, 2, "at least one point");
  c3d.words_per_frame = 4 * c3d.points + analog;
  return c3d;
}

// A parameter's value.
struct Parameter {
  int type = 0;           // -1: texts; else bytes a number, 4 being floats
  std::string_view data;  // all of it
  size_t length = 0;      // of each of its texts
};
using Parameters = std::map<std::string, Parameter>;  // by GROUP:NAME

// At `at`: element size, number of dimensions, dimensions, data.
Parameter ParameterAt(const std::string& name, std::string_view bytes, size_t at) {
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
  parameter.data = bytes.substr(at + 2 + dimensions, count);
  parameter.length = dimensions > 0 ? static_cast<uint8_t>(bytes[at + 2]) : size_t{1};
  return parameter;
}

// Where the records of the parameter section begin.
size_t BeginOfParameters(const std::string& name, std::string_view bytes) {
  const size_t begin = (static_cast<size_t>(static_cast<uint8_t>(bytes[0])) - 1) * kBlock;
  NeedBytes(name, bytes, begin, 4, "the parameter section");
  constexpr uint8_t kIntel = 84;
  if (static_cast<uint8_t>(bytes[begin + 3]) != kIntel) {
    FailAtByte(name, begin + 3,
               "an Intel file (processor type 84); DEC and MIPS files are not read");
  }
  return begin + 4;
}

// Walks the records: name length, group id, name, offset to the next, then for parameters (positive
// ids) their values. A group may be named after its parameters.
Parameters ParametersIn(const std::string& name, std::string_view bytes) {
  std::map<std::pair<int, std::string>, Parameter> by_id;
  std::map<int, std::string> groups;
  for (size_t at = BeginOfParameters(name, bytes);;) {
    NeedBytes(name, bytes, at, 2, "a parameter");
    const auto name_length =
        static_cast<size_t>(std::abs(static_cast<int>(static_cast<int8_t>(bytes[at]))));
    const int id = static_cast<int8_t>(bytes[at + 1]);
    if (name_length == 0 || id == 0) break;
    NeedBytes(name, bytes, at, 2 + name_length + 2, "a parameter's name");
    const std::string key(bytes.substr(at + 2, name_length));
    const size_t next_at = at + 2 + name_length;
    const auto next = ValueAt<uint16_t>(bytes, next_at);
    if (id < 0) groups[-id] = key;
    if (id > 0) by_id[{id, key}] = ParameterAt(name, bytes, next_at + 2);
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

// A number of frames: 16 bits without a sign, twice 16 bits, the lower ones first, or a float; 0
// where it is none.
size_t FramesSaid(const Parameters& parameters, const char* key) {
  const auto found = parameters.find(key);
  if (found == parameters.end()) return 0;
  const auto& [type, data, length] = found->second;
  if (type == 4 && data.size() >= sizeof(float)) {
    constexpr float kMost = 4294967040.0f;  // the last below 2^32; no unit: a count
    const auto count = ValueAt<float>(data, 0);
    return count >= 1 && count <= kMost ? static_cast<size_t>(count) : 0;
  }
  if (type != 2 || data.size() < 2) return 0;
  const size_t high = data.size() < 4 ? 0 : ValueAt<uint16_t>(data, 2);
  return (high << 16) + ValueAt<uint16_t>(data, 0);
}

// The header's count, unless it ends beyond what the header can say: then the parameters', which
// programs write for that.
size_t FramesIn(const std::string& name, const C3d& c3d, const Parameters& parameters) {
  const size_t end = FramesSaid(parameters, "TRIAL:ACTUAL_END_FIELD");
  const size_t start = FramesSaid(parameters, "TRIAL:ACTUAL_START_FIELD");
  if (end > kLastByHeader && end >= start) return end - (start > 0 ? start : c3d.first) + 1;
  const size_t count =
      std::max(FramesSaid(parameters, "POINT:FRAMES"), FramesSaid(parameters, "POINT:LONG_FRAMES"));
  if (c3d.first + count > kLastByHeader + 1) return count;
  if (c3d.last < c3d.first) FailAtByte(name, 8, "a last frame after the first");
  return c3d.last - c3d.first + 1;
}

void TakeLabels(const std::string& name, const Parameters& parameters, C3d& c3d) {
  const auto labels = parameters.find("POINT:LABELS");
  if (labels == parameters.end() || labels->second.length == 0) {
    FailAtByte(name, kBlock, "the parameter POINT:LABELS");
  }
  const auto& [type, data, length] = labels->second;
  for (size_t at = 0; at + length <= data.size(); at += length) {
    std::string label(Trimmed(data.substr(at, length)));
    // "Subject:LASI": the subject's name is no part of the marker's.
    c3d.labels.push_back(
        label.substr(label.find(':') == std::string::npos ? 0 : label.find(':') + 1));
  }
  if (const auto units = parameters.find("POINT:UNITS"); units != parameters.end()) {
    const std::string_view unit = Trimmed(units->second.data);
    c3d.metres_per_unit = unit == "m" ? 1.0 : unit == "cm" ? 1e-2 : 1e-3;
  }
}

// LSHO, LELB, ... are markers on the skin: joint centres are worked out from all of them.
bool IsSkinMarker(const std::string& label) {
  return label.size() == 4 && (label.ends_with("SHO") || label.ends_with("ELB") ||
                               label.ends_with("KNE") || label.ends_with("ANK"));
}

BodyRecord BodyIn(const std::map<std::string, Eigen::Vector3d>& points) {
  BodyRecord body;
  bool any = false;
  for (const auto& [label, position] : points) {
    const auto joint = JointCalled(label);
    if (!joint || IsSkinMarker(label)) continue;
    PutJoint(body, *joint, position);
    any = true;
  }
  return any ? body : JointCentres(points);
}

SkeletonSequence ReadC3d(SkeletonInput& input) {
  const std::string bytes = ReadAllBytes(input);
  C3d c3d = ReadC3dHeader(input.name, bytes);
  const Parameters parameters = ParametersIn(input.name, bytes);
  c3d.frames = FramesIn(input.name, c3d, parameters);
  TakeLabels(input.name, parameters, c3d);
  const size_t word = c3d.floats ? 4 : 2;
  NeedBytes(input.name, bytes, c3d.data, c3d.frames * c3d.words_per_frame * word, "all frames");
  SkeletonSequence sequence{input.name, {}};
  for (size_t f = 0; f < c3d.frames; ++f) {
    std::map<std::string, Eigen::Vector3d> points;
    for (size_t p = 0; p < std::min(c3d.points, c3d.labels.size()); ++p) {
      const size_t at = c3d.data + (f * c3d.words_per_frame + 4 * p) * word;
      std::array<double, 4> v{};
      for (size_t i = 0; i < 4; ++i) {
        v[i] = c3d.floats ? static_cast<double>(ValueAt<float>(bytes, at + 4 * i))
                          : static_cast<double>(ValueAt<int16_t>(bytes, at + 2 * i));
      }
      // A negative fourth word says that the point was not seen.
      if (v[3] < 0) continue;
      const Eigen::Vector3d at_m =
          c3d.scale * c3d.metres_per_unit * Eigen::Vector3d(v[0], v[2], -v[1]);
      if (!at_m.allFinite()) FailAtByte(input.name, at, "finite coordinates");
      if (!at_m.isZero(0.0)) points[c3d.labels[p]] = at_m;
    }
    const double step_s = input.FrameTime_s(1.0 / c3d.rate_Hz);
    sequence.frames.push_back(OneBodyFrame(f, static_cast<double>(f) * step_s, BodyIn(points)));
  }
  TakeOutNobody(sequence);
  return sequence;
}

constexpr SkeletonFormat kFormats[] = {{"c3d", IsC3d, ReadC3d}};

}  // namespace

std::span<const SkeletonFormat> C3dFormats() { return kFormats; }

}  // namespace ossa::recon
