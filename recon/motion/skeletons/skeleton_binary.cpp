// Binary recordings: Kinect Stream Saver's joint positions and C3D.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>

#include "depth/error.h"
#include "recon/motion/skeletons/joint_names_internal.h"
#include "recon/motion/skeletons/marker_centres_internal.h"
#include "recon/motion/skeletons/skeleton_formats_internal.h"

namespace ossa::recon {
namespace {

[[noreturn]] void Fail(const std::string& name, size_t byte, const std::string& expected) {
  throw InputError(fmt::format("{}: byte {}: expected {}", name, byte, expected));
}

std::string ReadAll(SkeletonInput& input) {
  constexpr size_t kMostBytes = size_t{1} << 30;
  std::string bytes;
  std::array<char, 1 << 16> block{};
  while (input.stream.read(block.data(), block.size()) || input.stream.gcount() > 0) {
    bytes.append(block.data(), static_cast<size_t>(input.stream.gcount()));
    if (bytes.size() > kMostBytes) Fail(input.name, bytes.size(), "at most 1 GiB");
  }
  return bytes;
}

// Little-endian values; the caller has checked that the bytes are there.
template <typename T>
T ValueAt(std::string_view bytes, size_t offset) {
  T value{};
  std::memcpy(&value, bytes.data() + offset, sizeof(T));
  return value;
}

// --- Kinect Stream Saver (SDK 1.8): per frame six skeletons of 20 joints in SDK order, four floats
// each: x, y, z in camera space, metres, and the tracking state; a skeleton not seen is all zero.
// Times, when its liTimeStamp.binary lies beside: five int64 a frame, the last in milliseconds.

constexpr size_t kSaverBodies = 6;
constexpr size_t kSaverFrameBytes = kSaverBodies * kJointCount * 4 * sizeof(float);

bool IsStreamSaver(const SkeletonSample& sample) {
  if (sample.head.size() < kSaverFrameBytes) return false;
  for (size_t j = 0; j < kSaverBodies * kJointCount; ++j) {
    std::array<float, 4> v{};
    std::memcpy(v.data(), sample.head.data() + 16 * j, sizeof(v));
    if (v[3] != 0 && v[3] != 1 && v[3] != 2) return false;
    for (int axis = 0; axis < 3; ++axis) {
      if (!(std::abs(v[static_cast<size_t>(axis)]) < 20)) return false;
    }
  }
  return true;
}

std::vector<double> SaverTimes_s(const SkeletonInput& input, size_t frames) {
  constexpr size_t kRow = 5 * sizeof(int64_t);
  const size_t slash = input.name.find_last_of("/#");
  const std::string folder = slash == std::string::npos ? "" : input.name.substr(0, slash + 1);
  std::vector<double> times;
  if (input.sibling && input.frame_s <= 0) {
    if (const auto text = input.sibling(folder + "liTimeStamp.binary")) {
      if (text->size() != frames * kRow) {
        Fail(folder + "liTimeStamp.binary", text->size(), fmt::format("{} rows of five", frames));
      }
      const auto first = ValueAt<int64_t>(*text, kRow - 8);
      for (size_t f = 0; f < frames; ++f) {
        times.push_back(1e-3 *
                        static_cast<double>(ValueAt<int64_t>(*text, (f + 1) * kRow - 8) - first));
      }
      return times;
    }
  }
  for (size_t f = 0; f < frames; ++f) {
    times.push_back(static_cast<double>(f) * input.FrameTime_s(1.0 / 30.0));
  }
  return times;
}

SkeletonSequence ReadStreamSaver(SkeletonInput& input) {
  const std::string bytes = ReadAll(input);
  if (bytes.empty() || bytes.size() % kSaverFrameBytes != 0) {
    Fail(input.name, bytes.size(),
         fmt::format("whole frames of {} bytes, found a part of one", kSaverFrameBytes));
  }
  const size_t frames = bytes.size() / kSaverFrameBytes;
  const auto times_s = SaverTimes_s(input, frames);
  SkeletonSequence sequence{input.name, {}};
  for (size_t f = 0; f < frames; ++f) {
    SkeletonFrame frame;
    frame.frame = static_cast<int64_t>(f);
    frame.time_s = times_s[f];
    for (size_t b = 0; b < kSaverBodies; ++b) {
      BodyRecord body;
      body.id = static_cast<int>(b) + 1;
      bool any = false;
      for (size_t j = 0; j < kJointCount; ++j) {
        const size_t offset = f * kSaverFrameBytes + 16 * (b * kJointCount + j);
        std::array<float, 4> v{};
        std::memcpy(v.data(), bytes.data() + offset, sizeof(v));
        if (!std::isfinite(v[0]) || !std::isfinite(v[1]) || !std::isfinite(v[2]) ||
            (v[3] != 0 && v[3] != 1 && v[3] != 2)) {
          Fail(input.name, offset, "three finite floats and a state 0, 1 or 2");
        }
        any = any || v[3] != 0;
        PutJoint(body, static_cast<Joint>(j), {v[0], v[1], v[2]},
                 static_cast<TrackingState>(static_cast<int>(v[3])));
      }
      if (any) frame.bodies.push_back(body);
    }
    sequence.frames.push_back(std::move(frame));
  }
  return sequence;
}

// --- C3D (c3d.org): points of the 3D data section, little-endian ("Intel") files, integers or
// floats. No Debian package reads C3D, hence these pages. Labels that name joints are taken as they
// are; else Plug-in Gait markers give joint centres. Laboratories have z up.

constexpr size_t kBlock = 512;

struct C3d {
  size_t points = 0;
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
    Fail(name, bytes.size(), fmt::format("{} up to byte {}", what, offset + count));
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
  if (word(5) < word(4)) Fail(name, 8, "a last frame after the first");
  c3d.frames = static_cast<size_t>(word(5)) - word(4) + 1;
  const auto scale = ValueAt<float>(bytes, 12);
  const auto rate = ValueAt<float>(bytes, 20);
  if (!std::isfinite(scale) || scale == 0) Fail(name, 12, "a scale factor");
  if (!std::isfinite(rate) || rate <= 0) Fail(name, 20, "a frame rate");
  c3d.floats = scale < 0;
  c3d.scale = c3d.floats ? 1.0 : static_cast<double>(scale);
  c3d.rate_Hz = static_cast<double>(rate);
  if (word(9) < 2) Fail(name, 16, "the block where the data begins");
  c3d.data = (static_cast<size_t>(word(9)) - 1) * kBlock;
  if (c3d.points == 0) Fail(name, 2, "at least one point");
  c3d.words_per_frame = 4 * c3d.points + analog;
  return c3d;
}

// A parameter of the POINT group: its bytes and how long each of its texts is.
struct Parameter {
  std::string_view data;
  size_t length = 0;
};

// Walks the parameter section: records of name length, group id, name, offset to the next, then for
// parameters (positive ids) element size, dimensions and data.
std::map<std::string, Parameter> PointParameters(const std::string& name, std::string_view bytes) {
  const size_t begin = (static_cast<size_t>(static_cast<uint8_t>(bytes[0])) - 1) * kBlock;
  NeedBytes(name, bytes, begin, 4, "the parameter section");
  constexpr uint8_t kIntel = 84;
  if (static_cast<uint8_t>(bytes[begin + 3]) != kIntel) {
    Fail(name, begin + 3, "an Intel file (processor type 84); DEC and MIPS files are not read");
  }
  std::map<std::pair<int, std::string>, Parameter> parameters;
  int point_group = 1;
  for (size_t at = begin + 4;;) {
    NeedBytes(name, bytes, at, 2, "a parameter");
    const auto name_length =
        static_cast<size_t>(std::abs(static_cast<int>(static_cast<int8_t>(bytes[at]))));
    const int id = static_cast<int8_t>(bytes[at + 1]);
    if (name_length == 0 || id == 0) break;
    NeedBytes(name, bytes, at, 2 + name_length + 2, "a parameter's name");
    std::string key(bytes.substr(at + 2, name_length));
    const size_t next_at = at + 2 + name_length;
    const auto next = ValueAt<uint16_t>(bytes, next_at);
    if (id < 0 && key == "POINT") point_group = -id;
    if (id > 0) {
      NeedBytes(name, bytes, next_at + 2, 2, "a parameter's type");
      const auto size =
          static_cast<size_t>(std::abs(static_cast<int>(static_cast<int8_t>(bytes[next_at + 2]))));
      const size_t dimensions = static_cast<uint8_t>(bytes[next_at + 3]);
      NeedBytes(name, bytes, next_at + 4, dimensions, "a parameter's dimensions");
      size_t count = size;
      for (size_t d = 0; d < dimensions; ++d) {
        count *= static_cast<uint8_t>(bytes[next_at + 4 + d]);
        if (count > bytes.size()) Fail(name, next_at + 4 + d, "dimensions that fit the file");
      }
      NeedBytes(name, bytes, next_at + 4 + dimensions, count, "a parameter's data");
      parameters[{id, key}] = {
          bytes.substr(next_at + 4 + dimensions, count),
          dimensions > 0 ? static_cast<uint8_t>(bytes[next_at + 4]) : size_t{1}};
    }
    if (next == 0) break;
    at = next_at + next;
  }
  std::map<std::string, Parameter> of_points;
  for (const auto& [key, parameter] : parameters) {
    if (key.first == point_group) of_points[key.second] = parameter;
  }
  return of_points;
}

void ReadC3dLabels(const std::string& name, std::string_view bytes, C3d& c3d) {
  const auto parameters = PointParameters(name, bytes);
  const auto labels = parameters.find("LABELS");
  if (labels == parameters.end() || labels->second.length == 0) {
    Fail(name, kBlock, "the parameter POINT:LABELS");
  }
  const auto [data, length] = labels->second;
  for (size_t at = 0; at + length <= data.size(); at += length) {
    std::string label(Trimmed(data.substr(at, length)));
    // "Subject:LASI": the subject's name is no part of the marker's.
    c3d.labels.push_back(
        label.substr(label.find(':') == std::string::npos ? 0 : label.find(':') + 1));
  }
  if (const auto units = parameters.find("UNITS"); units != parameters.end()) {
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
  const std::string bytes = ReadAll(input);
  C3d c3d = ReadC3dHeader(input.name, bytes);
  ReadC3dLabels(input.name, bytes, c3d);
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
      if (!at_m.allFinite()) Fail(input.name, at, "finite coordinates");
      if (!at_m.isZero(0.0)) points[c3d.labels[p]] = at_m;
    }
    const double step_s = input.FrameTime_s(1.0 / c3d.rate_Hz);
    sequence.frames.push_back(OneBodyFrame(f, static_cast<double>(f) * step_s, BodyIn(points)));
  }
  return sequence;
}

constexpr SkeletonFormat kFormats[] = {
    {"c3d", IsC3d, ReadC3d},
    {"kinect-stream-saver", IsStreamSaver, ReadStreamSaver},
};

}  // namespace

std::span<const SkeletonFormat> BinaryFormats() { return kFormats; }

}  // namespace ossa::recon
