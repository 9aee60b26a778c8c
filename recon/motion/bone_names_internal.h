#pragma once
#include <array>
#include <optional>
#include <vector>

#include "recon/motion/bone_mapping_internal.h"
#include "recon/motion/source_motion_internal.h"

namespace ossa::recon {

/// The source's joints of one side; -1 if missing.
struct SideBones {
  int collar = -1, arm = -1, fore_arm = -1, hand = -1;
  int up_leg = -1, leg = -1, foot = -1, toe = -1;
  int palm = -1;  // if a mapping names the SDK's Hand
};

/// The joints of a source that drive the parts of the body.
struct SourceBones {
  int hips = -1;
  std::vector<int> spine;  // above the hips, lowest first; the last one carries collars and neck
  std::vector<int> neck;   // above the spine, lowest first; the last one turns the head
  int head = -1;           // the one of these that is named head
  std::array<SideBones, 2> side;     // left, right
  std::optional<size_t> rest_frame;  // index of the frame with the rest pose; none: the zero pose
};

/// Whether the mapping names any joint of the motion.
bool NamesAny(const BoneMapping& mapping, const SourceMotion& motion);

/// Finds the joints by the mapping, if it names any of them; else by known conventions: CMU
/// MotionBuilder (also Mixamo), CMU "Daz-friendly", Acclaim of CMU and HDM05, BioVision / SMPL;
/// else by common words for body parts (bone_parts_internal.h). Ignores case, '_' and a "name:"
/// prefix. Throws InputError if none fits, or for a mapping line that names no joint of the motion.
SourceBones FindBones(const SourceMotion& motion, const BoneMapping* mapping);

}  // namespace ossa::recon
