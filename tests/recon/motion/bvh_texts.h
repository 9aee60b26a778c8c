#pragma once
#include <string>

namespace ossa::recon {

/// A performer in a T-pose, centimetres, names of the CMU "Daz-friendly" conversion, one frame of
/// zeros but for `channels` "joint.Zrotation=90" style edits done by the caller on the numbers.
/// Joints in file order: hip abdomen chest neck head lShldr lForeArm lHand rShldr rForeArm rHand
/// lThigh lShin lFoot rThigh rShin rFoot; hip has 6 channels, every other 3, Z X Y.
inline const char* const kTPoseJoints[] = {
    "hip",      "abdomen", "chest",  "neck",  "head",  "lShldr", "lForeArm", "lHand", "rShldr",
    "rForeArm", "rHand",   "lThigh", "lShin", "lFoot", "rThigh", "rShin",    "rFoot"};

inline std::string TPoseHierarchy() {
  const std::string c3 = " CHANNELS 3 Zrotation Xrotation Yrotation\n";
  const auto arm = [&](const std::string& side, const std::string& sign) {
    return "JOINT " + side + "Shldr {\nOFFSET " + sign + "15 18 0\n" + c3 + "JOINT " + side +
           "ForeArm {\nOFFSET " + sign + "28 0 0\n" + c3 + "JOINT " + side + "Hand {\nOFFSET " +
           sign + "25 0 0\n" + c3 + "End Site {\nOFFSET " + sign + "8 0 0\n}\n}\n}\n}\n";
  };
  const auto leg = [&](const std::string& side, const std::string& sign) {
    return "JOINT " + side + "Thigh {\nOFFSET " + sign + "9 0 0\n" + c3 + "JOINT " + side +
           "Shin {\nOFFSET 0 -40 0\n" + c3 + "JOINT " + side + "Foot {\nOFFSET 0 -42 0\n" + c3 +
           "End Site {\nOFFSET 0 -4 12\n}\n}\n}\n}\n";
  };
  return "HIERARCHY\nROOT hip\n{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition "
         "Zrotation Yrotation Xrotation\nJOINT abdomen {\nOFFSET 0 15 0\n" +
         c3 + "JOINT chest {\nOFFSET 0 15 0\n" + c3 + "JOINT neck {\nOFFSET 0 22 0\n" + c3 +
         "JOINT head {\nOFFSET 0 7 0\n" + c3 + "End Site\n{\nOFFSET 0 15 0\n}\n}\n}\n" +
         arm("l", "") + arm("r", "-") + "}\n}\n" + leg("l", "") + leg("r", "-") + "}\n";
}

/// Index of a joint's first rotation among the numbers of a frame.
inline size_t FirstRotation(const std::string& joint) {
  size_t j = 0;
  while (joint != kTPoseJoints[j]) ++j;
  return 3 + 3 * j;
}

inline constexpr size_t kTPoseChannels = 3 + 3 * 17;

}  // namespace ossa::recon
