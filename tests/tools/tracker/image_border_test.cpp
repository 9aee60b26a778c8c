// People who are mostly outside the image: a unit test of the stage that reads the observation.
#include <gtest/gtest.h>

#include "depth/image/camera_presets.h"
#include "recon/body/standard_body.h"
#include "tools/tracker/skeleton_stages_internal.h"

namespace ossa::tracker {
namespace {

using recon::TrackingState;

constexpr double kFrame_s = 1.0 / 30.0;
const Eigen::Vector3d kThere(0.4, 0.0, 2.0);
const Eigen::Vector3d kElsewhere(0.4, 0.2, 2.0);  // no person moves this far in a frame

// A person with a number of tracked joints, frame by frame, as the stages of the tracker have them.
class AtTheBorder : public testing::Test {
 protected:
  // Whether the observation is accepted.
  bool Step(const Eigen::Vector3d& hips_m, size_t tracked, unsigned clipped_edges = 1) {
    Body body;
    body.clipped_edges = clipped_edges;
    body.raw.posture = At(hips_m);
    for (size_t j = 0; j < recon::kJointCount; ++j) {
      body.raw.state[j] = j < tracked                  ? TrackingState::kTracked
                          : j + 1 < recon::kJointCount ? TrackingState::kInferred
                                                       : TrackingState::kNotTracked;
      body.raw.confidence[j] = j < tracked ? 0.9 : 0.1;
    }
    frame_.time_s += kFrame_s;
    SkeletonWork work{options_, frame_, floor_, nullptr, person_, body};
    AverageStationary(work);
    work.posture = work.believed ? At(hips_m) : *person_.shown;
    work.reconstructed.reliability.fill(1.0);
    Finish(work);
    states_ = {};
    for (const JointEstimate& joint : body.joints) {
      states_ += joint.state == TrackingState::kTracked ? 1 : 0;
    }
    EXPECT_EQ(body.joints.back().state, body.raw.state.back()) << "what nobody said stays absent";
    return work.believed;
  }
  static recon::Posture At(const Eigen::Vector3d& hips_m) {
    recon::Posture posture = recon::StandardPosture(recon::RigPose{});
    const Eigen::Vector3d move_m = hips_m - posture.position_m[0];
    for (auto& place_m : posture.position_m) place_m += move_m;
    return posture;
  }
  AtTheBorder() {
    frame_.camera = depth::KinectV1Camera(640, 480);
    frame_.depth_mm.assign(640 * 480, 0);
  }

  SkeletonOptions options_;
  depth::DepthFrame frame_;
  std::optional<Eigen::Vector4d> floor_;
  Person person_;
  size_t states_ = 0;  // joints returned as tracked
};

TEST_F(AtTheBorder, APersonLosingJointsDoesNotJump) {
  EXPECT_TRUE(Step(kThere, 9));
  EXPECT_EQ(states_, 9U);
  EXPECT_FALSE(Step(kElsewhere, 6));
  EXPECT_EQ(states_, 0U);
  EXPECT_TRUE(Step(kThere, 6)) << "where they were";
}

TEST_F(AtTheBorder, AcceptsABetterObservation) {
  EXPECT_TRUE(Step(kThere, 3));
  EXPECT_TRUE(Step(kElsewhere, 5));
  EXPECT_TRUE(Step(kThere, 19)) << "mostly seen";
}

TEST_F(AtTheBorder, AcceptsJumpsAfterASecond) {
  EXPECT_TRUE(Step(kThere, 9));
  int disbelieved = 0;
  while (disbelieved < 60 && !Step(kElsewhere, 6)) ++disbelieved;
  EXPECT_NEAR(disbelieved * kFrame_s, options_.hold.disbelieved_s, 2 * kFrame_s);
}

TEST_F(AtTheBorder, AcceptsJumpsInsideTheImage) {
  EXPECT_TRUE(Step(kThere, 9, 0));
  EXPECT_TRUE(Step(kElsewhere, 6, 0));
}

}  // namespace
}  // namespace ossa::tracker
