#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace ossa::commands {

/// The format of a --mapping file, for the footer of a command's help.
inline const char* MappingHelp() {
  return R"(--mapping FILE names the joints or points of files whose names are not known. Its lines are
  BONE = joint name      the joint of a BVH or AMC file that turns this bone, or the point of
                         a TRC or C3D file at which it begins; A + B is the midpoint of two
  rest = frame N         the frame, counted from 0, that shows a T-pose or A-pose, if zero
                         angles do not
  # comment
BONE is one of Hips, LowerBack, Spine, Spine1, Neck, Neck1, Head and, each with Left or Right
before it, Shoulder, Arm, ForeArm, Hand, UpLeg, Leg, Foot, ToeBase, or one of the SDK's joints,
HipCenter, ElbowLeft and so on. BVH and AMC need Hips, one of LowerBack, Spine, Spine1, and Arm,
ForeArm, UpLeg, Leg, Foot of both sides. The mapping applies to all files in which any of its
names occurs. The names of CMU, HDM05, BioVision, Mixamo, 3ds Max, Rigify, Unity, VRM, Xsens,
Rokoko, Perception Neuron and others are known.)";
}

/// Adds --mapping for a command that reads mocap or skeletons. With `help`, the footer describes
/// the file.
inline void AddMappingOption(CLI::App& app, std::string& mapping_file, bool help = true) {
  app.add_option("--mapping", mapping_file, "text file that maps unknown joint names, see below");
  if (help) app.footer(MappingHelp());
}

}  // namespace ossa::commands
