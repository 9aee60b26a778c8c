#include "tools/experiments/papers/visibility_errors.h"

#include <gtest/gtest.h>

#include "recon/normalise.h"
#include "tools/experiments/sdk/method_runs.h"

namespace ossa::tools {
namespace {

using recon::Joint;

// The standing person in one frame, the left hand hidden and `off_m` away from where it is.
RecordedPair OneFrame(double off_m) {
  RecordedPair pair;
  pair.clip = "standing";
  recon::BodyRecord body;
  body.id = 1;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    recon::JointRecord record;
    record.position_m = recon::StandardStance().position_m[j] + Eigen::Vector3d(0, 0, 2);
    record.visible = static_cast<Joint>(j) != Joint::kHandLeft;
    body.joints[j] = record;
  }
  pair.truth.frames.push_back({0, 0.0, {}, {body}});
  body.joints[Joint::kHandLeft]->position_m.x() += off_m;
  pair.observed.frames.push_back({0, 0.0, {}, {body}});
  return pair;
}

TEST(ErrorsByVisibility, CountBonesHiddenAtOneEndAsHidden) {
  const std::vector<RecordedPair> clips = {OneFrame(0.07)};
  const auto errors =
      ErrorsByVisibility(clips, {PairClip("standing", clips[0].truth, clips[0].observed)});
  EXPECT_NEAR(errors.visible_cm.value(), 0.0, 1e-9);  // rounding
  EXPECT_NEAR(errors.hidden_cm.value(), 7.0, 1e-9);
  EXPECT_NEAR(errors.hidden_share, 1.0 / 19.0, 1e-12);
}

TEST(ErrorsByVisibility, LeaveOutAbsentBones) {
  EXPECT_FALSE(ErrorsByVisibility({}, {}).visible_cm.has_value());
}

}  // namespace
}  // namespace ossa::tools
