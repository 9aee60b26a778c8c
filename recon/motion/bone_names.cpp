#include <algorithm>
#include <initializer_list>
#include <map>

#include "depth/base/error.h"
#include "recon/body/rig.h"
#include "recon/motion/bone_names_internal.h"
#include "recon/motion/bone_parts_internal.h"
#include "recon/motion/text_scanner_internal.h"

namespace ossa::recon {
namespace {

using Names = std::vector<std::string_view>;

/// Joint names of one convention, simplified by SimplifyJointName; '*' stands for the side.
struct Convention {
  std::array<std::string_view, 2> sides;
  Names hips, spine, neck;
  Names collar, arm, fore_arm, hand, up_leg, leg, foot, toe;
};

const std::vector<Convention>& Conventions() {
  static const std::vector<Convention> known = {
      // CMU by B. Hahne for MotionBuilder; the rig's own names; Mixamo.
      {{"left", "right"},
       {"hips"},
       {"lowerback", "spine", "spine1", "spine2", "spine3"},
       {"neck", "neck1", "head"},
       {"*shoulder"},
       {"*arm"},
       {"*forearm"},
       {"*hand"},
       {"*upleg"},
       {"*leg"},
       {"*foot"},
       {"*toebase", "*toe"}},
      // CMU by B. Hahne, "Daz-friendly".
      {{"l", "r"},
       {"hip"},
       {"abdomen", "chest"},
       {"neck", "head"},
       {"*collar"},
       {"*shldr"},
       {"*forearm"},
       {"*hand"},
       {"*thigh"},
       {"*shin"},
       {"*foot"},
       {"*toe"}},
      // Acclaim as CMU and HDM05 publish it.
      {{"l", "r"},
       {"root"},
       {"lowerback", "upperback", "thorax"},
       {"lowerneck", "upperneck", "head"},
       {"*clavicle"},
       {"*humerus"},
       {"*radius"},
       {"*wrist", "*hand"},
       {"*femur"},
       {"*tibia"},
       {"*foot"},
       {"*toes"}},
      // BioVision's own samples, 3ds Max, SMPL.
      {{"left", "right"},
       {"hips", "pelvis", "hip"},
       {"spine", "spine1", "spine2", "spine3", "chest", "chest1", "chest2", "chest3", "chest4"},
       {"neck", "neck1", "head"},
       {"*collar"},
       {"*shoulder"},
       {"*elbow"},
       {"*wrist"},
       {"*hip"},
       {"*knee"},
       {"*ankle"},
       {"*foot", "*toe"}},
  };
  return known;
}

class Finder {
 public:
  explicit Finder(const SourceMotion& motion) {
    for (size_t j = 0; j < motion.joints.size(); ++j) {
      index_.emplace(SimplifyJointName(motion.joints[j].name), static_cast<int>(j));
    }
  }

  /// From joints with explicitly assigned names.
  explicit Finder(const std::vector<std::pair<std::string, int>>& named) {
    for (const auto& [name, joint] : named) index_.emplace(SimplifyJointName(name), joint);
  }

  int Find(std::string_view name) const {
    const auto found = index_.find(name);
    return found == index_.end() ? -1 : found->second;
  }

  int First(const Names& names, std::string_view side = "") const {
    for (const std::string_view name : names) {
      std::string wanted(name);
      if (wanted.front() == '*') wanted.replace(0, 1, side);
      if (const int joint = Find(wanted); joint >= 0) return joint;
    }
    return -1;
  }

  /// All existing joints of a chain, from the root.
  std::vector<int> Chain(const Names& names) const {
    std::vector<int> chain;
    for (const std::string_view name : names) {
      if (const int joint = Find(name); joint >= 0) chain.push_back(joint);
    }
    std::sort(chain.begin(), chain.end());
    return chain;
  }

