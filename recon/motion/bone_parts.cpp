#include "recon/motion/bone_parts_internal.h"

#include <algorithm>
#include <map>
#include <set>
#include <span>
#include <vector>

#include "depth/base/lower_case.h"
#include "recon/motion/text_scanner_internal.h"

namespace ossa::recon {
namespace {

using Words = std::vector<std::string_view>;

// Common names of the joint where a limb segment starts, the least ambiguous first.
const Words kArmWords = {"upperarm", "uparm",     "arm",       "shldr",      "humerus",
                         "uarm",     "shldrbend", "lupperarm", "upperarm01", "shoulderjoint"};
const Words kForeArmWords = {"forearm", "lowerarm", "lowarm",      "loarm",     "elbow",
                             "radius",  "farm",     "forearmbend", "lowerarm01"};
const Words kHandWords = {"wrist", "hand", "palm"};
const Words kUpLegWords = {"upleg", "upperleg",  "thigh",     "femur",
                           "uleg",  "thighbend", "upperleg01"};
const Words kLegWords = {"leg",   "shin", "lowerleg", "lowleg", "knee",
                         "tibia", "calf", "lleg",     "loleg",  "lowerleg01"};
const Words kToeWords = {"toebase", "toe", "toes", "toe0", "ball", "toe1", "toe11", "toe01"};
const Words kCollarWords = {"collar", "clavicle", "collarbone", "clav", "clavicle01"};
const Words kHipsWords = {"hips", "hip", "pelvis", "hipcenter", "hipscenter"};
const Words kHeadWords = {"head", "skull"};

constexpr std::string_view kSeparators = ":_ -.|/";

struct Side {
  std::array<std::string_view, 2> words;  // prefixes or suffixes
};
constexpr std::array<Side, 2> kSides = {Side{{"left", "l"}}, Side{{"right", "r"}}};

/// The joints of one rig by simplified name, without common prefix and suffix.
class AffixedNames {
 public:
  AffixedNames(const SourceMotion& motion, std::string_view prefix, std::string_view suffix) {
    for (size_t j = 0; j < motion.joints.size(); ++j) {
      std::string_view name = motion.joints[j].name;
      if (!name.starts_with(prefix)) continue;
      name.remove_prefix(prefix.size());
      if (name.size() > suffix.size() && name.ends_with(suffix)) name.remove_suffix(suffix.size());
      index_.emplace(SimplifyJointName(name), static_cast<int>(j));
    }
  }

  int FindSided(const Words& words, size_t side) const {
    for (const std::string_view word : words) {
      for (const std::string_view mark : kSides[side].words) {
        for (const std::string& name :
             {std::string(mark).append(word), std::string(word).append(mark)}) {
          if (const auto found = index_.find(name); found != index_.end()) return found->second;
        }
      }
    }
    return -1;
  }

  int FindMiddle(const Words& words) const {
    for (const std::string_view word : words) {
      for (const char* mark : {"", "c", "center"}) {  // VRM: "C_Hips"
        const auto found = index_.find(std::string(mark).append(word));
        if (found != index_.end()) return found->second;
      }
    }
    return -1;
  }

 private:
  std::map<std::string, int, std::less<>> index_;
};

/// The joint hierarchy.
class Tree {
 public:
  explicit Tree(const std::vector<SourceJoint>& joints) : joints_(joints) {}

  bool IsBelow(int joint, int ancestor) const {
    for (int j = Parent(joint); j >= 0; j = Parent(j)) {
      if (j == ancestor) return true;
    }
    return false;
  }

  /// The lowest common ancestor (possibly one of the two); -1 for none.
  int FindCommon(int a, int b) const {
    for (int j = a; j >= 0; j = Parent(j)) {
      if (j == b || IsBelow(b, j)) return j;
    }
    return -1;
  }

  /// The joints below `from` down to its descendant `to`.
  std::vector<int> PathBetween(int from, int to) const {
    std::vector<int> path;
    for (int j = to; j >= 0 && j != from; j = Parent(j)) path.push_back(j);
    std::reverse(path.begin(), path.end());
    return path;
  }

 private:
  int Parent(int joint) const { return joints_[static_cast<size_t>(joint)].parent; }

