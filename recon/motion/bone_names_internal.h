#pragma once
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "recon/motion/source_motion_internal.h"

namespace ossa::recon {

/// The source's joints of one side; -1 where it has none.
struct SideBones {
  int collar = -1, arm = -1, fore_arm = -1, hand = -1;
  int up_leg = -1, leg = -1, foot = -1, toe = -1;
};

/// Which joint of a source moves which part of the body.
struct SourceBones {
  int hips = -1;
  std::vector<int> spine;  // above the hips, lowest first; the last one carries collars and neck
  std::vector<int> neck;   // above the spine, lowest first; the last one is the head
  std::array<SideBones, 2> side;     // left, right
  std::optional<size_t> rest_frame;  // the frame that shows the rest pose; none: the zero pose
};

/// Joint names of a conversion we do not know, read from a text file: lines `RigBone = joint name`,
/// '#' begins a comment. RigBone is one of Hips, LowerBack, Spine, Spine1, Neck, Neck1, Head and,
/// with Left or Right before it, Shoulder, Arm, ForeArm, Hand, UpLeg, Leg, Foot, ToeBase; a line
/// `rest = frame N` says that frame N (0 the first) shows the T-pose or A-pose when zero angles
/// do not.
struct BoneMapping {
  std::vector<std::pair<std::string, std::string>> names;  // rig bone, joint
  std::optional<size_t> rest_frame;
};
BoneMapping ReadBoneMapping(const std::filesystem::path& path);

/// Finds the joints by the mapping when given, else by the conversions known: CMU MotionBuilder (as
/// also Mixamo), CMU "Daz-friendly", Acclaim of CMU and HDM05, BioVision / SMPL names. Case,
/// '_' and a "name:" prefix do not matter. Throws InputError when none fits.
SourceBones FindBones(const SourceMotion& motion, const std::optional<BoneMapping>& mapping);

}  // namespace ossa::recon
