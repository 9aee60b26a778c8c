// Detection in a single image by the shipped forest, and by a pose network.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "recon/refine/pose_network.h"
#include "tests/recon/refine/pose_networks.h"
#include "tests/tools/tracker/tracked_scenes.h"
#include "tools/people/classify_candidates.h"
#include "tools/people/propose_candidates.h"

namespace ossa::tracker {
namespace {

// A network that expects the same error for every joint and input: 0.3 m times exp(`log`).
std::shared_ptr<const recon::PoseNetwork> NetworkOfError(float log) {
  auto layers = recon::test::SilentLayers();
  auto& votes = layers.back().bias;
  for (Eigen::Index joint = 0; joint < votes.size() / 5; ++joint) votes[5 * joint + 4] = log;
  return std::make_shared<const recon::PoseNetwork>(std::move(layers), 1, "test");
}

BodyFrame TrackFirstFrame(std::shared_ptr<const recon::PoseNetwork> network,
                          const depth::DepthFrame& frame) {
  TrackerOptions options;
  options.mount = Mount::kLevel;
  options.models = ModelSet::Shipped(options.method);
  options.models->pose_network = std::move(network);
  return Tracker(options).Track(frame);
}

TEST(FirstFrame, PersonRejectedByThePoseNetworkIsNotAccepted) {
  OSSA_NEEDS_MODEL();
  const depth::DepthFrame frame = Rendered({PersonAt(0, 2.5)}).frame;
  EXPECT_EQ(TrackFirstFrame(nullptr, frame).bodies.size(), 1U);
  EXPECT_EQ(TrackFirstFrame(NetworkOfError(-2.0F), frame).bodies.size(), 1U);
  const BodyFrame unknown = TrackFirstFrame(NetworkOfError(1.0F), frame);
  EXPECT_TRUE(unknown.bodies.empty());
  EXPECT_TRUE(std::ranges::any_of(unknown.decisions.candidates, [](const auto& decision) {
    return decision.rule == people::Rule::kFirstLook && decision.area_m2 > 0.3;
  }));
}

// Only the legs of somebody 4 m away, who stepped into a room that was empty for 25 frames.
TEST(FirstFrame, NewcomerWhomTheForestDoubtsIsDecidedByThePoseNetwork) {
  OSSA_NEEDS_MODEL();
  constexpr double kFar_m = 4.0, kCut_m = -0.15;  // below the camera
  const depth::DepthFrame empty = Rendered({}).frame;
  depth::DepthFrame legs = Rendered({PersonAt(0, kFar_m)}).frame;
  for (size_t i = 0; i < legs.depth_mm.size(); ++i) {
    const int v = static_cast<int>(i) / legs.camera.width;
    if (-kFar_m * (v - legs.camera.cy) / legs.camera.fy > kCut_m)
      legs.depth_mm[i] = empty.depth_mm[i];
  }
  const auto bodies = [&](std::shared_ptr<const recon::PoseNetwork> network) {
    TrackerOptions options;
    options.mount = Mount::kLevel;
    options.turn = Turn::kNone;
    options.models = ModelSet::Shipped(options.method);
    options.models->pose_network = std::move(network);
    Tracker tracker(options);
    depth::DepthFrame frame = empty;
    for (frame.index = 0; frame.index < 25; ++frame.index) {
      frame.time_s = static_cast<double>(frame.index) / 30.0;
      tracker.Track(frame);
    }
    legs.time_s = static_cast<double>(frame.index) / 30.0;
    return tracker.Track(legs).bodies.size();
  };
  EXPECT_EQ(bodies(nullptr), 0U);
  EXPECT_EQ(bodies(NetworkOfError(1.0F)), 0U);
  EXPECT_GT(bodies(NetworkOfError(-2.0F)), 0U);
}

// The network estimates the same joints for either half.
TEST(FirstFrame, PersonDividedByAPoleIsOneBody) {
  OSSA_NEEDS_MODEL();
  const auto network = ModelSet::Shipped(TrackerOptions{}.method).pose_network;
  for (const double half_m : {0.02, 0.04}) {  // of the pole's width
    depth::DepthFrame frame = Rendered({PersonAt(0, 2.5)}).frame;
    for (size_t i = 0; i < frame.depth_mm.size(); ++i) {
      const int u = static_cast<int>(i) % frame.camera.width;
      const double x_m = 1.8 * (u - frame.camera.cx) / frame.camera.fx;
      if (std::abs(x_m) < half_m) frame.depth_mm[i] = 1800;
    }
    const BodyFrame seen = TrackFirstFrame(network, frame);
    ASSERT_EQ(seen.bodies.size(), 1U) << half_m;
    EXPECT_LT(std::abs(seen.bodies[0].position_m.x()), 0.05) << half_m;
  }
}

// Head and trunk to the waist, with an arm-wide occluder across the chest.
depth::DepthFrame PersonBehindAnArm() {
  depth::DepthFrame frame = Rendered({PersonAt(0, 1.2)}).frame;
  const depth::Camera& camera = frame.camera;
  for (int v = 0; v < camera.height; ++v) {
    const double y_m = -1.2 * (v - camera.cy) / camera.fy;
    for (int u = 0; u < camera.width; ++u) {
      uint16_t& depth_mm = frame.depth_mm[static_cast<size_t>(v * camera.width + u)];
      if (depth_mm > 1600 || y_m < -0.2) depth_mm = 0;
      if (depth_mm > 0 && y_m > 0.1 && y_m < 0.25) depth_mm = 900;
    }
  }
  return frame;
}

TEST(FirstFrame, PersonDividedByAnArmIsOneBody) {
  OSSA_NEEDS_MODEL();
  const auto network = ModelSet::Shipped(TrackerOptions{}.method).pose_network;
  const BodyFrame seen = TrackFirstFrame(network, PersonBehindAnArm());
  ASSERT_EQ(seen.bodies.size(), 1U);
  EXPECT_GT(seen.bodies[0].person_score, people::InitiationOptions{}.person_by_pose_score);
  int joined = 0;
  for (const people::Decision& decision : seen.decisions.candidates) {
    joined += decision.rule == people::Rule::kJoinedPieces ? 1 : 0;
    const bool is_part = decision.rule == people::Rule::kMerged;
    EXPECT_TRUE(!is_part || decision.score < 0.1) << decision.score;
  }
  EXPECT_EQ(joined, 1);
}

// A person, and at the height of their hips objects at the same depth that reach so far to either
// side: one connected region.
depth::DepthFrame PersonBetweenThings(double reach_m) {
  depth::DepthFrame frame = Rendered({PersonAt(0, 2.5)}).frame;
  const depth::Camera& camera = frame.camera;
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const double x_m = -2.4 * (u - camera.cx) / camera.fx,
                   y_m = -2.4 * (v - camera.cy) / camera.fy;
      if (std::abs(x_m) > reach_m || y_m > -0.5 || y_m < -0.8) continue;
      const double z_m = 2.5 + 0.05 * std::sin(11 * x_m) * std::cos(9 * y_m);  // no plane
      uint16_t& depth_mm = frame.depth_mm[static_cast<size_t>(v * camera.width + u)];
      depth_mm = std::min(depth_mm, static_cast<uint16_t>(1000 * z_m));
    }
  }
  return frame;
}

