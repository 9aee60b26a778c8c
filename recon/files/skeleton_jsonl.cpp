#include "recon/files/skeleton_jsonl.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <span>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "depth/base/error.h"
#include "depth/base/json_nesting.h"
#include "recon/files/skeleton_formats_internal.h"
#include "recon/files/text_lines_internal.h"
#include "recon/motion/fixed_point_internal.h"

namespace ossa::recon {
namespace {

using Json = nlohmann::json;

void AppendNumber(std::string& text, double value, int digits) {
  if (!std::isfinite(value)) throw std::invalid_argument("skeleton JSONL: a number is not finite");
  AppendFixed(text, value, digits);
}

template <typename Vector>
void AppendVector(std::string& text, const Vector& values, int digits) {
  char separator = '[';
  for (const double value : values) {
    text.push_back(separator);
    AppendNumber(text, value, digits);
    separator = ',';
  }
  text.push_back(']');
}

// Constants: output digits and input limits, by hand.

constexpr int kLengthDigits = 7;
constexpr int kOtherDigits = 6;

void AppendJoint(std::string& text, const JointRecord& joint) {
  text += "{\"p\":";
  AppendVector(text, joint.position_m, kLengthDigits);
  if (joint.state) {
    fmt::format_to(std::back_inserter(text), ",\"state\":\"{}\"",
                   kStateNames[static_cast<size_t>(*joint.state)]);
  }
  if (joint.confidence) {
    text += ",\"confidence\":";
    AppendNumber(text, *joint.confidence, kOtherDigits);
  }
  if (joint.reliability) {
    text += ",\"reliability\":";
    AppendNumber(text, *joint.reliability, kOtherDigits);
  }
  if (joint.orientation) {
    const Eigen::Quaterniond& q = *joint.orientation;
    text += ",\"q\":";
    AppendVector(text, std::array{q.w(), q.x(), q.y(), q.z()}, kLengthDigits);
  }
  if (joint.visible) text += *joint.visible ? ",\"visible\":true" : ",\"visible\":false";
  if (joint.sigma_m) {
    text += ",\"sigma\":";
    AppendVector(text, *joint.sigma_m, kLengthDigits);
  }
  text.push_back('}');
}

void AppendBody(std::string& text, const BodyRecord& body) {
  fmt::format_to(std::back_inserter(text), "{{\"id\":{},\"joints\":{{", body.id);
  bool first = true;
  for (size_t j = 0; j < kJointCount; ++j) {
    if (!body.joints[j]) continue;
    if (!first) text.push_back(',');
    first = false;
    fmt::format_to(std::back_inserter(text), "\"{}\":", kJointNames[j]);
    AppendJoint(text, *body.joints[j]);
  }
  text.push_back('}');
  if (body.bones_m) {
    text += ",\"bones\":";
    AppendVector(text, std::span(*body.bones_m).subspan(1), kLengthDigits);
  }
  text.push_back('}');
}

// Names are arbitrary text and are written as JSON strings.
void AppendObject(std::string& text, const ObjectRecord& object) {
  text += "{\"name\":" + Json(object.name).dump(-1, ' ', true, Json::error_handler_t::replace) +
          ",\"p\":";
  AppendVector(text, object.position_m, kLengthDigits);
  text += ",\"q\":";
  const Eigen::Quaterniond& q = object.orientation;
  AppendVector(text, std::array{q.w(), q.x(), q.y(), q.z()}, kLengthDigits);
  text.push_back('}');
}

}  // namespace

std::string SkeletonJsonLine(const SkeletonFrame& frame) {
  std::string text = fmt::format("{{\"frame\":{},\"time_s\":", frame.frame);
  AppendNumber(text, frame.time_s, kLengthDigits);
  if (frame.floor) {
    text += ",\"floor\":";
    AppendVector(text, *frame.floor, kLengthDigits);
  }
  text += ",\"bodies\":[";
  for (size_t b = 0; b < frame.bodies.size(); ++b) {
    if (b > 0) text.push_back(',');
    AppendBody(text, frame.bodies[b]);
  }
  text.push_back(']');
  for (size_t k = 0; k < frame.objects.size(); ++k) {
    text += k == 0 ? ",\"objects\":[" : ",";
    AppendObject(text, frame.objects[k]);
  }
  text += frame.objects.empty() ? "}" : "]}";
  return text;
}

void SkeletonJsonlWriter::Write(const SkeletonFrame& frame) {
  stream_ << SkeletonJsonLine(frame) << '\n';
}

namespace {

// The first duplicate key of any object in the text. The parser silently keeps the last value.
std::optional<std::string> FindRepeatedKey(std::string_view text) {
  std::vector<std::set<std::string>> keys;  // keys of each open object
  std::optional<std::string> repeated;
  const auto take = [&](int, Json::parse_event_t event, Json& parsed) {
    if (event == Json::parse_event_t::object_start) keys.emplace_back();
    if (event == Json::parse_event_t::object_end) keys.pop_back();
    if (event != Json::parse_event_t::key) return true;
    const auto& key = parsed.get_ref<const std::string&>();
    if (!keys.back().insert(key).second && !repeated) repeated = key;
    return true;
  };
  [[maybe_unused]] const Json json = Json::parse(text, take, false);
  return repeated;
}

// Counts occurrences in the text, including duplicates that the parser dropped: cheaper than
// checking every key of a line of thousands.
size_t CountPlaces(std::string_view text) {
  constexpr std::string_view kPlace = "\"p\"";
  size_t count = 0;
  for (size_t at = text.find(kPlace); at != text.npos; at = text.find(kPlace, at + 1)) ++count;
  return count;
}

size_t CountPlaces(const SkeletonFrame& frame, const Json& line) {
  const auto objects = line.find("objects");
  size_t count = objects == line.end() ? 0 : objects->size();
  for (const BodyRecord& body : frame.bodies) {
    for (const auto& joint : body.joints) count += joint ? 1 : 0;
  }
  return count;
}

}  // namespace

// Parses one line of a file; every error names the line and the key.
class SkeletonJsonlReader::Lines {
 public:
  Lines(std::istream& stream, std::string source) : lines_(stream, std::move(source)) {}

