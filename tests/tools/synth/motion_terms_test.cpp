// Whose motion a data set says that it is made of.
#include "tools/synth/motion_terms.h"

#include <gtest/gtest.h>

#include <array>

namespace ossa::tools {
namespace {

TEST(MotionTerms, FolderNamedCmuHasItsTerms) {
  for (const std::string source :
       {"cmu", "mocap/cmu30", "mocap/cmu30/", "./cmu_bvh", "cmu/05_03.bvh"}) {
    EXPECT_NE(ListTerms(std::array{source}).at(1).find("NSF EIA-0196217"), std::string::npos)
        << source;
  }
}

// Somebody's own recordings in a folder of a folder that is called after the CMU.
TEST(MotionTerms, OtherFoldersHaveNoKnownTerms) {
  for (const std::string source : {"cmu_lab/mine", "/home/cmu/studio/", "my-cmu-like", "."}) {
    EXPECT_EQ(ListTerms(std::array{source}).at(1),
              "motion " + source + ": see the terms of that folder");
  }
}

}  // namespace
}  // namespace ossa::tools