// The largest segment of the last classification, where crops around heads need such a score.
// `tracks`: of the frame before, where all candidates continue the first; `is_likely`: all hold
// what seemed a person in the frame before. Without either it is the first frame.
people::Detection LargestPiece(depth::DepthFrame frame, double head_piece_score,
                               const std::vector<people::Track>& tracks = {},
                               bool is_likely = false) {
  const bool is_later = is_likely || !tracks.empty();
  const ModelSet models = ModelSet::Shipped(TrackerOptions{}.method);
  const auto targets = people::FindJointTargets(*models.forest, models.forest_file);
  const auto network = NetworkOfError(tracks.empty() ? -2.0F : 1.0F);
  people::PeopleOptions options;
  options.classification.head_piece_score = head_piece_score;
  depth::SceneState state;
  depth::Scene scene = depth::MeasureScene(frame, state, options.scene);
  auto proposed = people::ProposeCandidates(frame, scene, {}, options.association.reidentify,
                                            options.candidates, false);
  if (is_later) {
    frame.time_s += 1.0 / 30.0;
    scene = depth::MeasureScene(frame, state, options.scene);
    for (people::Candidate& candidate : proposed.candidates) {
      candidate.track = tracks.empty() ? -1 : 0;
      candidate.holds_likely_person = is_likely;
    }
  }
  std::vector<people::Decision> decided;
  const auto detections = people::ClassifyCandidates(
      {{*models.forest, targets, network.get()}, frame, scene, tracks, options},
      std::move(proposed.candidates), decided);
  return *std::ranges::max_element(detections, {}, [](const people::Detection& detection) {
    return detection.candidate.region.area_m2;
  });
}