  bool Next(SkeletonFrame& frame) {
    if (!lines_.NextFilled()) return false;
    if (JsonNesting().IsTooDeep(lines_.line()))
      lines_.Fail("JSON nested at most 32 deep", lines_.line());
    // The parser does not throw here (third argument), so its own messages do not reach the user.
    const Json json = Json::parse(lines_.line(), nullptr, false);
    if (json.is_discarded()) FailWhereJsonStops();
    if (!json.is_object()) lines_.Fail("a JSON object", lines_.line());
    frame = ParseFrame(json);
    if (CountPlaces(lines_.line()) != CountPlaces(frame, json)) FailWhereAKeyRepeats();
    return true;
  }

  size_t number() const { return lines_.number(); }
  const std::string& source() const { return lines_.source(); }

 private:
  // Reports the position where the line stops being JSON: lines may be long.
  [[noreturn]] void FailWhereJsonStops() const {
    constexpr std::string_view kExpected = "one whole JSON object";
    const std::string_view line = lines_.line();
    try {
      [[maybe_unused]] const Json whole = Json::parse(line);
    } catch (const Json::parse_error& fault) {
      const std::string found = fault.byte > line.size() || fault.byte == 0
                                    ? "the end of the line"
                                    : Quoted(line.substr(fault.byte - 1));
      throw InputError(fmt::format("{}: line {}: expected {}, found {} at byte {}", lines_.source(),
                                   lines_.number(), kExpected, found, fault.byte));
    } catch (const Json::out_of_range&) {
      lines_.Fail("numbers of at most 1.8e308", line);
    }
    lines_.Fail(kExpected, line);
  }

  void FailWhereAKeyRepeats() const {
    const auto repeated = FindRepeatedKey(lines_.line());
    if (repeated) lines_.Fail("each key of an object once", *repeated);
  }

