#include "depth/base/lower_case.h"

#include <gtest/gtest.h>

namespace ossa {
namespace {

TEST(LowerCase, ChangesAsciiLettersOnly) { EXPECT_EQ(LowerCase("AÄz[@`{9Z"), "aÄz[@`{9z"); }

TEST(LowerCase, ExtensionsAreComparedWithoutRegardToCase) {
  EXPECT_EQ(LowerCaseExtension("folder.X/Walk.JsonL"), ".jsonl");
  EXPECT_TRUE(HasEnding("walk.TAR.gz", ".tar.gz"));
  EXPECT_TRUE(HasEnding(".OSSA", ".ossa"));
  EXPECT_FALSE(HasEnding("ossa", ".ossa"));
  EXPECT_FALSE(HasEnding("walk.ossadb", ".ossa"));
}

}  // namespace
}  // namespace ossa
