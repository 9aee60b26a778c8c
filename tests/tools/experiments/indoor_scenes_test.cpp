#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <stdexcept>
#include <vector>

#include "recon/motion/authored.h"
#include "tools/experiments/compare/metrics.h"
#include "tools/experiments/indoor_scenes/indoor_scenes_internal.h"
#include "tools/experiments/simulation/jobs.h"
#include "tools/tracker/tracker.h"

namespace ossa::tools {
namespace {

TEST(RunJobs, RunsEachJobOnce) {
  std::vector<std::atomic<int>> done(40);
  RunJobs(done.size(), 3, [&](size_t i) { ++done[i]; });
  for (const auto& count : done) EXPECT_EQ(count, 1);
}

TEST(RunJobs, RethrowsTheExceptionOfAJob) {
  const auto fail = [](size_t i) {
    if (i == 5) throw std::runtime_error("five");
  };
  EXPECT_THROW(RunJobs(40, 2, fail), std::runtime_error);
}

// Small images of all people in authored motion.
class InIndoorScenes : public testing::Test {
 protected:
  void SetUp() override {
    if (!recon::BodyIsFetched(recon::BodyFolder())) GTEST_SKIP() << "no body: tools/fetch_body";
    recon::AuthoredOptions options;
    options.variations = 1;
    clips_ = recon::AuthoredClips(options);
    model_ = std::make_unique<recon::BodyModel>(LoadFetchedBody());
    wardrobe_ = std::make_unique<recon::Wardrobe>(*model_);
  }
  IndoorSceneInputs Inputs() const {
    return {*model_, *wardrobe_, clips_, Split::kTest, 160, 120, 4};
  }

 private:
  std::vector<recon::MotionClip> clips_;
  std::unique_ptr<recon::BodyModel> model_;
  std::unique_ptr<recon::Wardrobe> wardrobe_;
};

TEST_F(InIndoorScenes, SameSeedGivesSameFramesWithAllPeople) {
  const IndoorSceneInputs inputs = Inputs();
  const IndoorScenario scenario{"two", 2, Furnishing::kFurnished};
  const LabelledFrame first = IndoorSceneRenderer(scenario, inputs, 3).RenderFrame(1);
  const LabelledFrame again = IndoorSceneRenderer(scenario, inputs, 3).RenderFrame(1);
  EXPECT_EQ(first.depth.depth_mm, again.depth.depth_mm);
  for (const int user : {1, 2})
    EXPECT_GT(std::count(first.users.data.begin(), first.users.data.end(), user), 200);
}

// At first a carried sensor is where a fixed one is; the person is still where the labels say.
TEST_F(InIndoorScenes, CarriedSensorSeesTheSameRoomFromElsewhere) {
  IndoorSceneInputs inputs = Inputs();
  const IndoorScenario scenario{"one", 1, Furnishing::kFurnished};
  IndoorSceneRenderer fixed(scenario, inputs, 3);
  inputs.carried = true;
  IndoorSceneRenderer carried(scenario, inputs, 3);
  EXPECT_EQ(carried.RenderFrame(0).depth.depth_mm, fixed.RenderFrame(0).depth.depth_mm);
  const LabelledFrame frame = carried.RenderFrame(3);
  EXPECT_NE(frame.depth.depth_mm, fixed.RenderFrame(3).depth.depth_mm);
  const Eigen::Vector3d spine_m = frame.bodies[0].joints_m[recon::Joint::kSpine];
  const Eigen::Vector2d pixel = depth::Project(frame.depth.camera, spine_m);
  EXPECT_EQ(frame.users.at(static_cast<int>(pixel.x()), static_cast<int>(pixel.y())), 1);
}

// Furniture that comes into view, or is seen from another place, has not walked in.
TEST_F(InIndoorScenes, CarriedSensorInARoomWithoutPeopleFindsNobody) {
  IndoorSceneInputs inputs = Inputs();
  inputs.width = 640;
  inputs.height = 480;
  inputs.frames = 60;
  inputs.carried = true;
  IndoorSceneRenderer renderer({"nobody", 0, Furnishing::kFurnished}, inputs, 1000);
  tracker::Tracker tracker;
  for (int64_t f = 0; f < renderer.size(); ++f)
    EXPECT_TRUE(tracker.Track(renderer.RenderFrame(f).depth).bodies.empty()) << f;
}

// Without the sofa the same seed has the same person before the same sensor.
TEST_F(InIndoorScenes, SofaInFrontHidesAtLeastAThirdOfThePerson) {
  const IndoorSceneInputs inputs = Inputs();
  for (const uint64_t seed : {1U, 2U, 3U, 4U, 5U, 6U}) {
    const auto seen = [&](Furnishing furnishing) {
      const LabelledFrame frame =
          IndoorSceneRenderer({"one", 1, furnishing}, inputs, seed).RenderFrame(0);
      return std::count(frame.users.data.begin(), frame.users.data.end(), 1);
    };
    const auto whole = seen(Furnishing::kEmpty), rest = seen(Furnishing::kSofaBefore);
    EXPECT_LE(3 * rest, 2 * whole) << seed;
    EXPECT_GT(rest, 20) << seed;  // a head, at least
  }
}

// One person 2 m away in a small image, tracked exactly at the truth.
struct OnePerson {
  OnePerson() {
    constexpr int kWidth = 80, kHeight = 60;
    truth.depth.camera = {kWidth, kHeight, 72, 72, 40, 30};
    truth.depth.depth_mm.assign(kWidth * kHeight, 2000);
    truth.users = {kWidth, kHeight, 1};
    answer.users = {kWidth, kHeight, 7};
    truth.bodies.resize(1);
    answer.bodies.resize(1);
    body().id = 7;
    for (size_t j = 0; j < recon::kJointCount; ++j) {
      const Eigen::Vector3d at_m(0.1 * static_cast<double>(j), 0, 2);
      person().visible[j] = true;
      person().joints_m.position_m[j] = at_m;
      body().raw.posture.position_m[j] = body().joints[j].position_m = at_m;
      body().raw.state[j] = body().joints[j].state = recon::TrackingState::kTracked;
      body().raw.confidence[j] = body().joints[j].confidence = 0.9;
    }
  }
  TruthBody& person() { return truth.bodies[0]; }
  tracker::Body& body() { return answer.bodies[0]; }
  IndoorScore Judged() const {
    IndoorEvaluator evaluator;
    evaluator.AddFrame(truth, answer);
    return evaluator.score;
  }

