// The C and the C++ interface return the same numbers for the same images.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "tests/tools/tracker/walk_in_c.h"
#include "tools/tracker/tracker.h"

namespace ossa::tracker {
namespace {

using test::Sized;

void ExpectSame(const float* c, const Eigen::Vector3d& position_m) {
  for (int i = 0; i < 3; ++i) EXPECT_EQ(c[i], static_cast<float>(position_m[i]));
}

void ExpectSame(const float* c, const Eigen::Quaterniond& wxyz) {
  const std::array values = {wxyz.w(), wxyz.x(), wxyz.y(), wxyz.z()};
  for (size_t i = 0; i < 4; ++i) EXPECT_EQ(c[i], static_cast<float>(values[i]));
}

void ExpectSameJoint(const ossa_joint& c, const JointEstimate& joint) {
  ExpectSame(c.position_m, joint.position_m);
  ExpectSame(c.orientation_wxyz, joint.orientation);
  EXPECT_EQ(c.confidence, static_cast<float>(joint.confidence));
  EXPECT_EQ(c.reliability, static_cast<float>(joint.reliability));
  EXPECT_EQ(c.state, static_cast<int32_t>(joint.state));
}

void ExpectSameBody(const ossa_body& c, const Body& body) {
  EXPECT_EQ(c.id, body.id);
  EXPECT_EQ(c.state, static_cast<int32_t>(body.state));
  ExpectSame(c.position_m, body.position_m);
  EXPECT_EQ(c.clipped_edges, body.clipped_edges);
  EXPECT_EQ(c.person_score, static_cast<float>(body.person_score));
  const recon::JointOrientations hierarchical = ComputeHierarchicalOrientations(body);
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    ExpectSameJoint(c.joints[j], body.joints[j]);
    ExpectSame(c.hierarchical_wxyz[j], hierarchical[j]);
    ExpectSame(c.raw_m[j], body.raw.posture.position_m[j]);
    ExpectSame(c.refined_m[j], body.refined->position_m[j]);
    ExpectSame(c.reconstructed_m[j], body.reconstructed.position_m[j]);
    EXPECT_EQ(c.bones_m[j], static_cast<float>((*body.bones_m)[j]));
  }
}

void ExpectSameFrame(const ossa_frame& c, const BodyFrame& frame) {
  EXPECT_EQ(c.index, frame.index);
  EXPECT_EQ(c.time_s, frame.time_s);
  ASSERT_EQ(c.has_floor, frame.floor ? 1 : 0);
  for (int i = 0; frame.floor && i < 4; ++i) {
    EXPECT_EQ(c.floor[i], static_cast<float>((*frame.floor)[i]));
  }
  EXPECT_EQ(c.tilt_down_rad, static_cast<float>(frame.tilt_down_rad.value_or(0.0)));
  EXPECT_TRUE(std::equal(frame.users.data.begin(), frame.users.data.end(), c.users));
  EXPECT_TRUE(std::equal(frame.parts.data.begin(), frame.parts.data.end(), c.parts));
}

// Two people, then nobody.
TEST(CInterface, ResultsEqualThoseOfTheCppInterface) {
  OSSA_NEEDS_MODEL();
  auto options = Sized<ossa_options>();
  options.parts = 1;
  ossa_tracker* in_c = ossa_tracker_create(&options);
  TrackerOptions same;
  same.keep_parts = true;
  Tracker tracker(same);
  int number = 0;
  for (const int people : {2, 2, 0}) {
    const std::vector<tests::CapsulePose> all = {PersonAt(-0.6, 2.5), PersonAt(0.6, 2.8)};
    const tests::CapsuleRender render = Rendered({all.begin(), all.begin() + people}, number++);
    const ossa_depth_image image = test::ImageOf(render.frame);
    auto c = Sized<ossa_frame>();
    ASSERT_EQ(ossa_tracker_track(in_c, &image, &c), OSSA_OK) << ossa_last_error();
    const BodyFrame frame = tracker.Track(render.frame);
    ExpectSameFrame(c, frame);
    ASSERT_EQ(c.body_count, people);
    ASSERT_EQ(frame.bodies.size(), static_cast<size_t>(people));
    for (int i = 0; i < people; ++i) {
      auto body = Sized<ossa_body>();
      ASSERT_EQ(ossa_tracker_body(in_c, i, &body), OSSA_OK) << ossa_last_error();
      ExpectSameBody(body, frame.bodies[static_cast<size_t>(i)]);
    }
  }
  ossa_tracker_destroy(in_c);
}

}  // namespace
}  // namespace ossa::tracker
