#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "recon/skeleton.h"

namespace ossa::recon {

/// A line `bone = joint` of a mapping file.
struct MappingLine {
  std::string bone;   // of the rig, or a joint of the SDK
  std::string joint;  // as a motion file calls it
  int line = 0;
};

/// Names of a motion file's joints or points that are none of those known, read from a text file:
/// lines `BONE = name`, '#' begins a comment. BONE is a bone of the rig (Hips, LowerBack, Spine,
/// Spine1, Neck, Neck1, Head and, with Left or Right before it, Shoulder, Arm, ForeArm, Hand,
/// UpLeg, Leg, Foot, ToeBase), by which the joint is meant where it begins, or one of the SDK's 20
/// joints; a line `rest = frame N` says that frame N (0 the first) shows the T-pose or A-pose.
struct BoneMapping {
  std::string file;  // for messages
  std::vector<MappingLine> lines;
  std::optional<size_t> rest_frame;
  int rest_line = 0;
};

/// Throw InputError that names file and line. `file` stands for the text in messages.
BoneMapping ParseBoneMapping(std::string text, const std::string& file);
BoneMapping ReadBoneMapping(const std::filesystem::path& path);

/// The SDK's joint where a bone of the rig begins ("LeftArm": ShoulderLeft), or of that name; none
/// for bones that begin at none, as the collars.
std::optional<Joint> FindJointOfBone(std::string_view bone);

/// The rig's bone that begins at a joint of the SDK ("ShoulderLeft": "LeftArm"); `bone` itself when
/// it is no such joint; "" for a hand, which is inside a bone.
std::string RigBoneAt(const std::string& bone);

/// Throws InputError "MAPPING: line N: expected EXPECTED, found NAME".
[[noreturn]] void FailInMapping(const BoneMapping& mapping, const MappingLine& line,
                                const std::string& expected);

}  // namespace ossa::recon
