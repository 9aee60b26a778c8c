// More rows of the README's table: what every frame of the SDK's stream carries, whatever the
// people in it do.
#include <algorithm>
#include <set>

#include "recon/orientation.h"
#include "tests/tools/tracker/tracked_scenes.h"

namespace ossa::tracker {
namespace {

using recon::Joint;
using recon::kJointCount;

size_t At(Joint joint) { return recon::Index(joint); }

TEST(SdkConformance, FramesCarryNumberAndTimeOfTheirDepthFrame) {
  OSSA_NEEDS_MODEL();
  Tracker tracker(PlainOptions());
  for (const int number : {7, 8, 11}) {  // two frames were lost
    const auto render = Rendered({PersonAt(0, 2.5)}, number);
    const BodyFrame bodies = tracker.Track(render.frame);
    EXPECT_EQ(bodies.index, number);
    EXPECT_EQ(bodies.time_s, render.frame.time_s);
  }
}

TEST(SdkConformance, AnEmptyRoomGivesNoBodiesAndAnEmptyUserImage) {
  OSSA_NEEDS_MODEL();
  const BodyFrame bodies = Tracker(PlainOptions()).Track(Rendered({}).frame);
  EXPECT_TRUE(bodies.bodies.empty());
  EXPECT_TRUE(bodies.floor.has_value());
  ASSERT_EQ(bodies.users.data.size(), 320U * 240U);
  EXPECT_EQ(std::count(bodies.users.data.begin(), bodies.users.data.end(), 0), 320 * 240);
}

TEST(SdkConformance, TrackingIdsArePositiveUniqueAndNotReused) {
  OSSA_NEEDS_MODEL();
  Tracker tracker(PlainOptions());
  std::set<int> first;
  for (const Body& body :
       tracker.Track(Rendered({PersonAt(-0.6, 2.5), PersonAt(0.6, 2.8)}).frame).bodies)
    first.insert(body.id);
  ASSERT_EQ(first.size(), 2U);
  EXPECT_GT(*first.begin(), 0);
  // Ten seconds later somebody else is there: nobody is remembered for so long.
  for (const Body& body : tracker.Track(Rendered({PersonAt(0, 2.2)}, 300).frame).bodies)
    EXPECT_EQ(first.count(body.id), 0U);
}

TEST(SdkConformance, MaxUsersLimitsThePeopleAndKeepsTheFirst) {
  OSSA_NEEDS_MODEL();
  TrackerOptions options = PlainOptions();
  options.max_users = 1;
  Tracker tracker(options);
  const auto people = {PersonAt(-0.6, 2.5), PersonAt(0.6, 2.8)};
  const BodyFrame first = tracker.Track(Rendered(people, 0).frame);
  const BodyFrame second = tracker.Track(Rendered(people, 1).frame);
  ASSERT_EQ(first.bodies.size(), 1U);
  ASSERT_EQ(second.bodies.size(), 1U);
  EXPECT_EQ(second.bodies[0].id, first.bodies[0].id);
}

TEST(SdkConformance, JointsMapToTheirOwnersPixelsOfTheDepthImage) {
  OSSA_NEEDS_MODEL();
  const auto render = Rendered({PersonAt(-0.6, 2.5), PersonAt(0.6, 2.8)});
  const BodyFrame bodies = Tracker(PlainOptions()).Track(render.frame);
  ASSERT_EQ(bodies.bodies.size(), 2U);
  for (const Body& body : bodies.bodies) {
    for (const Joint joint : {Joint::kHead, Joint::kSpine, Joint::kShoulderCenter}) {
      const Eigen::Vector3d p = body.raw.posture.position_m[At(joint)];
      const Eigen::Vector2d pixel = depth::Project(render.frame.camera, p);
      const int u = static_cast<int>(std::lround(pixel.x()));
      const int v = static_cast<int>(std::lround(pixel.y()));
      EXPECT_EQ(bodies.users.at(u, v), body.id) << recon::NameOf(joint);
      // Joints lie inside the body, behind the surface that the pixel shows: by a trunk's radius.
      const double surface_m = depth::MetresFromMillimetres(render.frame.view().at(u, v));
      EXPECT_GT(p.z(), surface_m - 0.03) << recon::NameOf(joint);
      EXPECT_LT(p.z(), surface_m + 0.25) << recon::NameOf(joint);
    }
  }
}

TEST(SdkConformance, PositionIsTheCentroidOfTheUsersPixels) {
  OSSA_NEEDS_MODEL();
  const auto render = Rendered({PersonAt(0.4, 2.5)});
  const BodyFrame bodies = Tracker(PlainOptions()).Track(render.frame);
  ASSERT_EQ(bodies.bodies.size(), 1U);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double pixels = 0;
  for (int v = 0; v < 240; ++v) {
    for (int u = 0; u < 320; ++u) {
      if (bodies.users.at(u, v) == 0) continue;
      sum += depth::BackProject(render.frame.camera, u, v, render.frame.view().at(u, v));
      pixels += 1;
    }
  }
  // Found on every other pixel both ways: outlines weigh a little differently.
  EXPECT_LT((bodies.bodies[0].position_m - sum / pixels).norm(), 0.02);
}

TEST(SdkConformance, AHierarchicalOrientationIsRelativeToTheParentBone) {
  OSSA_NEEDS_MODEL();
  const BodyFrame bodies = Tracker(PlainOptions()).Track(Rendered({PersonAt(0, 2.5)}).frame);
  ASSERT_EQ(bodies.bodies.size(), 1U);
  const Body& body = bodies.bodies[0];
  // The person faces the sensor: out of the front is towards it, up is up, within 20 degrees
  // of what the forest makes of a capsule figure.
  const Eigen::Quaterniond player = body.joints[0].orientation;
  EXPECT_LT((player * Eigen::Vector3d::UnitZ()).z(), -0.94);
  EXPECT_GT((player * Eigen::Vector3d::UnitY()).y(), 0.94);
  for (size_t j = 1; j < kJointCount; ++j) {
    const auto parent = recon::ParentOf(j);
    const Eigen::Quaterniond turn =
        body.joints[parent].orientation.conjugate() * body.joints[j].orientation;
    // Unit quaternions through one product; arc cosines near 1 lose half the digits.
    EXPECT_LT(turn.angularDistance(ComputeHierarchicalOrientations(body)[j]), 1e-6)
        << "joint " << j;
  }
}

TEST(SdkConformance, SmoothingParametersChangeWhileRunning) {
  OSSA_NEEDS_MODEL();
  TrackerOptions options = PlainOptions();
  options.smoothing = SmoothingPreset("none");
  Tracker tracker(options);
  const auto smoothed_by_m = [&](int frame) {
    const BodyFrame bodies = tracker.Track(Rendered({PersonAt(0.03 * frame, 2.5)}, frame).frame);
    const Body& body = bodies.bodies.at(0);
    return (body.joints[Joint::kHead].position_m - body.reconstructed[Joint::kHead]).norm();
  };
  // But for the last bit of metres.
  for (int frame = 0; frame < 3; ++frame) EXPECT_NEAR(smoothed_by_m(frame), 0.0, 1e-15);
  tracker.SetSmoothing(SmoothingPreset("verysmooth"));
  smoothed_by_m(3);  // the filter starts with what it sees
  EXPECT_GT(smoothed_by_m(4), 1e-4);
}

}  // namespace
}  // namespace ossa::tracker