constexpr double kNever = 1.1;  // a score above all
constexpr double kNeeded = people::ClassificationOptions{}.head_piece_score;

double Width_m(const people::Detection& detection) {
  const auto& region = detection.candidate.region;
  return region.high_m.x() - region.low_m.x();
}

TEST(FirstFrame, RejectedCandidateIsCroppedAroundItsHead) {
  OSSA_NEEDS_MODEL();
  const depth::DepthFrame frame = PersonBetweenThings(1.0);
  const people::Detection whole = LargestPiece(frame, kNever), cut = LargestPiece(frame, kNeeded);
  EXPECT_GT(Width_m(whole), 1.8);
  EXPECT_LT(whole.score, people::InitiationOptions{}.person_by_pose_score);
  EXPECT_LT(Width_m(cut), 1.5);
  EXPECT_GE(cut.evidence.score, kNeeded);
}

// The connected region includes the objects in later frames, too.
TEST(FirstFrame, ATrackWithALowScoreIsCroppedAroundItsHeadInLaterFrames) {
  OSSA_NEEDS_MODEL();
  people::Track track;
  track.score = 0.9;
  track.age = 1;
  const depth::DepthFrame frame = PersonBetweenThings(1.4);
  const people::Detection whole = LargestPiece(frame, kNever, {track});
  const people::Detection cut = LargestPiece(frame, kNeeded, {track});
  EXPECT_GT(Width_m(whole), 2.6);
  EXPECT_LT(whole.evidence.score, people::InitiationOptions{}.person_by_pose_score);
  EXPECT_LT(Width_m(cut), 1.5);
  EXPECT_GE(cut.evidence.score, kNeeded);
}

// What scored like a person a moment ago may have touched the objects since.
TEST(FirstFrame, WhoSeemedAPersonIsCroppedAroundTheirHeadInLaterFrames) {
  OSSA_NEEDS_MODEL();
  const depth::DepthFrame frame = PersonBetweenThings(1.0);
  const people::Detection whole = LargestPiece(frame, kNever, {}, true);
  const people::Detection cut = LargestPiece(frame, kNeeded, {}, true);
  EXPECT_GT(Width_m(whole), 1.8);
  EXPECT_LT(Width_m(cut), 1.5);
  EXPECT_GE(cut.evidence.score, kNeeded);
}

// In the first frame too little of them is visible; later they do not stand out from the room.
TEST(FirstFrame, WhoWasNotFoundIsSearchedAgainWhileNobodyIsTracked) {
  OSSA_NEEDS_MODEL();
  TrackerOptions options;
  options.turn = Turn::kNone;
  Tracker tracker(options);
  depth::DepthFrame frame = PersonBehindAnArm();
  const depth::DepthFrame whole = frame;
  for (size_t i = 0; i < frame.depth_mm.size() / 2; ++i) frame.depth_mm[i] = 0;
  EXPECT_EQ(tracker.Track(frame).bodies.size(), 0U);
  size_t bodies = 0;
  for (int f = 1; f <= 75; ++f) {
    frame = whole;
    frame.index = f;
    frame.time_s = f / 30.0;
    bodies = tracker.Track(frame).bodies.size();
  }
  EXPECT_EQ(bodies, 1U);
}

}  // namespace
}  // namespace ossa::tracker
