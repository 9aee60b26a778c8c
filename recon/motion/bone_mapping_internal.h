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
  std::string bone;   // a bone of the rig, or a joint of the SDK
  std::string joint;  // its name in the motion file
  int line = 0;
};

/// Joint or point names of a motion file that ossa does not know, from a text file: lines `BONE =
/// name`, '#' starts a comment. BONE is a rig bone (Hips, LowerBack, Spine, Spine1, Neck, Neck1,
/// Head and, prefixed by Left or Right, Shoulder, Arm, ForeArm, Hand, UpLeg, Leg, Foot, ToeBase),
/// which stands for the joint where it starts, or one of the SDK's 20 joints. A line `rest = frame
/// N` says that frame N (from 0) shows the T-pose or A-pose.
struct BoneMapping {
  std::string file;  // for messages
  std::vector<MappingLine> lines;
  std::optional<size_t> rest_frame;
  int rest_line = 0;
};

/// Throws InputError that names file and line. `file` stands for the text in messages.
BoneMapping ParseBoneMapping(std::string text, const std::string& file);
BoneMapping ReadBoneMapping(const std::filesystem::path& path);

/// The SDK joint where a rig bone starts ("LeftArm": ShoulderLeft), or the joint of that name; none
/// for bones that start at no SDK joint, such as collars.
std::optional<Joint> FindJointOfBone(std::string_view bone);

/// The rig bone that starts at an SDK joint ("ShoulderLeft": "LeftArm"); `bone` itself if it is not
/// an SDK joint; "" for a hand, which is inside a bone.
std::string RigBoneAt(const std::string& bone);

/// Throws InputError "MAPPING: line N: expected EXPECTED, found NAME".
[[noreturn]] void FailInMapping(const BoneMapping& mapping, const MappingLine& line,
                                const std::string& expected);

}  // namespace ossa::recon