  [[noreturn]] void Fail(const std::string& where, std::string_view expected,
                         const Json& found) const {
    lines_.Fail(fmt::format("{} in {}", expected, where), found.dump(-1, ' ', true, kReplace));
  }

  const Json& Need(const Json& object, const char* key, const std::string& where) const {
    const auto found = object.find(key);
    if (found == object.end()) {
      lines_.Fail(fmt::format("\"{}\" in {}", key, where), object.dump(-1, ' ', true, kReplace));
    }
    return *found;
  }

  double Number(const Json& json, const std::string& where) const {
    if (!json.is_number() || !std::isfinite(json.get<double>())) {
      Fail(where, "a finite number", json);
    }
    return json.get<double>();
  }

  int64_t Integer(const Json& json, const std::string& where) const {
    const bool is_too_large =
        json.is_number_unsigned() && json.get<uint64_t>() > static_cast<uint64_t>(INT64_MAX);
    if (!json.is_number_integer() || is_too_large) Fail(where, "a whole number", json);
    return json.get<int64_t>();
  }

  template <size_t kCount>
  std::array<double, kCount> Numbers(const Json& json, const std::string& where) const {
    if (!json.is_array() || json.size() != kCount) {
      Fail(where, fmt::format("{} numbers", kCount), json);
    }
    std::array<double, kCount> values{};
    for (size_t i = 0; i < kCount; ++i) values[i] = Number(json[i], where);
    return values;
  }

  double Share(const Json& json, const std::string& where) const {
    const double value = Number(json, where);
    if (value < 0.0 || value > 1.0) Fail(where, "a number from 0 to 1", json);
    return value;
  }

  SkeletonFrame ParseFrame(const Json& json) {
    SkeletonFrame frame;
    frame.frame = Integer(Need(json, "frame", "the frame"), "\"frame\"");
    frame.time_s = Number(Need(json, "time_s", "the frame"), "\"time_s\"");
    times_.Take(lines_, frame.time_s);
    if (const auto floor = json.find("floor"); floor != json.end() && !floor->is_null()) {
      frame.floor = ParseFloor(*floor);
    }
    const Json& bodies = Need(json, "bodies", "the frame");
    if (!bodies.is_array()) Fail("\"bodies\"", "a list", bodies);
    std::set<int> ids;
    for (const Json& body : bodies) {
      frame.bodies.push_back(ParseBody(body));
      if (!ids.insert(frame.bodies.back().id).second) Fail("\"id\"", "an id used once", body);
    }
    return frame;
  }

  // The plane scaled to a unit normal. SDKs write 0 0 0 0 for a floor that they do not see.
  std::optional<Eigen::Vector4d> ParseFloor(const Json& json) const {
    constexpr double kNone = 1e-6, kFewDigits = 1e-3;  // of a length, no unit; by hand
    const Eigen::Vector4d plane(Numbers<4>(json, "\"floor\"").data());
    const double length = plane.head<3>().stableNorm();
    if (length < kNone) return std::nullopt;
    return std::abs(length - 1.0) < kFewDigits ? plane : Eigen::Vector4d(plane / length);
  }

  BodyRecord ParseBody(const Json& json) const {
    if (!json.is_object()) Fail("\"bodies\"", "objects", json);
    BodyRecord body;
    const int64_t id = Integer(Need(json, "id", "the body"), "\"id\"");
    if (id < INT32_MIN || id > INT32_MAX) Fail("\"id\"", "an id of at most 31 bits", json);
    body.id = static_cast<int>(id);
    const Json& joints = Need(json, "joints", "the body");
    if (!joints.is_object()) Fail("\"joints\"", "an object", joints);
    for (const auto& [name, joint] : joints.items()) {
      const auto known = JointFromName(name);
      if (!known) lines_.Fail("one of the 20 SDK joint names in \"joints\"", name);
      body.joints[*known] = ParseJoint(joint, name);
    }
    if (const auto bones = json.find("bones"); bones != json.end())
      body.bones_m = ParseBones(*bones);
    return body;
  }

