#include "tools/learning/common_parts.h"

#include <algorithm>
#include <array>

#include "recon/body/parts.h"

namespace ossa::tools {
namespace {

// One common part: PCL's classes and our parts that make it up. Borders agree only roughly: PCL
// parts chest and hips where we part the upper and the lower trunk, so each side's trunk is one;
// and it cuts the head in quarters along other lines. `guessed` are parts of ours that PCL gives to
// a neighbour: right where that neighbour is.
struct CommonPart {
  std::string_view name;
  std::array<std::string_view, 4> pcl;
  std::array<std::string_view, 4> ours;
  std::string_view guessed;
};

constexpr std::array<CommonPart, kCommonPartCount> kCommonParts = {{
    {"head",
     {"FaceLT", "FaceRT", "FaceLB", "FaceRB"},
     {"LU head", "RU head", "LW head", "RW head"},
     ""},
    {"neck", {"Neck"}, {"neck"}, ""},
    {"L trunk", {"Lchest", "Lhips"}, {"LU torso", "LW torso"}, ""},
    {"R trunk", {"Rchest", "Rhips"}, {"RU torso", "RW torso"}, ""},
    {"L arm", {"Larm"}, {"LU arm"}, "L shoulder"},
    {"R arm", {"Rarm"}, {"RU arm"}, "R shoulder"},
    {"L elbow", {"Lelbow"}, {"L elbow"}, ""},
    {"R elbow", {"Relbow"}, {"R elbow"}, ""},
    {"L forearm", {"Lforearm"}, {"LW arm"}, "L wrist"},
    {"R forearm", {"Rforearm"}, {"RW arm"}, "R wrist"},
    {"L hand", {"Lhand"}, {"L hand"}, ""},
    {"R hand", {"Rhand"}, {"R hand"}, ""},
    {"L thigh", {"Lthigh"}, {"LU leg"}, ""},
    {"R thigh", {"Rthigh"}, {"RU leg"}, ""},
    {"L knee", {"Lknee"}, {"L knee"}, ""},
    {"R knee", {"Rknee"}, {"R knee"}, ""},
    {"L leg", {"Lleg"}, {"LW leg"}, "L ankle"},
    {"R leg", {"Rleg"}, {"RW leg"}, "R ankle"},
    {"L foot", {"Lfoot"}, {"L foot"}, ""},
    {"R foot", {"Rfoot"}, {"R foot"}, ""},
}};

template <size_t N>
bool Has(const std::array<std::string_view, N>& names, std::string_view name) {
  return !name.empty() && std::find(names.begin(), names.end(), name) != names.end();
}

// PCL's classes that lie around a joint.
std::vector<std::string_view> PclClassesAround(recon::Joint joint) {
  switch (joint) {
    case recon::Joint::kHead:
      return {"FaceLB", "FaceRB", "FaceLT", "FaceRT"};
    case recon::Joint::kShoulderCenter:
      return {"Neck"};
    case recon::Joint::kElbowLeft:
      return {"Lelbow"};
    case recon::Joint::kHandLeft:
      return {"Lhand"};
    case recon::Joint::kElbowRight:
      return {"Relbow"};
    case recon::Joint::kHandRight:
      return {"Rhand"};
    case recon::Joint::kKneeLeft:
      return {"Lknee"};
    case recon::Joint::kFootLeft:
      return {"Lfoot"};
    case recon::Joint::kKneeRight:
      return {"Rknee"};
    case recon::Joint::kFootRight:
      return {"Rfoot"};
    default:
      return {};
  }
}

}  // namespace

std::array<std::string_view, kCommonPartCount> CommonPartNames() {
  std::array<std::string_view, kCommonPartCount> names;
  for (size_t part = 0; part < names.size(); ++part) names[part] = kCommonParts[part].name;
  return names;
}

uint8_t ToCommonPart(uint8_t label) {
  for (uint8_t part = 0; part < kCommonPartCount; ++part) {
    if (label > 0 && Has(kCommonParts[part].ours, recon::kPartNames[label])) return part;
  }
  return kNoCommonPart;
}

std::optional<std::vector<uint8_t>> FindCommonParts(std::span<const std::string> class_names) {
  std::vector<uint8_t> common(class_names.size(), kNoCommonPart);
  int found = 0;
  for (size_t c = 1; c < class_names.size(); ++c) {
    const std::string& name = class_names[c];
    for (uint8_t part = 0; part < kCommonPartCount; ++part) {
      const CommonPart& p = kCommonParts[part];
      if (!Has(p.ours, name) && !Has(p.pcl, name) && name != p.guessed) continue;
      common[c] = part;
      ++found;
    }
  }
  if (found < kCommonPartCount) return std::nullopt;
  return common;
}

bool IsCommonJoint(recon::Joint joint) { return !PclClassesAround(joint).empty(); }

std::vector<forest::ProposalTarget> PclTargets(std::span<const std::string> class_names) {
  std::vector<forest::ProposalTarget> targets(recon::kJointCount);
  for (size_t j = 0; j < targets.size(); ++j) {
    targets[j].name = recon::kJointNames[j];
    const auto around = PclClassesAround(static_cast<recon::Joint>(j));
    for (size_t c = 1; c < class_names.size(); ++c) {
      const bool is_around =
          std::find(around.begin(), around.end(), class_names[c]) != around.end();
      if (is_around) targets[j].classes.push_back(static_cast<uint8_t>(c));
    }
  }
  return targets;
}

}  // namespace ossa::tools
