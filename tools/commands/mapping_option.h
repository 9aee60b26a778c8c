#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace ossa::commands {

/// --mapping of a command that reads mocap, and under its options what stands in such a file.
inline void AddMappingOption(CLI::App& app, std::string& mapping_file) {
  app.add_option("--mapping", mapping_file,
                 "text file of the bone names of an unknown conversion, see below");
  app.footer(
      "Of other names than those of CMU, HDM05, BioVision and Mixamo --mapping FILE says in lines\n"
      "  BONE = joint name      which joint of the BVH or AMC files turns this bone of the body\n"
      "  rest = frame N         the frame, 0 the first, that shows a T-pose or A-pose where zero\n"
      "                         angles do not (else no such line)\n"
      "A word that begins with # begins a comment. BONE is one of Hips, LowerBack, Spine, Spine1,\n"
      "Neck, Neck1, Head and, each with Left or Right before it, Shoulder, Arm, ForeArm, Hand,\n"
      "UpLeg, Leg, Foot, ToeBase. Hips, one of LowerBack, Spine, Spine1, and Arm, ForeArm, UpLeg,\n"
      "Leg, Foot of both sides must be there. The file holds for all BVH and AMC files that are\n"
      "read.");
}

}  // namespace ossa::commands
