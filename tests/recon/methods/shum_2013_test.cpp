#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>

#include "recon/database/nearest.h"
#include "recon/methods/bone_turns_internal.h"
#include "recon/methods/posture_space_internal.h"
#include "recon/methods/prepared_posture_internal.h"
#include "recon/methods/reconstructor.h"
#include "recon/orientation.h"
#include "recon/reliability.h"
#include "tests/recon/synthetic_motion.h"

namespace ossa::recon {
namespace {

// With a database of them.
ReconstructorOptions OfGestures() {
  ReconstructorOptions options;
  options.method = "shum-2013";
  options.database =
      std::make_shared<PostureDatabase>(PostureDatabase::Build(test::GestureClips(), {}));
  return options;
}

/// Mean error over a second of increasingly bad guesses for a stationary person, after two seconds
/// of good observations.
double ErrorWhileAllIsGuessed_m(const std::string& name) {
  ReconstructorOptions options;
  options.method = name;
  options.database =
      std::make_shared<PostureDatabase>(PostureDatabase::Build(test::GestureClips(), {}));
  const auto method = MakeReconstructor(options);
  const auto truth = [](int f) {
    return test::InFrontOfCamera(test::Motion(std::min(f, 60) / 30.0));
  };
  double sum_m = 0.0;
  for (int f = 0; f < 90; ++f) {
    TrackedPosture seen = test::AllTracked(truth(f));
    if (f >= 60) {
      seen.state.fill(TrackingState::kInferred);
      for (size_t i = 4; i < 12; ++i) seen.posture.position_m[i].y() += 0.01 * (f - 60);
    }
    const auto made = method->Step({seen, f / 30.0, nullptr});
    if (f >= 75) sum_m += test::MeanDistance_m(made.posture, truth(f)) / 15;
  }
  return sum_m;
}

TEST(Shum2013, HoldsThePostureWhileNothingIsReliable) {
  // As good as the database is: postures every 20 cm of the fastest joint.
  EXPECT_LT(ErrorWhileAllIsGuessed_m("shum-2013"), 0.06);
  EXPECT_LT(ErrorWhileAllIsGuessed_m("plantard-2016"), 0.06);
}

// Sec. VII-B: w_n = 1 / sum over i of R_i (p_i - p_i^n)^2, eq. 9.
TEST(InverseDistances, EqualEquation9) {
  const auto db = PostureDatabase::Build(test::GestureClips(), {});
  const PostureVector made = ToVector(test::Motion(0.7));
  JointWeights reliability;
  for (size_t i = 0; i < kJointCount; ++i) reliability[i] = 0.05 * static_cast<double>(i);
  const int neighbours[] = {0, 5, 17};
  const auto weights = InverseDistances(db, neighbours, made, reliability);
  for (size_t n = 0; n < 3; ++n) {
    const Posture other = db.posture(neighbours[n]);
    double d = 0.0;
    for (size_t i = 0; i < kJointCount; ++i) {
      const Eigen::Vector3d p = ToPosture(made).position_m[i];
      d += reliability[i] * (p - other.position_m[i]).squaredNorm();
    }
    EXPECT_NEAR(weights[n] * (d + 1e-4), 1.0, 1e-4);  // single precision
  }
}

/// Sections V-B and VI written out for a person of the standard size, all of whose joints are
/// present: the postures that minimise eq. 15 frame by frame, normalised.
class SectionsFiveAndSix {
 public:
  SectionsFiveAndSix(std::shared_ptr<const PostureDatabase> database, LocalPcaOptions options,
                     uint64_t seed)
      : database_(std::move(database)), options_(std::move(options)), seed_(seed) {}

  void Restart() { last_ = before_last_ = std::nullopt; }

  PostureVector Step(PostureVector observed, JointWeights reliability) {
    // Not in the paper: at rest while nothing is reliable.
    if (last_ && *std::max_element(reliability.begin(), reliability.end()) <= 0.05) {
      observed = *last_;
      before_last_ = last_;
      reliability.fill(1.0);
    }
    std::vector<int> nearest;
    for (const auto& n : NearestPostures(*database_, observed, reliability, options_.neighbours)) {
      nearest.push_back(n.index);
    }
    const PostureSpace space = MakePostureSpace(*database_, nearest, options_.dimensions);
    const EnergyInputs inputs{observed, reliability, database_->bone_lengths_m(), last_,
                              before_last_};
    const Eigen::VectorXf start =
        last_ ? space.Project(*last_) : Eigen::VectorXf(space.neighbours.col(0));
    before_last_ = last_;
    last_ = space.Posture(SearchStochastic(space, inputs, options_, start, seed_ + frame_++).q);
    return *last_;
  }

