#include "recon/motion/bone_mapping_internal.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "depth/base/error.h"
#include "recon/body/rig.h"
#include "recon/motion/text_scanner_internal.h"

namespace ossa::recon {
namespace {

/// The SDK's joints and the rig bone that starts at each; of several (the trunk) the first is the
/// default.
constexpr std::pair<std::string_view, std::string_view> kJointBones[] = {
    {"HipCenter", "Hips"},         {"Spine", "Spine"},
    {"ShoulderCenter", "Neck"},    {"Head", "Head"},
    {"ShoulderLeft", "LeftArm"},   {"ElbowLeft", "LeftForeArm"},
    {"WristLeft", "LeftHand"},     {"HandLeft", ""},
    {"ShoulderRight", "RightArm"}, {"ElbowRight", "RightForeArm"},
    {"WristRight", "RightHand"},   {"HandRight", ""},
    {"HipLeft", "LeftUpLeg"},      {"KneeLeft", "LeftLeg"},
    {"AnkleLeft", "LeftFoot"},     {"FootLeft", "LeftToeBase"},
    {"HipRight", "RightUpLeg"},    {"KneeRight", "RightLeg"},
    {"AnkleRight", "RightFoot"},   {"FootRight", "RightToeBase"}};

/// Splits a line at its '=' and drops the comment; both parts are empty for a line without '='.
std::pair<std::string, std::string> TakeApart(const TextScanner& scan,
                                              const std::vector<std::string_view>& words) {
  std::string text;
  for (const std::string_view word : words) {
    if (word.starts_with('#')) break;
    if (!text.empty()) text += ' ';
    text += word;
  }
  if (text.empty()) return {};
  const size_t equals = text.find('=');
  const size_t end = text.find_last_not_of(' ', equals - 1);
  const size_t begin = text.find_first_not_of(' ', std::min(text.size(), equals + 1));
  if (equals == std::string::npos || equals == 0 || end == std::string::npos ||
      begin == std::string::npos || begin <= equals) {
    scan.Fail("BONE = joint name", text);
  }
  return {text.substr(0, end + 1), text.substr(begin)};
}

size_t ReadRestFrame(const TextScanner& scan, const std::string& value) {
  if (!value.starts_with("frame ")) scan.Fail("rest = frame N", value);
  const double frame = scan.ToNumber(std::string_view(value).substr(6), "the rest frame");
  if (frame < 0 || frame != static_cast<double>(static_cast<size_t>(frame))) {
    scan.Fail("a frame number, 0 the first", value);
  }
  return static_cast<size_t>(frame);
}

bool IsBone(const std::string& name) {
  return std::find(kRigBoneNames.begin(), kRigBoneNames.end(), name) != kRigBoneNames.end();
}

}  // namespace

BoneMapping ParseBoneMapping(std::string text, const std::string& file) {
  TextScanner scan(std::move(text), file);
  BoneMapping mapping;
  mapping.file = file;
  for (auto words = scan.ReadWordsOfLine(); !words.empty(); words = scan.ReadWordsOfLine()) {
    const auto [bone, joint] = TakeApart(scan, words);
    if (bone.empty()) continue;
    if (bone == "rest") {
      mapping.rest_frame = ReadRestFrame(scan, joint);
      mapping.rest_line = scan.line();
      continue;
    }
    if (!IsBone(bone) && !JointFromName(bone)) {
      scan.Fail("a bone of the rig such as LeftForeArm or a joint such as ElbowLeft", bone);
    }
    for (const MappingLine& other : mapping.lines) {
      if (other.bone == bone) scan.Fail("each bone once", bone);
    }
    mapping.lines.push_back({bone, joint, scan.line()});
  }
  if (mapping.lines.empty()) scan.Fail("at least one line BONE = joint name", "");
  return mapping;
}

BoneMapping ReadBoneMapping(const std::filesystem::path& path) {
  return ParseBoneMapping(ReadTextFile(path), path.string());
}

std::optional<Joint> FindJointOfBone(std::string_view bone) {
  if (const auto joint = JointFromName(bone)) return joint;
  for (const auto& [joint, of_rig] : kJointBones) {
    if (of_rig == bone) return JointFromName(joint);
  }
  return std::nullopt;
}

std::string RigBoneAt(const std::string& bone) {
  for (const auto& [joint, of_rig] : kJointBones) {
    if (joint == bone) return std::string(of_rig);
  }
  return bone;
}

void FailInMapping(const BoneMapping& mapping, const MappingLine& line,
                   const std::string& expected) {
  throw InputError(fmt::format("{}: line {}: expected {}, found '{}'", mapping.file, line.line,
                               expected, line.joint));
}

}  // namespace ossa::recon
