#include <cctype>
#include <string>
#include <unordered_map>

#include "recon/files/joint_names_internal.h"

namespace ossa::recon {
namespace {

std::string Plain(std::string_view name) {
  std::string plain;
  for (const char c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) {
      plain.push_back(static_cast<char>(std::tolower(static_cast<unsigned char>(c))));
    }
  }
  return plain;
}

struct Limb {
  std::string_view names;  // of the body part, separated by spaces
  Joint left;
  Joint right;
};

constexpr Limb kLimbs[] = {
    {"shoulder sho sjc upperarm", Joint::kShoulderLeft, Joint::kShoulderRight},
    {"elbow elb ejc forearm", Joint::kElbowLeft, Joint::kElbowRight},
    {"wrist wri wjc", Joint::kWristLeft, Joint::kWristRight},
    {"hand", Joint::kHandLeft, Joint::kHandRight},
    {"hip hjc", Joint::kHipLeft, Joint::kHipRight},
    {"knee kne kjc", Joint::kKneeLeft, Joint::kKneeRight},
    {"ankle ank ajc", Joint::kAnkleLeft, Joint::kAnkleRight},
    {"foot", Joint::kFootLeft, Joint::kFootRight},
};

constexpr std::pair<std::string_view, Joint> kMiddle[] = {
    {"hipcenter", Joint::kHipCenter},
    {"hipcentro", Joint::kHipCenter},
    {"pelvis", Joint::kHipCenter},
    {"spinebase", Joint::kHipCenter},
    {"spine", Joint::kSpine},
    {"spinemid", Joint::kSpine},
    {"spinenavel", Joint::kSpine},
    {"torso", Joint::kSpine},
    {"shouldercenter", Joint::kShoulderCenter},
    {"spineshoulder", Joint::kShoulderCenter},
    // The neck of Azure Kinect and ITOP is at its base, the SDK's ShoulderCenter.
    {"neck", Joint::kShoulderCenter},
    {"head", Joint::kHead},
};

std::unordered_map<std::string, Joint> MakeNames() {
  std::unordered_map<std::string, Joint> names;
  for (const auto& [name, joint] : kMiddle) names.emplace(name, joint);
  for (const Limb& limb : kLimbs) {
    for (size_t begin = 0; begin < limb.names.size();) {
      const size_t end = std::min(limb.names.find(' ', begin), limb.names.size());
      const std::string part(limb.names.substr(begin, end - begin));
      for (const auto& [left, right] : {std::pair{"l", "r"}, std::pair{"left", "right"}}) {
        names.emplace(left + part, limb.left);
        names.emplace(right + part, limb.right);
        names.emplace(part + left, limb.left);
        names.emplace(part + right, limb.right);
      }
      begin = end + 1;
    }
  }
  return names;
}

}  // namespace

std::optional<Joint> FindJointByName(std::string_view name) {
  static const std::unordered_map<std::string, Joint> kNames = MakeNames();
  const auto found = kNames.find(Plain(name));
  if (found == kNames.end()) return std::nullopt;
  return found->second;
}

}  // namespace ossa::recon
