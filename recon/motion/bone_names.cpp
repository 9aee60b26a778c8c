#include <algorithm>
#include <initializer_list>
#include <map>

#include "depth/base/error.h"
#include "recon/body/rig.h"
#include "recon/motion/bone_names_internal.h"
#include "recon/motion/text_scanner_internal.h"

namespace ossa::recon {
namespace {

using Names = std::vector<std::string_view>;

/// Joint names of one conversion, as Simplified() makes them; '*' stands for the side.
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

/// Lower case, without "name:" prefixes and separators: "mixamorig:Left_Arm" is "leftarm".
std::string Simplified(std::string_view name) {
  const size_t colon = name.rfind(':');
  if (colon != std::string_view::npos) name.remove_prefix(colon + 1);
  std::string simple;
  for (const char c : Lower(name)) {
    if (c != '_' && c != ' ' && c != '-' && c != '.') simple += c;
  }
  return simple;
}

class Finder {
 public:
  explicit Finder(const SourceMotion& motion) {
    for (size_t j = 0; j < motion.joints.size(); ++j) {
      index_.emplace(Simplified(motion.joints[j].name), static_cast<int>(j));
    }
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

  /// All that exist, roots first.
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

SourceBones BonesOf(const Convention& names, const Finder& finder) {
  SourceBones bones;
  bones.hips = finder.First(names.hips);
  bones.spine = finder.Chain(names.spine);
  bones.neck = finder.Chain(names.neck);
  for (size_t s = 0; s < 2; ++s) {
    const auto find = [&](const Names& of) { return finder.First(of, names.sides[s]); };
    bones.side[s] = {find(names.collar), find(names.arm), find(names.fore_arm), find(names.hand),
                     find(names.up_leg), find(names.leg), find(names.foot),     find(names.toe)};
  }
  return bones;
}

/// The first part that must be there and is not; "" when all are.
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

SourceBones MappedBones(const SourceMotion& motion, const BoneMapping& mapping) {
  std::map<std::string, int, std::less<>> joints;
  for (const auto& [bone, joint] : mapping.names) {
    const auto found =
        std::find_if(motion.joints.begin(), motion.joints.end(),
                     [&name = joint](const SourceJoint& j) { return j.name == name; });
    if (found == motion.joints.end()) {
      throw InputError(motion.source + ": the mapping gives " + bone + " the joint '" + joint +
                       "', expected a joint of this file");
    }
    joints[Simplified(bone)] = static_cast<int>(found - motion.joints.begin());
  }
  // A copy whose joints bear the rig's names is found by the rig's own convention.
  SourceMotion renamed;
  for (size_t j = 0; j < motion.joints.size(); ++j) renamed.joints.push_back({});
  for (const auto& [bone, j] : joints) renamed.joints[static_cast<size_t>(j)].name = bone;
  SourceBones bones = BonesOf(Conventions().front(), Finder(renamed));
  bones.rest_frame = mapping.rest_frame;
  return bones;
}

}  // namespace

SourceBones FindBones(const SourceMotion& motion, const std::optional<BoneMapping>& mapping) {
  if (mapping) {
    SourceBones bones = MappedBones(motion, *mapping);
    if (const std::string missing = Missing(bones); !missing.empty()) {
      throw InputError(motion.source + ": the mapping file names no joint for " + missing);
    }
    if (bones.rest_frame && *bones.rest_frame >= motion.frame_count) {
      throw InputError(motion.source + ": the mapping's rest frame is " +
                       std::to_string(*bones.rest_frame) + ", expected one of the " +
                       std::to_string(motion.frame_count) + " frames");
    }
    return bones;
  }
  const Finder finder(motion);
  std::string nearest;
  for (const Convention& names : Conventions()) {
    SourceBones bones = BonesOf(names, finder);
    const std::string missing = Missing(bones);
    if (missing.empty()) return bones;
    if (bones.hips >= 0 && bones.side[0].arm >= 0) nearest = missing;
  }
  throw InputError(motion.source + ": joint names of no known conversion (CMU, HDM05, BioVision, " +
                   "Mixamo)" + (nearest.empty() ? "" : ", no joint for " + nearest) +
                   ": expected a mapping file for its joints");
}

BoneMapping ReadBoneMapping(const std::filesystem::path& path) {
  TextScanner scan(ReadTextFile(path), path.string());
  BoneMapping mapping;
  for (auto words = scan.LineOfWords(); !words.empty(); words = scan.LineOfWords()) {
    words.erase(std::find_if(words.begin(), words.end(),
                             [](std::string_view word) { return word.starts_with('#'); }),
                words.end());
    if (words.empty()) continue;
    if (words.size() < 3 || words[1] != "=") scan.Fail("RigBone = joint name", words.front());
    if (words[0] == "rest") {
      if (words.size() != 4 || words[2] != "frame") scan.Fail("rest = frame N", words[2]);
      const double frame = scan.ToNumber(words[3], "the rest frame");
      if (frame < 0 || frame != static_cast<double>(static_cast<size_t>(frame))) {
        scan.Fail("a frame number, 0 the first", words[3]);
      }
      mapping.rest_frame = static_cast<size_t>(frame);
      continue;
    }
    if (std::find(kRigBoneNames.begin(), kRigBoneNames.end(), words[0]) == kRigBoneNames.end()) {
      scan.Fail("a bone of the rig such as LeftForeArm", words[0]);
    }
    std::string joint(words[2]);
    for (size_t w = 3; w < words.size(); ++w) (joint += ' ') += words[w];
    mapping.names.emplace_back(words[0], joint);
  }
  if (mapping.names.empty()) scan.Fail("at least one line RigBone = joint name", "");
  return mapping;
}

}  // namespace ossa::recon
