// Azure Kinect's offline_processor: one JSON object with joint_names and frames; millimetres in the
// depth camera's axes (x right, y down, z forward).
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "depth/base/error.h"
#include "depth/base/json_nesting.h"
#include "recon/files/joint_names_internal.h"
#include "recon/files/skeleton_formats_internal.h"

namespace ossa::recon {
namespace {

// Constants: bounds against damaged files, by hand.

using Json = nlohmann::json;

bool IsAzure(const SkeletonSample& sample) {
  return !sample.lines.empty() && sample.lines[0].starts_with('{') &&
         (sample.head.find("\"bone_list\"") != std::string_view::npos ||
          sample.head.find("\"k4abt_sdk_version\"") != std::string_view::npos ||
          sample.head.find("\"joint_positions\"") != std::string_view::npos);
}

[[noreturn]] void Fail(const SkeletonInput& input, const std::string& where,
                       const std::string& expected) {
  throw InputError(fmt::format("{}: {}: expected {}", input.name, where, expected));
}

const Json& Need(const SkeletonInput& input, const Json& object, const char* key,
                 const std::string& where) {
  if (!object.is_object() || !object.contains(key)) {
    Fail(input, where, fmt::format("\"{}\"", key));
  }
  return object[key];
}

std::string ReadAll(SkeletonInput& input) {
  constexpr size_t kMostBytes = size_t{1} << 29;
  std::string text;
  std::array<char, 1 << 16> block{};
  JsonNesting nesting;
  while (input.stream.read(block.data(), block.size()) || input.stream.gcount() > 0) {
    const std::string_view part(block.data(), static_cast<size_t>(input.stream.gcount()));
    if (nesting.IsTooDeep(part)) Fail(input, "JSON", "nesting of at most 32");
    text.append(part);
    if (text.size() > kMostBytes) Fail(input, "JSON", "at most 512 MiB");
  }
  return text;
}

Json Parsed(SkeletonInput& input) {
  const std::string text = ReadAll(input);
  try {
    return Json::parse(text);
  } catch (const Json::exception& error) {
    // The parser's message names the byte; only its first line is reported.
    const std::string reason = error.what();
    const size_t at = reason.find("line ");
    const size_t end = reason.find(':', at == std::string::npos ? 0 : at);
    Fail(input, at == std::string::npos ? "JSON" : reason.substr(at, end - at), "whole JSON");
  }
}

Eigen::Vector3d ParsePosition(const SkeletonInput& input, const Json& json,
                              const std::string& where) {
  constexpr double kMetresPerMillimetre = 1e-3;
  if (!json.is_array() || json.size() != 3) Fail(input, where, "three numbers");
  Eigen::Vector3d position;
  for (size_t axis = 0; axis < 3; ++axis) {
    if (!json[axis].is_number() || !std::isfinite(json[axis].get<double>())) {
      Fail(input, where, "three finite numbers");
    }
    position[static_cast<int>(axis)] = json[axis].get<double>();
  }
  return kMetresPerMillimetre * Eigen::Vector3d(-position.x(), -position.y(), position.z());
}

BodyRecord ParseBody(const SkeletonInput& input, const Json& json,
                     const std::vector<std::optional<Joint>>& joints, const std::string& where) {
  BodyRecord body;
  const Json& id = Need(input, json, "body_id", where);
  if (!id.is_number_integer()) Fail(input, where, "a whole number as body_id");
  body.id = static_cast<int>(id.get<int64_t>() & 0x7FFFFFFF);
  const Json& positions = Need(input, json, "joint_positions", where);
  if (!positions.is_array() || positions.size() != joints.size()) {
    Fail(input, where, fmt::format("{} joint_positions", joints.size()));
  }
  for (size_t j = 0; j < joints.size(); ++j) {
    if (joints[j]) PutJoint(body, *joints[j], ParsePosition(input, positions[j], where));
  }
  return body;
}

SkeletonSequence ReadAzure(SkeletonInput& input) {
  const Json json = Parsed(input);
  std::vector<std::optional<Joint>> joints;
  const Json& names = Need(input, json, "joint_names", "the recording");
  if (!names.is_array()) Fail(input, "joint_names", "a list of names");
  for (const Json& name : names) {
    if (!name.is_string()) Fail(input, "joint_names", "a list of names");
    joints.push_back(FindJointByName(name.get<std::string>()));
  }
  const Json& frames = Need(input, json, "frames", "the recording");
  if (!frames.is_array()) Fail(input, "frames", "a list");
  SkeletonSequence sequence{input.name, {}};
  std::optional<double> first;
  bool has_orientations = false;
  for (size_t f = 0; f < frames.size(); ++f) {
    const std::string where = fmt::format("frame {}", f);
    const Json& time = Need(input, frames[f], "timestamp_usec", where);
    if (!time.is_number()) Fail(input, where, "a number as timestamp_usec");
    constexpr double kSecondsPerMicrosecond = 1e-6;
    const double time_s = time.get<double>() * kSecondsPerMicrosecond;
    if (!first) first = time_s;
    SkeletonFrame frame;
    frame.frame = static_cast<int64_t>(f);
    frame.time_s = time_s - *first;
    const Json& bodies = Need(input, frames[f], "bodies", where);
    if (!bodies.is_array()) Fail(input, where, "a list of bodies");
    for (const Json& body : bodies) {
      frame.bodies.push_back(ParseBody(input, body, joints, where));
      has_orientations = has_orientations || !body.value("joint_orientations", Json()).empty();
    }
    sequence.frames.push_back(std::move(frame));
  }
  RequireFrames(sequence);
  if (has_orientations) {
    sequence.warnings.push_back(
        input.name +
        ": joint_orientations are not read: their axes are Azure Kinect's, not the Kinect SDK 1's");
  }
  return sequence;
}

constexpr SkeletonFormat kAzureFormats[] = {{"azure-kinect", IsAzure, ReadAzure}};

}  // namespace

std::span<const SkeletonFormat> AzureFormats() { return kAzureFormats; }

}  // namespace ossa::recon
