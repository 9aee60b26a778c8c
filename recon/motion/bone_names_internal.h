#pragma once
#include <array>
#include <optional>
#include <vector>

#include "recon/motion/bone_mapping_internal.h"
#include "recon/motion/source_motion_internal.h"

namespace ossa::recon {

/// The source's joints of one side; -1 where it has none.
struct SideBones {
  int collar = -1, arm = -1, fore_arm = -1, hand = -1;
  int up_leg = -1, leg = -1, foot = -1, toe = -1;
  int palm = -1;  // where a mapping has the SDK's Hand
};

/// Which joint of a source moves which part of the body.
struct SourceBones {
  int hips = -1;
  std::vector<int> spine;  // above the hips, lowest first; the last one carries collars and neck
  std::vector<int> neck;   // above the spine, lowest first; the last one turns the head
  int head = -1;           // of these, the one that is called so
  std::array<SideBones, 2> side;     // left, right
  std::optional<size_t> rest_frame;  // the frame that shows the rest pose; none: the zero pose
};

/// Whether any line of the mapping names a joint of the motion.
bool NamesAny(const BoneMapping& mapping, const SourceMotion& motion);

/// Finds the joints by the mapping where it names any of them, else by the conversions known: CMU
/// MotionBuilder (as also Mixamo), CMU "Daz-friendly", Acclaim of CMU and HDM05, BioVision / SMPL
/// names, else by the words that studios have for the parts (bone_parts_internal.h). Case,
/// '_' and a "name:" prefix do not matter. Throws InputError when none fits, or for a line of the
/// mapping that names no joint of the motion.
SourceBones FindBones(const SourceMotion& motion, const BoneMapping* mapping);

}  // namespace ossa::recon
