// When `best` uses the filter learned for a sensor, and when its two built-in ones.
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "recon/methods/reconstructor.h"
#include "tests/recon/noisy_sensor.h"

namespace ossa::recon {
namespace {

constexpr size_t kElbow = 5, kWrist = 6, kHand = 7;

enum Learned { kNothing, kOfThree, kOfOne };  // of one: influence weights of a bad sensor

std::shared_ptr<const LearnedModels> Models(const std::vector<PosturePair>& pairs) {
  LearnedModels made;
  made.filter = LinearFilter::Learn(pairs);
  return std::make_shared<const LearnedModels>(made);
}

/// Has learned only the filter of the sensor.
std::unique_ptr<Reconstructor> MakeBestOne(Learned learned) {
  static const auto three = Models(test::PairsOfPeople(3)), one = Models(test::PairsOfABadSensor());
  ReconstructorOptions options;
  if (learned != kNothing) options.learned = learned == kOfThree ? three : one;
  return MakeReconstructor(options);
}

using TimeOf = std::function<double(int frame)>;

struct Made {
  std::vector<Posture> now, revised;  // revised of the frame before
};

Made Follow(Learned learned, const std::vector<TrackedPosture>& seen, const TimeOf& time_s) {
  const auto method = MakeBestOne(learned);
  Made made;
  for (size_t f = 0; f < seen.size(); ++f) {
    made.now.push_back(method->Step({seen[f], time_s(static_cast<int>(f)), nullptr}).posture);
    const auto revised = method->Revised();
    made.revised.push_back(revised ? revised->posture : made.now.back());
  }
  return made;
}

std::vector<TrackedPosture> SeenBy(int person, int frames) {
  std::vector<TrackedPosture> seen;
  for (const Posture& posture : test::Seen(person, frames).seen) {
    seen.push_back(test::AllTracked(posture));
  }
  return seen;
}

double Regular(int frame) { return frame * test::kFrame_s; }

bool Same(const Posture& a, const Posture& b) { return a.position_m == b.position_m; }

TEST(LearnedFilter, ActsFromTheFourthFrameOn) {
  const auto seen = SeenBy(5, 12);
  const Made with = Follow(kOfThree, seen, Regular), without = Follow(kNothing, seen, Regular);
  for (size_t f = 0; f < seen.size(); ++f) {
    EXPECT_EQ(Same(with.now[f], without.now[f]), f < LinearFilter::kFewest) << f;
    EXPECT_EQ(Same(with.revised[f], without.revised[f]), f < LinearFilter::kFewest) << f;
  }
}

TEST(LearnedFilter, BeatsTheGenericFilterForADelayedSensor) {
  const auto seen = SeenBy(5, 200);
  const auto truth = test::Seen(5, 200).truth;
  std::array<double, 2> off_m{};
  for (const Learned learned : {kNothing, kOfThree}) {
    const Made made = Follow(learned, seen, Regular);
    for (size_t f = 30; f < seen.size(); ++f) {
      off_m[learned] += (made.revised[f].position_m[kHand] - truth[f - 1].position_m[kHand]).norm();
    }
  }
  EXPECT_LT(off_m[1], 0.8 * off_m[0]);
}

TEST(LearnedFilter, IsInactiveAtAnotherFrameRate) {
  const auto seen = SeenBy(5, 40);
  for (const double rate_hz : {15.0, 60.0}) {
    const TimeOf time_s = [rate_hz](int frame) { return frame / rate_hz; };
    const Made with = Follow(kOfThree, seen, time_s), without = Follow(kNothing, seen, time_s);
    for (size_t f = 0; f < seen.size(); ++f) {
      EXPECT_TRUE(Same(with.now[f], without.now[f])) << rate_hz << " " << f;
      EXPECT_TRUE(Same(with.revised[f], without.revised[f])) << rate_hz << " " << f;
    }
  }
}

TEST(LearnedFilter, RestartsAfterMissingFrames) {
  const auto seen = SeenBy(5, 40);
  constexpr int kGap = 20;
  for (const double gap_s : {0.1, 3.0}) {
    const TimeOf time_s = [gap_s](int f) { return Regular(f) + (f >= kGap ? gap_s : 0.0); };
    const Made with = Follow(kOfThree, seen, time_s), without = Follow(kNothing, seen, time_s);
    // Both go on from postures that differ by millimetres; no more than these is left of it.
    for (size_t f = kGap; f < kGap + LinearFilter::kFewest; ++f) {
      EXPECT_LT(test::MeanDistance_m(with.now[f], without.now[f]), 0.002) << gap_s << " " << f;
    }
    EXPECT_FALSE(
        Same(with.now[kGap + LinearFilter::kFewest], without.now[kGap + LinearFilter::kFewest]));
  }
}

/// Largest displacement of elbow and wrist if the hand is off by this much (or missing) in three
/// frames.
double ArmPulled_m(Learned learned, double hand_off_m) {
  const auto good = SeenBy(5, 60);
  const Made before = Follow(learned, good, Regular);
  constexpr size_t kBad = 40;
  auto seen = good;
  for (size_t f = kBad; f < kBad + 3; ++f) {
    seen[f].posture.position_m[kHand] += Eigen::Vector3d::Constant(hand_off_m);
  }
  const Made made = Follow(learned, seen, Regular);
  double worst_m = 0.0;
  for (size_t f = kBad; f < seen.size(); ++f) {
    for (const size_t joint : {kElbow, kWrist}) {
      const Eigen::Vector3d pulled =
          made.now[f].position_m[joint] - before.now[f].position_m[joint];
      worst_m = std::max(worst_m, pulled.norm());
    }
  }
  return worst_m;
}

TEST(LearnedFilter, JumpingOrLostHandDoesNotPullItsArm) {
  for (const double off_m : {0.6, std::numeric_limits<double>::quiet_NaN()}) {
    for (const Learned learned : {kOfThree, kOfOne}) {
      // Without, bones of constant length pull by up to 2 cm. A filter that took in half a metre in
      // one of its steps would move the wrist by more than that.
      EXPECT_LT(ArmPulled_m(learned, off_m), ArmPulled_m(kNothing, off_m) + 0.01)
          << off_m << " " << learned;
    }
  }
}

TEST(LearnedFilter, GeneralisesToAnotherPersonWithTheSameSensor) {
  const auto person = test::SeenBadly(5, 200);
  std::vector<TrackedPosture> seen;
  for (const Posture& posture : person.seen) seen.push_back(test::AllTracked(posture));
  std::array<double, 3> off_m{};
  for (const Learned learned : {kNothing, kOfOne}) {
    const Made made = Follow(learned, seen, Regular);
    for (size_t f = 30; f < seen.size(); ++f) {
      off_m[learned] += test::MeanDistance_m(made.revised[f], person.truth[f - 1]);
    }
  }
  EXPECT_LT(off_m[kOfOne], 0.95 * off_m[kNothing]);
}

}  // namespace
}  // namespace ossa::recon
