// One test for each row of the README's table: what the skeleton stream of the Kinect for Windows
// SDK 1.8 gave, ossa::tracker gives.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "recon/orientation.h"
#include "tests/tools/tracker/tracked_scenes.h"

namespace ossa::tracker {
namespace {

using recon::Joint;
using recon::kJointCount;
using recon::TrackingState;
using tests::CapsulePose;
using tests::CapsuleRender;

std::vector<CapsulePose> SixPeople() {
  std::vector<CapsulePose> people;
  for (int i = 0; i < 6; ++i) people.push_back(PersonAt(-1.9 + 0.76 * i, i % 2 ? 4.2 : 3.6));
  return people;
}

BodyFrame TrackOnce(const TrackerOptions& options, const CapsuleRender& render) {
  return Tracker(options).Track(render.frame);
}

TEST(SdkConformance, UserImageHasTheBodyIdOfEachPixel) {
  OSSA_NEEDS_MODEL();
  const CapsuleRender render = Rendered({PersonAt(-0.6, 2.5), PersonAt(0.6, 2.8)});
  const BodyFrame bodies = TrackOnce(PlainOptions(), render);
  ASSERT_EQ(bodies.bodies.size(), 2U);
  ASSERT_EQ(bodies.users.data.size(), render.person.data.size());
  // Each true person's pixels carry one id; the soles sink into the floor's tolerance: 10 %.
  for (const int person : {1, 2}) {
    std::map<int, int> ids;
    int pixels = 0;
    for (size_t i = 0; i < render.person.data.size(); ++i) {
      if (render.person.data[i] != person) continue;
      ++pixels;
      ++ids[bodies.users.data[i]];
    }
    int most = 0;
    for (const auto& [id, count] : ids) most = id > 0 ? std::max(most, count) : most;
    EXPECT_GT(most, 0.9 * pixels) << "person " << person;
  }
}

// How many joints of a person are tracked within 15 cm of where they are: the forest knows bodies
// of flesh, and a capsule figure's joints are so right at best.
int CountJointsInPlace(const Body& body, const recon::Posture& truth) {
  int count = 0;
  for (size_t j = 0; j < kJointCount; ++j) {
    const double off_m = (body.raw.posture.position_m[j] - truth.position_m[j]).norm();
    count += body.raw.state[j] == TrackingState::kTracked && off_m < 0.15 ? 1 : 0;
  }
  return count;
}

TEST(SdkConformance, SixPeopleAreFullyTracked) {
  OSSA_NEEDS_MODEL();
  const CapsuleRender render = Rendered(SixPeople());
  const BodyFrame bodies = TrackOnce(PlainOptions(), render);
  ASSERT_EQ(bodies.bodies.size(), 6U);
  for (const recon::Posture& truth : render.joints) {
    int most = 0;
    for (const Body& body : bodies.bodies) most = std::max(most, CountJointsInPlace(body, truth));
    // Of the two at the image's borders an arm is cut off.
    EXPECT_GT(most, kJointCount / 2) << "person at x = " << truth.position_m[0].x();
  }
}

TEST(SdkConformance, TwentyJointsHaveStatesAndSeenOnesLieOnTheBody) {
  OSSA_NEEDS_MODEL();
  const CapsuleRender render = Rendered({PersonAt(0, 2.5)});
  const BodyFrame bodies = TrackOnce(PlainOptions(), render);
  ASSERT_EQ(bodies.bodies.size(), 1U);
  const recon::TrackedPosture& raw = bodies.bodies[0].raw;
  for (const Joint joint : {Joint::kHead, Joint::kShoulderCenter, Joint::kSpine}) {
    const auto j = recon::Index(joint);
    EXPECT_EQ(raw.state[j], TrackingState::kTracked) << recon::NameOf(joint);
    // The forest knows bodies of flesh: a capsule figure's joints are 15 cm right at best.
    EXPECT_LT((raw.posture[joint] - render.joints[0][joint]).norm(), 0.15) << recon::NameOf(joint);
  }
}

TEST(SdkConformance, RawReconstructedAndSmoothedAreAllReturned) {
  OSSA_NEEDS_MODEL();
  TrackerOptions options;
  options.smoothing = SmoothingPreset("default");
  Tracker tracker(options);
  BodyFrame bodies;
  for (int i = 0; i < 5; ++i) bodies = tracker.Track(Rendered({PersonAt(0.02 * i, 2.5)}, i).frame);
  ASSERT_EQ(bodies.bodies.size(), 1U);
  const Body& body = bodies.bodies[0];
  for (size_t j = 0; j < kJointCount; ++j) {
    EXPECT_TRUE(body.reconstructed.position_m[j].allFinite());
    EXPECT_TRUE(body.joints[j].position_m.allFinite());
    EXPECT_GT(body.joints[j].position_m.z(), 0.5) << "in front of the sensor";
  }
  EXPECT_NE(body.reconstructed[Joint::kHead], body.joints[Joint::kHead].position_m);
  EXPECT_NE(body.raw.posture[Joint::kHead], body.joints[Joint::kHead].position_m);
}

TEST(SdkConformance, BoneOrientationsAreAbsoluteAndHierarchical) {
  OSSA_NEEDS_MODEL();
  TrackerOptions options;
  const BodyFrame bodies = TrackOnce(options, Rendered({PersonAt(0, 2.5)}));
  ASSERT_EQ(bodies.bodies.size(), 1U);
  const Body& body = bodies.bodies[0];
  const auto absolute = recon::ToAbsolute(ComputeHierarchicalOrientations(body));
  for (size_t j = 1; j < kJointCount; ++j) {
    const auto parent = recon::ParentOf(j);
    const Eigen::Vector3d bone =
        (body.joints[j].position_m - body.joints[parent].position_m).normalized();
    // The SDK's convention: the bone is the y axis. Doubles through one product: 1e-9.
    EXPECT_LT((body.joints[j].orientation * Eigen::Vector3d::UnitY() - bone).norm(), 1e-9);
    EXPECT_LT(absolute[j].angularDistance(body.joints[j].orientation), 1e-6);
  }
}

struct EdgeCase {
  const char* name;
  double x_m, z_m;
  unsigned edge;
};
void PrintTo(const EdgeCase& edge, std::ostream* out) { *out << edge.name; }

class ClippedEdges : public testing::TestWithParam<EdgeCase> {};

TEST_P(ClippedEdges, AreTheBordersThatCutTheBody) {
  OSSA_NEEDS_MODEL();
  const BodyFrame bodies =
      TrackOnce(PlainOptions(), Rendered({PersonAt(GetParam().x_m, GetParam().z_m)}));
  ASSERT_EQ(bodies.bodies.size(), 1U);
  EXPECT_EQ(bodies.bodies[0].clipped_edges, GetParam().edge);
}

// At 2.5 m the image is 2.8 m wide: 1.25 m off the middle it cuts a shoulder. At 1.6 m it shows
// 0.67 m above and below the sensor; the person reaches from -1 to 0.75 m.
INSTANTIATE_TEST_SUITE_P(
    SdkConformance, ClippedEdges,
    testing::Values(EdgeCase{"none", 0, 3.2, 0}, EdgeCase{"left", 1.5, 3.2, kClippedLeft},
                    EdgeCase{"right", -1.5, 3.2, kClippedRight},
                    EdgeCase{"topAndBottom", 0, 1.6, kClippedTop | kClippedBottom}),
    [](const auto& info) { return info.param.name; });

TEST(SdkConformance, SeatedModeTracksTheTenUpperJoints) {
  OSSA_NEEDS_MODEL();
  TrackerOptions options = PlainOptions();
  options.mode = TrackingMode::kSeated;
  const BodyFrame bodies = TrackOnce(options, Rendered({PersonAt(0, 2.5)}));
  ASSERT_EQ(bodies.bodies.size(), 1U);
  int upper = 0;
  for (size_t j = 0; j < kJointCount; ++j) {
    const bool seated = IsSeatedJoint(static_cast<Joint>(j));
    upper += seated ? 1 : 0;
    if (!seated) {
      EXPECT_EQ(bodies.bodies[0].joints[static_cast<Joint>(j)].state, TrackingState::kNotTracked);
    }
  }
  EXPECT_EQ(upper, 10);
}

TEST(SdkConformance, ModesChangeWhileRunning) {
  OSSA_NEEDS_MODEL();
  Tracker tracker(PlainOptions());
  const CapsuleRender render = Rendered({PersonAt(0, 2.5)});
  const auto tracked = [&] {
    const BodyFrame bodies = tracker.Track(render.frame);
    return bodies.bodies.at(0).joints[Joint::kSpine].state;
  };
  EXPECT_NE(tracked(), TrackingState::kNotTracked);
  tracker.SetMode(TrackingMode::kSeated);
  EXPECT_EQ(tracked(), TrackingState::kNotTracked);
}

TEST(SdkConformance, NearRangeSeesPeopleWithinThreeMetresOnly) {
  OSSA_NEEDS_MODEL();
  TrackerOptions options = PlainOptions();
  options.near_range = true;
  EXPECT_EQ(TrackOnce(options, Rendered({PersonAt(-0.5, 2.2), PersonAt(0.6, 3.6)})).bodies.size(),
            1U);
  EXPECT_EQ(
      TrackOnce(PlainOptions(), Rendered({PersonAt(-0.5, 2.2), PersonAt(0.6, 3.6)})).bodies.size(),
      2U);
}

TEST(SdkConformance, UsersNotChosenHaveAPositionOnly) {
  OSSA_NEEDS_MODEL();
  Tracker tracker(PlainOptions());
  const std::vector<CapsulePose> people = {PersonAt(-0.6, 2.5), PersonAt(0.6, 2.8)};
  const BodyFrame first = tracker.Track(Rendered(people, 0).frame);
  ASSERT_EQ(first.bodies.size(), 2U);
  const int chosen = first.bodies[1].id;
  tracker.ChooseUsers({chosen});
  const BodyFrame second = tracker.Track(Rendered(people, 1).frame);
  ASSERT_EQ(second.bodies.size(), 2U);
  for (const Body& body : second.bodies) {
    EXPECT_EQ(body.state == BodyState::kTracked, body.id == chosen);
    // The middle of the seen surface lies within half a metre of the body's middle.
    EXPECT_NEAR(std::abs(body.position_m.x()), 0.6, 0.2);
    EXPECT_NEAR(body.position_m.z(), 2.6, 0.5);
  }
  tracker.ChooseAllUsers();
  for (const Body& body : tracker.Track(Rendered(people, 2).frame).bodies)
    EXPECT_EQ(body.state, BodyState::kTracked);
}

int IdAt(const BodyFrame& bodies, double x_m, double z_m) {
  for (const Body& body : bodies.bodies) {
    const Eigen::Vector3d head = body.raw.posture[Joint::kHead];
    if (std::hypot(head.x() - x_m, head.z() - z_m) < 0.4) return body.id;
  }
  return 0;
}

TEST(SdkConformance, TwoPeopleWhoPassEachOtherKeepTheirIds) {
  OSSA_NEEDS_MODEL();
  Tracker tracker(PlainOptions());
  int near_id = 0, far_id = 0;
  for (int i = 0; i <= 60; ++i) {  // two seconds, a metre a second, one passes 1.2 m behind
    const double way_m = -1.0 + i / 30.0;
    const BodyFrame bodies =
        tracker.Track(Rendered({PersonAt(way_m, 2.4), PersonAt(-way_m, 3.6)}, i).frame);
    EXPECT_LE(bodies.bodies.size(), 2U) << "frame " << i << ": nobody is cut in two";
    if (i != 0 && i != 60) continue;
    ASSERT_EQ(bodies.bodies.size(), 2U);
    if (i == 0) near_id = IdAt(bodies, way_m, 2.4), far_id = IdAt(bodies, -way_m, 3.6);
    ASSERT_NE(near_id, 0);
    ASSERT_NE(far_id, 0);
    EXPECT_EQ(IdAt(bodies, way_m, 2.4), near_id);
    EXPECT_EQ(IdAt(bodies, -way_m, 3.6), far_id);
  }
}

TEST(SdkConformance, APersonIsTrackedFromTheFirstFrameAndKeepsTheirIdOnReturn) {
  OSSA_NEEDS_MODEL();
  Tracker tracker(PlainOptions());
  const BodyFrame first = tracker.Track(Rendered({PersonAt(0, 2.5)}, 0).frame);
  ASSERT_EQ(first.bodies.size(), 1U);
  for (int i = 1; i < 20; ++i) EXPECT_TRUE(tracker.Track(Rendered({}, i).frame).bodies.empty());
  // A single look may leave doubts; four frames do not.
  BodyFrame back;
  for (int i = 20; i < 25; ++i) back = tracker.Track(Rendered({PersonAt(0.2, 2.5)}, i).frame);
  ASSERT_EQ(back.bodies.size(), 1U);
  EXPECT_EQ(back.bodies[0].id, first.bodies[0].id);
}

TEST(SdkConformance, FloorClipPlaneAndCameraTiltComeWithTheFrame) {
  OSSA_NEEDS_MODEL();
  tests::CapsuleScene scene;
  scene.people = {PersonAt(0, 2.8)};
  // The sensor looks down by 12 degrees: the floor's normal leans towards it.
  const double tilt_rad = 12.0 * std::numbers::pi / 180;
  const Eigen::Vector3d up(0, std::cos(tilt_rad), -std::sin(tilt_rad));
  scene.planes = {{up, 1.2}};
  const auto render = tests::Render(scene, depth::KinectV1Camera(320, 240));
  const BodyFrame bodies = TrackOnce(PlainOptions(), render);
  ASSERT_TRUE(bodies.floor.has_value());
  ASSERT_TRUE(bodies.tilt_down_rad.has_value());
  EXPECT_NEAR(bodies.floor->head<3>().norm(), 1.0, 1e-6);
  EXPECT_NEAR((*bodies.floor)[3], 1.2, 0.02);          // millimetre steps over metres of floor
  EXPECT_NEAR(*bodies.tilt_down_rad, tilt_rad, 0.01);  // half a degree
}

TEST(SdkConformance, DepthCameraAndSkeletonSpaceMapBothWays) {
  const depth::Camera camera = depth::KinectV1Camera(640, 480);
  for (const Eigen::Vector2d& pixel :
       {Eigen::Vector2d(0, 0), Eigen::Vector2d(639, 479), Eigen::Vector2d(123.25, 301.5)}) {
    for (const double depth_mm : {400.0, 2345.0, 8000.0}) {
      const Eigen::Vector3d p = depth::BackProject(camera, pixel.x(), pixel.y(), depth_mm);
      // A few roundings of doubles of size 1000.
      EXPECT_LT((depth::Project(camera, p) - pixel).norm(), 1e-9);
      EXPECT_NEAR(p.z() * 1000, depth_mm, 1e-9);
    }
  }
}

TEST(SdkConformance, TheSkeletonSpaceHasXToTheSensorsLeftAndYUp) {
  const depth::Camera camera = depth::KinectV1Camera(640, 480);
  EXPECT_GT(depth::BackProject(camera, 10, 240, 1000).x(), 0);
  EXPECT_GT(depth::BackProject(camera, 320, 10, 1000).y(), 0);
}

TEST(SdkConformance, NonFiniteTimesAreRefused) {
  OSSA_NEEDS_MODEL();
  Tracker tracker(PlainOptions());
  depth::DepthFrame frame = Rendered({}).frame;
  frame.time_s = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(tracker.Track(frame), InputError);
}

TEST(SdkConformance, InvalidCamerasAreRefused) {
  OSSA_NEEDS_MODEL();
  Tracker tracker(PlainOptions());
  depth::DepthFrame frame = Rendered({}).frame;
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const double f : {0.0, -287.5, kNan, std::numeric_limits<double>::infinity(), 1e-300}) {
    frame.camera.fx = f;
    EXPECT_THROW(tracker.Track(frame), InputError) << f;
  }
  frame.camera = depth::KinectV1Camera(320, 240);
  frame.camera.cy = kNan;
  EXPECT_THROW(tracker.Track(frame), InputError);
}

}  // namespace
}  // namespace ossa::tracker
