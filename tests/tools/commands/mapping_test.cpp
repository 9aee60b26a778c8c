// --mapping: mocap with custom joint names, for every command that reads mocap.
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "recon/body/body_model.h"
#include "tests/recon/motion/bvh_texts.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_folder.h"

namespace ossa::commands {
namespace {

using test::RunOssa;

// Bones of the body and the joints of bvh_texts.h, as a user would write them.
constexpr std::array<std::pair<const char*, const char*>, 17> kBones = {
    {{"Hips", "hip"},
     {"LowerBack", "abdomen"},
     {"Spine1", "chest"},
     {"Neck", "neck"},
     {"Head", "head"},
     {"LeftArm", "lShldr"},
     {"LeftForeArm", "Elle"},
     {"LeftHand", "lHand"},
     {"RightArm", "rShldr"},
     {"RightHand", "rHand"},
     {"RightForeArm", "rForeArm"},
     {"LeftUpLeg", "lThigh"},
     {"LeftLeg", "lShin"},
     {"LeftFoot", "lFoot"},
     {"RightUpLeg", "rThigh"},
     {"RightLeg", "rShin"},
     {"RightFoot", "rFoot"}}};

struct Use {
  const char* command;
  std::vector<std::string> options;
};

class MappingOption : public testing::TestWithParam<Use> {
 protected:
  void SetUp() override {
    if (std::string(GetParam().command) == "render" && !recon::BodyIsFetched(recon::BodyFolder())) {
      GTEST_SKIP() << "no body: tools/fetch_body";
    }
    std::string text = recon::TPoseHierarchy();
    text.replace(text.find("lForeArm"), 8, "Elle");
    text += "MOTION\nFrames: 120\nFrame Time: 0.0333333\n";
    for (size_t frame = 0; frame < 120; ++frame) {
      for (size_t i = 0; i < recon::kTPoseChannels; ++i)
        text += std::to_string(i % 7 * frame) + " ";
      text += "\n";
    }
    std::ofstream(folder_ / "clip.bvh") << text;
    std::ofstream mapping(folder_ / "names.txt");
    mapping << "# names of ours\n";
    for (const auto& [bone, joint] : kBones) mapping << bone << " = " << joint << "\n";
  }

  test::CommandResult Run(const std::vector<std::string>& more) const {
    std::vector<std::string> words = {GetParam().command,
                                      "--mocap",
                                      folder_ / "clip.bvh",
                                      "--out",
                                      folder_ / (std::string("x.ossa") + GetParam().command),
                                      "--quiet"};
    words.insert(words.end(), GetParam().options.begin(), GetParam().options.end());
    words.insert(words.end(), more.begin(), more.end());
    return RunOssa(words);
  }

  test::TemporaryFolder folder_;
};

TEST_P(MappingOption, ReadsSkeletonsWithCustomJointNames) {
  const auto without = Run({});
  EXPECT_EQ(without.exit_status, 1);
  EXPECT_NE(without.err.find("expected a mapping file"), std::string::npos) << without.err;
  const auto with = Run({"--mapping", folder_ / "names.txt"});
  EXPECT_EQ(with.exit_status, 0) << with.err;
}

TEST_P(MappingOption, ReportsABadLineByItsNumber) {
  std::ofstream(folder_ / "names.txt") << "Hips = hip\nLeftElbow = Elle\n";
  const auto run = Run({"--mapping", folder_ / "names.txt"});
  EXPECT_EQ(run.exit_status, 1);
  EXPECT_EQ(test::LineCount(run.err), 1) << run.err;
  EXPECT_NE(run.err.find("names.txt: line 2: expected a bone"), std::string::npos) << run.err;
}

TEST_P(MappingOption, HelpDescribesItsSyntax) {
  const std::string help = RunOssa({GetParam().command, "--help"}).out;
  for (const auto& [bone, joint] : kBones) {
    std::string name = bone;
    for (const std::string side : {"Left", "Right"}) {
      if (name.starts_with(side)) name.erase(0, side.size());
    }
    EXPECT_NE(help.find(name), std::string::npos) << bone;
  }
  EXPECT_NE(help.find("BONE = joint name"), std::string::npos) << help;
  EXPECT_NE(help.find("rest = frame N"), std::string::npos) << help;
}

INSTANTIATE_TEST_SUITE_P(Of, MappingOption,
                         testing::Values(Use{"database", {"--threshold", "0.01"}},
                                         Use{"prior", {"--modes", "3", "--hidden", "0"}},
                                         Use{"render", {"--frames", "1", "--size", "64x48"}}),
                         [](const auto& info) { return std::string(info.param.command); });

// Frames rendered with another mapping are not continued.
TEST(RenderCommand, ResumesWithTheSameMappingOnly) {
  if (!recon::BodyIsFetched(recon::BodyFolder())) GTEST_SKIP() << "no body: tools/fetch_body";
  const test::TemporaryFolder folder;
  std::string text = recon::TPoseHierarchy() + "MOTION\nFrames: 1\nFrame Time: 0.0333333\n";
  for (size_t i = 0; i < recon::kTPoseChannels; ++i) text += "0 ";
  std::ofstream(folder / "clip.bvh") << text << "\n";
  std::ofstream mapping(folder / "names.txt");
  for (const auto& [bone, joint] : kBones) {
    mapping << bone << " = " << (std::string(joint) == "Elle" ? "lForeArm" : joint) << "\n";
  }
  mapping.close();
  std::vector<std::string> words = {
      "render", "--mocap", folder / "clip.bvh", "--out", folder / "set", "--frames", "1", "--size",
      "64x48",  "--quiet"};
  ASSERT_EQ(RunOssa(words).exit_status, 0);
  words.insert(words.end(), {"--mapping", folder / "names.txt"});
  const auto other = RunOssa(words);
  EXPECT_EQ(other.exit_status, 1);
  EXPECT_NE(other.err.find("another data set is there"), std::string::npos) << other.err;
}

}  // namespace
}  // namespace ossa::commands