 private:
  std::map<std::string, int, std::less<>> index_;
};

SourceBones FindByConvention(const Convention& names, const Finder& finder) {
  SourceBones bones;
  bones.hips = finder.First(names.hips);
  bones.spine = finder.Chain(names.spine);
  bones.neck = finder.Chain(names.neck);
  bones.head = finder.Find("head");
  for (size_t s = 0; s < 2; ++s) {
    const auto find = [&](const Names& of) { return finder.First(of, names.sides[s]); };
    bones.side[s] = {find(names.collar), find(names.arm), find(names.fore_arm), find(names.hand),
                     find(names.up_leg), find(names.leg), find(names.foot),     find(names.toe)};
  }
  return bones;
}

/// The first required part that is missing; "" if none is.
std::string Missing(const SourceBones& bones) {
  if (bones.hips < 0) return "Hips";
  if (bones.spine.empty()) return "Spine";
  for (size_t s = 0; s < 2; ++s) {
    const SideBones& side = bones.side[s];
    const std::string name = s == 0 ? "Left" : "Right";
    if (side.arm < 0) return name + "Arm";
    if (side.fore_arm < 0) return name + "ForeArm";
    if (side.up_leg < 0) return name + "UpLeg";
    if (side.leg < 0) return name + "Leg";
    if (side.foot < 0) return name + "Foot";
  }
  return "";
}

std::string ListJoints(const SourceMotion& motion) {
  constexpr size_t kMostListed = 60;  // by hand: what fits a line
  std::string list;
  for (size_t j = 0; j < std::min(kMostListed, motion.joints.size()); ++j) {
    list += (j == 0 ? " '" : ", '") + motion.joints[j].name + "'";
  }
  if (motion.joints.size() > kMostListed) list += ", ...";
  return "," + list;
}

int JointNamed(const SourceMotion& motion, const std::string& name) {
  const auto found = std::find_if(motion.joints.begin(), motion.joints.end(),
                                  [&](const SourceJoint& joint) { return joint.name == name; });
  return found == motion.joints.end() ? -1 : static_cast<int>(found - motion.joints.begin());
}

SourceBones FindMapped(const SourceMotion& motion, const BoneMapping& mapping) {
  std::vector<std::pair<std::string, int>> named;
  std::array<int, 2> palms = {-1, -1};
  for (const MappingLine& line : mapping.lines) {
    const int joint = JointNamed(motion, line.joint);
    if (joint < 0) FailInMapping(mapping, line, "a joint of " + motion.source);
    const std::string bone = RigBoneAt(line.bone);
    if (bone.empty()) {
      palms[line.bone == NameOf(Joint::kHandLeft) ? 0 : 1] = joint;
    } else {
      named.emplace_back(bone, joint);
    }
  }
  SourceBones bones = FindByConvention(Conventions().front(), Finder(named));
  for (size_t s = 0; s < 2; ++s) bones.side[s].palm = palms[s];
  bones.rest_frame = mapping.rest_frame;
  if (const std::string missing = Missing(bones); !missing.empty()) {
    throw InputError(mapping.file + ": expected a line for " + missing + " of " + motion.source +
                     ", found none");
  }
  if (bones.rest_frame && *bones.rest_frame >= motion.frame_count) {
    throw InputError(mapping.file + ": line " + std::to_string(mapping.rest_line) +
                     ": expected one of the " + std::to_string(motion.frame_count) + " frames of " +
                     motion.source + ", found frame " + std::to_string(*bones.rest_frame));
  }
  return bones;
}

}  // namespace

bool NamesAny(const BoneMapping& mapping, const SourceMotion& motion) {
  return std::any_of(mapping.lines.begin(), mapping.lines.end(),
                     [&](const MappingLine& line) { return JointNamed(motion, line.joint) >= 0; });
}

SourceBones FindBones(const SourceMotion& motion, const BoneMapping* mapping) {
  if (mapping != nullptr && NamesAny(*mapping, motion)) return FindMapped(motion, *mapping);
  const Finder finder(motion);
  std::string nearest;
  for (const Convention& names : Conventions()) {
    SourceBones bones = FindByConvention(names, finder);
    const std::string missing = Missing(bones);
    if (missing.empty()) return bones;
    if (bones.hips >= 0 && bones.side[0].arm >= 0) nearest = missing;
  }
  if (auto bones = FindBonesByParts(motion)) return *std::move(bones);
  throw InputError(motion.source + ": joint names of no known conversion (CMU, HDM05, BioVision, " +
                   "Mixamo, 3ds Max, Rigify, Unity, VRM, Xsens, ...)" +
                   (nearest.empty() ? "" : ", no joint for " + nearest) +
                   ": expected a mapping file for its joints" + ListJoints(motion));
}

}  // namespace ossa::recon
