#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace ossa::commands {

/// What stands in a file for --mapping, for under a command's options.
inline const char* MappingHelp() {
  return "Of names of its own a file's joints or points are told by --mapping FILE, in lines\n"
         "  BONE = joint name      which joint of a BVH or AMC file turns this bone of the body, "
         "or\n"
         "                         which point of a TRC or C3D file is where it begins; of points\n"
         "                         also the middle of several, as A + B\n"
         "  rest = frame N         the frame, 0 the first, that shows a T-pose or A-pose where "
         "zero\n"
         "                         angles do not (else no such line)\n"
         "A word that begins with # begins a comment. BONE is one of Hips, LowerBack, Spine, "
         "Spine1,\n"
         "Neck, Neck1, Head and, each with Left or Right before it, Shoulder, Arm, ForeArm, Hand,\n"
         "UpLeg, Leg, Foot, ToeBase, or one of the SDK's joints, HipCenter, ElbowLeft and so on. "
         "Of\n"
         "BVH and AMC Hips, one of LowerBack, Spine, Spine1, and Arm, ForeArm, UpLeg, Leg, Foot "
         "of\n"
         "both sides must be there. The file holds for all files in which any of its names "
         "occurs;\n"
         "the names of CMU, HDM05, BioVision, Mixamo, 3ds Max, Rigify, Unity, VRM, Xsens, Rokoko,\n"
         "Perception Neuron and others are known without.";
}

/// --mapping of a command that reads mocap or skeletons. Where `help`, what stands in such a file
/// goes under the command's options.
inline void AddMappingOption(CLI::App& app, std::string& mapping_file, bool help = true) {
  app.add_option("--mapping", mapping_file,
                 "text file of joints' names that are none of those known, see below");
  if (help) app.footer(MappingHelp());
}

}  // namespace ossa::commands