 private:
  std::shared_ptr<const PostureDatabase> database_;
  LocalPcaOptions options_;
  uint64_t seed_;
  uint64_t frame_ = 0;
  std::optional<PostureVector> last_, before_last_;
};

// With an arm guessed, everything guessed, and a gap of seconds; with reliabilities and without
// (method B).
TEST(Shum2013, IsSectionsFiveAndSixWrittenOut) {
  for (const bool use_reliability : {true, false}) {
    ReconstructorOptions options = OfGestures();
    options.local_pca.use_reliability = use_reliability;
    const auto method = MakeReconstructor(options);
    SectionsFiveAndSix expected(options.database, options.local_pca, options.seed);
    ReliabilityEstimator reliability;
    for (int f = 0; f < 36; ++f) {
      const double t = f / 30.0 + (f >= 30 ? 20.0 : 0.0);
      const Posture posture = test::Motion(f / 10.0);
      TrackedPosture seen = test::AllTracked(test::InFrontOfCamera(posture));
      for (size_t i = 0; i < kJointCount; ++i) {
        const bool arm = i >= 5 && i < 8;
        if ((arm && f >= 6) || (f >= 16 && f < 28)) seen.state[i] = TrackingState::kInferred;
      }
      if (f == 30) expected.Restart(), reliability.ForgetMotion();
      JointWeights weights = reliability.Step(seen, nullptr).rate;
      if (!use_reliability) weights.fill(1.0);
      const Posture made = method->Step({seen, t, nullptr}).posture;
      const Posture wanted =
          test::InFrontOfCamera(ToPosture(expected.Step(ToVector(posture), weights)));
      for (size_t i = 0; i < kJointCount; ++i) {
        ASSERT_LT((made.position_m[i] - wanted.position_m[i]).norm(), 5e-3) << f << " " << i;
      }
    }
  }
}

/// A database of the gestures, and of one more posture as the method would add it.
std::shared_ptr<const PostureDatabase> GesturesAnd(const TrackedPosture& seen) {
  auto database =
      std::make_shared<PostureDatabase>(PostureDatabase::Build(test::GestureClips(), {}));
  const Posture normalised = Person().Prepare({seen, 0.0, nullptr}).normalised;
  const Posture standard = Retargeted(normalised, database->bone_lengths_m());
  database->Add(ToVector(standard), ComputeOrientations(standard), "observed");
  return database;
}

// A posture that is seen again is not added again: a database that had it from the start gives the
// same. Copies of it would take the places of other neighbours.
TEST(Shum2013, AddsAPostureOnce) {
  Posture bowed = test::InFrontOfCamera(test::Motion(0.0));
  bowed[Joint::kHead] -= Eigen::Vector3d(0.0, 0.15, 0.15);
  const TrackedPosture seen = test::AllTracked(bowed);
  ReconstructorOptions options;
  options.method = "shum-2013";
  options.local_pca.extend_database = true;
  options.database = GesturesAnd(seen);
  const auto knows = MakeReconstructor(options);
  options.database =
      std::make_shared<PostureDatabase>(PostureDatabase::Build(test::GestureClips(), {}));
  const auto learns = MakeReconstructor(options);
  options.local_pca.extend_database = false;
  const auto neither = MakeReconstructor(options);
  double unlike_m = 0.0;
  for (int f = 0; f < 20; ++f) {
    const Posture one = knows->Step({seen, f / 30.0, nullptr}).posture;
    const Posture two = learns->Step({seen, f / 30.0, nullptr}).posture;
    unlike_m += test::MeanDistance_m(two, neither->Step({seen, f / 30.0, nullptr}).posture);
    for (size_t i = 0; i < kJointCount; ++i) ASSERT_EQ(one.position_m[i], two.position_m[i]) << f;
  }
  EXPECT_GT(unlike_m, 0.0) << "it is added";
}

/// The method, which adds unexpected postures to its database or not.
std::unique_ptr<Reconstructor> MakeExtending(bool extend) {
  ReconstructorOptions options = OfGestures();
  options.local_pca.extend_database = extend;
  return MakeReconstructor(options);
}

/// Mean angle between a method's orientations and what joints tell of them, of bones whose turn
/// joints tell well, after a second of postures that the database does not have and is extended by.
double TurnedApart_deg(bool extend) {
  const auto method = MakeExtending(extend);
  double sum_rad = 0.0;
  constexpr int kFrames = 30, kFrom = 15;
  for (int f = 0; f < kFrames; ++f) {
    Posture truth = test::Motion(f / 30.0);
    for (const Joint joint : {Joint::kAnkleLeft, Joint::kFootLeft}) {  // a shin held back
      truth[joint] += Eigen::Vector3d(0.0, 0.12, -0.35);
    }
    const auto made =
        method->Step({test::AllTracked(test::InFrontOfCamera(truth)), f / 30.0, nullptr});
    const auto told = ComputeOrientations(made.posture);
    for (const size_t bone : {1U, 2U, 4U, 8U, 13U, 17U}) {
      if (f >= kFrom) sum_rad += (*made.orientation)[bone].angularDistance(told[bone]);
    }
  }
  return sum_rad / (6.0 * (kFrames - kFrom)) * 180.0 / M_PI;
}

/// Mean error of the left shank, held back as no posture of the database has it, in the second half
/// of a second.
double ErrorOfAHeldBackShank_m(bool extend) {
  const auto method = MakeExtending(extend);
  double sum_m = 0.0;
  for (int f = 0; f < 30; ++f) {
    Posture truth = test::Gesture(0.3, 0.3, 0.2);
    for (const Joint joint : {Joint::kAnkleLeft, Joint::kFootLeft}) {
      truth[joint] += Eigen::Vector3d(0.0, 0.12, -0.29);
    }
    truth = test::InFrontOfCamera(truth);
    const Posture made = method->Step({test::AllTracked(truth), f / 30.0, nullptr}).posture;
    if (f >= 15) sum_m += (made[Joint::kAnkleLeft] - truth[Joint::kAnkleLeft]).norm() / 15;
  }
  return sum_m;
}

// Sec. IX: the system adapts to unexpected movements.
TEST(Shum2013, LearnsAPostureThatTheDatabaseLacks) {
  EXPECT_GT(ErrorOfAHeldBackShank_m(false), 0.1);
  EXPECT_LT(ErrorOfAHeldBackShank_m(true), 0.05);
}

// ... from correctly tracked postures only.
TEST(Shum2013, LearnsNothingFromGuessedPostures) {
  std::array<std::unique_ptr<Reconstructor>, 2> methods;
  for (const bool extend : {false, true}) methods[extend ? 1 : 0] = MakeExtending(extend);
  for (int f = 0; f < 30; ++f) {
    // The left arm is higher than in any posture of the database.
    TrackedPosture seen =
        test::AllTracked(test::InFrontOfCamera(test::Gesture(2.8, 0.3, 0.1 + 0.02 * f)));
    for (const Joint joint : {Joint::kElbowLeft, Joint::kWristLeft, Joint::kHandLeft}) {
      seen.state[Index(joint)] = TrackingState::kInferred;
    }
    const auto plain = methods[0]->Step({seen, f / 30.0, nullptr});
    const auto extended = methods[1]->Step({seen, f / 30.0, nullptr});
    for (size_t i = 0; i < kJointCount; ++i) {
      ASSERT_EQ(plain.posture.position_m[i], extended.posture.position_m[i]) << f;
    }
  }
}

TEST(Shum2013, AddedPosturesHaveOrientations) {
  EXPECT_LT(TurnedApart_deg(true), TurnedApart_deg(false) + 5.0);
}

/// Distance of the head from its observation, for a bow that is not in the database.
double ErrorOfABowedHead_m(bool keep_reliable) {
  ReconstructorOptions options = OfGestures();
  options.local_pca.keep_reliable = keep_reliable;
  const auto method = MakeReconstructor(options);
  Posture truth;
  ReconstructedPosture made;
  for (int f = 0; f < 10; ++f) {
    truth = test::Gesture(0.3, 0.3, 0.2);
    truth[Joint::kHead] += Eigen::Vector3d(0.0, -0.06, 0.15);
    truth = test::InFrontOfCamera(truth);
    made = method->Step({test::AllTracked(truth), f / 30.0, nullptr});
  }
  return (made.posture[Joint::kHead] - truth[Joint::kHead]).norm();
}

TEST(Shum2013, KeepsReliableJointsFarFromTheDatabase) {
  // The space of upright heads cannot bow one; a reliable head nearly stays.
  EXPECT_GT(ErrorOfABowedHead_m(false), 0.1);
  EXPECT_LT(ErrorOfABowedHead_m(true), 0.02);
}

}  // namespace
}  // namespace ossa::recon