  // Lengths of the bones that end in joints 1 to 19, in their order; no bone ends in joint 0.
  BoneLengths ParseBones(const Json& json) const {
    constexpr double kMost_m = 2.0;
    const auto lengths_m = Numbers<kJointCount - 1>(json, "\"bones\"");
    BoneLengths bones_m{};
    for (size_t i = 0; i < lengths_m.size(); ++i) {
      if (!(lengths_m[i] > 0.0 && lengths_m[i] < kMost_m)) {
        Fail("\"bones\"", "lengths of 0 to 2 m", json);
      }
      bones_m[i + 1] = lengths_m[i];
    }
    return bones_m;
  }

  JointRecord ParseJoint(const Json& json, const std::string& name) const {
    if (!json.is_object()) Fail(name, "an object", json);
    JointRecord joint;
    joint.position_m = Eigen::Vector3d(Numbers<3>(Need(json, "p", name), name + ".p").data());
    if (const auto state = json.find("state"); state != json.end()) {
      joint.state = ParseState(*state, name + ".state");
    }
    if (const auto value = json.find("confidence"); value != json.end()) {
      joint.confidence = Share(*value, name + ".confidence");
    }
    if (const auto value = json.find("reliability"); value != json.end()) {
      joint.reliability = Share(*value, name + ".reliability");
    }
    if (const auto value = json.find("q"); value != json.end()) {
      joint.orientation = ParseOrientation(*value, name + ".q");
    }
    if (const auto value = json.find("visible"); value != json.end()) {
      if (!value->is_boolean()) Fail(name + ".visible", "true or false", *value);
      joint.visible = value->get<bool>();
    }
    if (const auto value = json.find("sigma"); value != json.end()) {
      joint.sigma_m = ParseSigma(*value, name + ".sigma");
    }
    return joint;
  }

  Eigen::Vector3d ParseSigma(const Json& json, const std::string& where) const {
    constexpr double kMost_m = 1e6;  // by hand: no sensor sees as far, and its square is a number
    const Eigen::Vector3d sigma_m(Numbers<3>(json, where).data());
    if (!(sigma_m.minCoeff() >= 0.0 && sigma_m.maxCoeff() <= kMost_m)) {
      Fail(where, "lengths of 0 m to 1000 km", json);
    }
    return sigma_m;
  }

  TrackingState ParseState(const Json& json, const std::string& where) const {
    const auto state =
        json.is_string() ? FindState(json.get_ref<const std::string&>()) : std::nullopt;
    if (state) return *state;
    Fail(where, "tracked, inferred or not_tracked", json);
  }

  Eigen::Quaterniond ParseOrientation(const Json& json, const std::string& where) const {
    const auto q = Numbers<4>(json, where);
    const Eigen::Quaterniond rotation(q[0], q[1], q[2], q[3]);
    // Quaternions written with few digits deviate from unit length by no more than this.
    constexpr double kTolerance = 1e-2;  // of the length, no unit
    if (std::abs(rotation.norm() - 1.0) > kTolerance) Fail(where, "a unit quaternion", json);
    return rotation.normalized();
  }

  static constexpr auto kReplace = Json::error_handler_t::replace;
  TextLines lines_;
  RowTimes times_;
};

SkeletonJsonlReader::SkeletonJsonlReader(std::istream& stream, std::string source)
    : lines_(std::make_unique<Lines>(stream, std::move(source))) {}
SkeletonJsonlReader::~SkeletonJsonlReader() = default;

bool SkeletonJsonlReader::Next(SkeletonFrame& frame) { return lines_->Next(frame); }

SkeletonSequence ReadSkeletonJsonl(std::istream& stream, const std::string& source) {
  SkeletonSequence sequence{source, {}};
  SkeletonJsonlReader reader(stream, source);
  SkeletonFrame frame;
  while (reader.Next(frame)) sequence.frames.push_back(std::move(frame));
  if (sequence.frames.empty()) {
    throw InputError(source + ": line 1: expected a skeleton frame, found the end of the file");
  }
  return sequence;
}

}  // namespace ossa::recon
