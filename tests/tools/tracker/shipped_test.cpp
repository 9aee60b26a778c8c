#include <algorithm>

#include "tests/tools/tracker/tracked_scenes.h"

namespace ossa::tracker {
namespace {

TEST(ShippedFile, IsRecognisedByAnyOfItsPathsOnly) {
  OSSA_NEEDS_MODEL();
  const std::filesystem::path model = ShippedFile("body.ossa");
  EXPECT_TRUE(IsShippedFile(model, "body.ossa"));
  EXPECT_TRUE(IsShippedFile(model.parent_path() / "." / model.filename(), "body.ossa"));
  EXPECT_FALSE(IsShippedFile(model, "authored.ossadb"));
  EXPECT_FALSE(IsShippedFile(model, "nothing_of_that_name"));
  EXPECT_FALSE(IsShippedFile(model.parent_path() / "nothing_of_that_name", "body.ossa"));
}

// What is known of the shipped forest's errors corrects its joints, however it was named.
TEST(ShippedFile, NamingItByItsPathEqualsTheDefault) {
  OSSA_NEEDS_MODEL();
  ModelFiles files;
  files.forest = ShippedFile("body.ossa").string();
  const TrackerOptions named = OptionsWith(files);
  const auto render = Rendered({PersonAt(0.0, 2.5)});
  const BodyFrame a = Tracker(named).Track(render.frame);
  const BodyFrame b = Tracker().Track(render.frame);
  ASSERT_EQ(a.bodies.size(), 1U);
  ASSERT_EQ(b.bodies.size(), 1U);
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    EXPECT_EQ(a.bodies[0].reconstructed.position_m[j], b.bodies[0].reconstructed.position_m[j]);
  }
}

// Without a look nothing is known of what it leaves: there "none" changes nothing.
TEST(ShippedFile, CorrectionNoneDisablesTheCascadesOwnCorrection) {
  OSSA_NEEDS_MODEL();
  const auto render = Rendered({PersonAt(0.0, 2.5)});
  const auto tracked = [&render](const std::string& look, const std::string& learned) {
    ModelFiles files;
    files.refinement = look;
    files.learned = learned;
    const BodyFrame frame = Tracker(OptionsWith(files)).Track(render.frame);
    EXPECT_EQ(frame.bodies.size(), 1U);
    return frame.bodies.empty() ? recon::Posture() : frame.bodies[0].reconstructed;
  };
  // How far the joint that is moved farthest is.
  const auto apart_m = [](const recon::Posture& a, const recon::Posture& b) {
    double farthest_m = 0.0;
    for (size_t j = 0; j < recon::kJointCount; ++j) {
      farthest_m = std::max(farthest_m, (a.position_m[j] - b.position_m[j]).norm());
    }
    return farthest_m;
  };
  EXPECT_GT(apart_m(tracked("", ""), tracked("", "none")), 5e-4);
  EXPECT_EQ(apart_m(tracked("none", ""), tracked("none", "none")), 0.0);
}

}  // namespace
}  // namespace ossa::tracker