  const std::vector<SourceJoint>& joints_;
};

SideBones FindSide(const AffixedNames& names, size_t side) {
  const auto find = [&](const Words& words) { return names.FindSided(words, side); };
  SideBones bones;
  bones.arm = find(kArmWords);
  bones.collar = find(kCollarWords);
  // "Shoulder" is the collar if the upper arm has another name.
  const int shoulder = find({"shoulder", "shoulder01"});
  if (bones.arm < 0) {
    bones.arm = shoulder;
  } else if (bones.collar < 0) {
    bones.collar = shoulder;
  }
  bones.fore_arm = find(kForeArmWords);
  bones.hand = find(kHandWords);
  bones.up_leg = find(kUpLegWords);
  bones.leg = find(kLegWords);
  if (bones.up_leg < 0) {
    // "Leg" and "Knee" are thigh and shin; so are "Hip" and "Knee".
    const int knee = find({"knee"}), leg = find({"leg"});
    bones.up_leg = leg >= 0 && knee >= 0 ? leg : find({"hip", "hipjoint"});
    if (leg >= 0 && knee >= 0) bones.leg = knee;
  }
  const int ankle = find({"ankle"}), foot = find({"foot"});
  bones.foot = ankle >= 0 ? ankle : foot;
  bones.toe = find(kToeWords);
  if (bones.toe < 0 && ankle >= 0) bones.toe = foot;
  return bones;
}

/// Whether the joints form a valid limb hierarchy; if not, their names mean something else.
bool AreLimbs(const SideBones& side, const Tree& tree) {
  return side.arm >= 0 && side.fore_arm >= 0 && side.up_leg >= 0 && side.leg >= 0 &&
         side.foot >= 0 && tree.IsBelow(side.fore_arm, side.arm) &&
         tree.IsBelow(side.leg, side.up_leg) && tree.IsBelow(side.foot, side.leg);
}

void DropStrays(SideBones& side, const Tree& tree) {
  if (side.hand >= 0 && !tree.IsBelow(side.hand, side.fore_arm)) side.hand = -1;
  if (side.toe >= 0 && !tree.IsBelow(side.toe, side.foot)) side.toe = -1;
  if (side.collar >= 0 && !tree.IsBelow(side.arm, side.collar)) side.collar = -1;
}

/// The head of Rigify's rigs, which is unnamed: the last spine bone above the arms.
int FindHeadOfSpine(const SourceMotion& motion, const Tree& tree, int chest) {
  int head = -1;
  for (size_t j = 0; j < motion.joints.size(); ++j) {
    const std::string name = SimplifyJointName(motion.joints[j].name);
    const bool of_spine =
        name.find("spine") != std::string::npos || name.find("neck") != std::string::npos;
    if (of_spine && tree.IsBelow(static_cast<int>(j), head >= 0 ? head : chest)) {
      head = static_cast<int>(j);
    }
  }
  return head;
}

std::optional<SourceBones> FindWith(const SourceMotion& motion, const AffixedNames& names) {
  const Tree tree(motion.joints);
  SourceBones bones;
  for (size_t s = 0; s < 2; ++s) {
    bones.side[s] = FindSide(names, s);
    if (!AreLimbs(bones.side[s], tree)) return std::nullopt;
    DropStrays(bones.side[s], tree);
  }
  const int legs = tree.FindCommon(bones.side[0].up_leg, bones.side[1].up_leg);
  int chest = tree.FindCommon(bones.side[0].arm, bones.side[1].arm);
  const int middle = legs >= 0 && chest >= 0 ? tree.FindCommon(legs, chest) : -1;
  if (middle < 0) return std::nullopt;
  bones.hips = names.FindMiddle(kHipsWords);
  // The legs may be children of the spine (3ds Max), but both must descend from the hips.
  if (bones.hips < 0 || (bones.hips != middle && !tree.IsBelow(middle, bones.hips))) {
    bones.hips = middle;
  }
  bones.head = names.FindMiddle(kHeadWords);
  if (bones.head < 0) bones.head = FindHeadOfSpine(motion, tree, chest);
  if (bones.head >= 0 && !tree.IsBelow(bones.head, chest)) {
    const int below = tree.FindCommon(bones.head, chest);
    if (below >= 0 && tree.IsBelow(below, bones.hips)) chest = below;
  }
  bones.spine = tree.PathBetween(bones.hips, chest);
  if (bones.head >= 0 && tree.IsBelow(bones.head, chest)) {
    bones.neck = tree.PathBetween(chest, bones.head);
  }
  if (bones.spine.empty()) return std::nullopt;
  return bones;
}

/// Common prefixes up to a separator, most frequent first; "" before all others.
std::vector<std::string> CommonPrefixes(const std::vector<SourceJoint>& joints) {
  constexpr size_t kFewest = 10;  // by hand: one side of a person hardly has so many joints
  std::map<std::string, size_t> counts;
  for (const SourceJoint& joint : joints) {
    for (size_t at = 0; at < joint.name.size(); ++at) {
      if (kSeparators.find(joint.name[at]) == std::string_view::npos) continue;
      ++counts[joint.name.substr(0, at + 1)];
    }
  }
  std::vector<std::pair<size_t, std::string>> sorted;
  for (const auto& [prefix, count] : counts) {
    if (count >= kFewest) sorted.emplace_back(count, prefix);
  }
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<std::string> prefixes = {""};
  for (auto& [count, prefix] : sorted) prefixes.push_back(std::move(prefix));
  return prefixes;
}

/// The common suffix of all names, starting at a separator ("_1" of a second figure); "" if none.
std::string CommonSuffix(const std::vector<SourceJoint>& joints) {
  std::string suffix = joints.empty() ? "" : joints.front().name;
  for (const SourceJoint& joint : joints) {
    const size_t shorter = std::min(suffix.size(), joint.name.size());
    size_t same = 0;
    while (same < shorter &&
           suffix[suffix.size() - 1 - same] == joint.name[joint.name.size() - 1 - same]) {
      ++same;
    }
    suffix.erase(0, suffix.size() - same);
  }
  const size_t begin = suffix.find_first_of(kSeparators);
  return begin == std::string::npos ? "" : suffix.substr(begin);
}

}  // namespace

std::string SimplifyJointName(std::string_view name) {
  const size_t colon = name.rfind(':');
  if (colon != std::string_view::npos) name.remove_prefix(colon + 1);
  std::string simple;
  for (const char c : LowerCase(name)) {
    if (c != '_' && c != ' ' && c != '-' && c != '.') simple += c;
  }
  return simple;
}

std::optional<SourceBones> FindBonesByParts(const SourceMotion& motion) {
  const std::string suffix = CommonSuffix(motion.joints);
  for (const std::string& prefix : CommonPrefixes(motion.joints)) {
    if (auto bones = FindWith(motion, AffixedNames(motion, prefix, suffix))) return bones;
  }
  return std::nullopt;
}

}  // namespace ossa::recon