  LabelledFrame truth;
  tracker::BodyFrame answer;
};

// Every second joint is hidden and estimated a metre off.
TEST(IndoorEvaluator, ScoresVisibleJointsBesideAllJoints) {
  OnePerson one;
  for (size_t j = 1; j < recon::kJointCount; j += 2) {
    one.person().visible[j] = false;
    one.body().raw.posture.position_m[j].y() += 1.0;
  }
  const IndoorScore score = one.Judged();
  EXPECT_EQ(score.found, 1);
  EXPECT_DOUBLE_EQ(Measure(score.raw).map_10cm.value(), 0.5);
  EXPECT_DOUBLE_EQ(Measure(score.raw_seen).map_10cm.value(), 1.0);
}

// Joints that the forest did not find are missing in raw; final has placed them and is scored.
TEST(IndoorEvaluator, ScoresPlacedJointsThatAreNotTracked) {
  OnePerson one;
  for (size_t j = 1; j < recon::kJointCount; j += 2) {
    one.body().raw.state[j] = one.body().joints[j].state = recon::TrackingState::kNotTracked;
    one.body().raw.confidence[j] = one.body().joints[j].confidence = 0.0;
    one.body().joints[j].position_m.y() += 0.2;
  }
  const IndoorScore score = one.Judged();
  const ClipMetrics raw = Measure(score.raw), final = Measure(score.final);
  EXPECT_NEAR(raw.mean_joint_error_cm.value(), 0.0, 1e-9);
  EXPECT_DOUBLE_EQ(raw.map_10cm.value(), 0.5);
  EXPECT_NEAR(final.mean_joint_error_cm.value(), 10.0, 1e-9);
}

}  // namespace
}  // namespace ossa::tools
