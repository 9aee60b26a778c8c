#pragma once
#include <string>

namespace ossa::recon {

/// A performer in a T-pose in Acclaim form with the bone names of CMU and HDM05: every bone turns
/// about rx ry rz, the elbow about axes tilted by 30 degrees about z as files do.
inline std::string TPoseAsf() {
  int id = 0;
  const auto bone = [&](const std::string& name, const std::string& direction, double length,
                        const std::string& axis = "0 0 0") {
    return "  begin\n    id " + std::to_string(++id) + "\n    name " + name + "\n    direction " +
           direction + "\n    length " + std::to_string(length) + "\n    axis " + axis +
           " XYZ\n    dof rx ry rz\n    limits (-160.0 20.0)\n           (-70.0 70.0)\n"
           "           (-60.0 70.0)\n  end\n";
  };
  std::string text =
      "# a comment\n:version 1.10\n:name test\n:units\n  mass 1.0\n  length 0.45\n  angle deg\n"
      ":documentation\n  free words, even 'begin'\n:root\n  order TX TY TZ RX RY RZ\n  axis XYZ\n"
      "  position 0 0 0\n  orientation 0 0 0\n:bonedata\n";
  text +=
      bone("lowerback", "0 1 0", 2) + bone("upperback", "0 1 0", 2) + bone("thorax", "0 1 0", 2);
  text += bone("lowerneck", "0 1 0", 1) + bone("upperneck", "0 1 0", 1) + bone("head", "0 1 0", 1);
  for (const std::string side : {"l", "r"}) {
    const std::string out = side == "l" ? "1 0 0" : "-1 0 0";
    text += bone(side + "clavicle", out, 2.5) + bone(side + "humerus", out, 5);
    text += bone(side + "radius", out, 3, side == "l" ? "0 0 30" : "0 0 -30");
    text += bone(side + "wrist", out, 1.5) + bone(side + "hand", out, 1);
    text += bone(side + "hipjoint", side == "l" ? "1 -0.5 0" : "-1 -0.5 0", 2);
    text += bone(side + "femur", "0 -1 0", 7) + bone(side + "tibia", "0 -1 0", 7.2);
    text += bone(side + "foot", "0 -0.3 1", 2) + bone(side + "toes", "0 0 1", 1);
  }
  text +=
      ":hierarchy\n  begin\n    root lowerback lhipjoint rhipjoint\n    lowerback upperback\n"
      "    upperback thorax\n    thorax lowerneck lclavicle rclavicle\n"
      "    lowerneck upperneck\n    upperneck head\n";
  for (const std::string s : {"l", "r"}) {
    text += "    " + s + "clavicle " + s + "humerus\n    " + s + "humerus " + s + "radius\n    " +
            s + "radius " + s + "wrist\n    " + s + "wrist " + s + "hand\n    " + s + "hipjoint " +
            s + "femur\n    " + s + "femur " + s + "tibia\n    " + s + "tibia " + s + "foot\n    " +
            s + "foot " + s + "toes\n";
  }
  return text + "  end\n";
}

}  // namespace ossa::recon
