#include <gtest/gtest.h>

#include <algorithm>

#include "recon/methods/pose_graph_search_internal.h"
#include "recon/methods/posture_space_internal.h"
#include "recon/methods/reconstructor.h"
#include "recon/reliability.h"
#include "tests/recon/synthetic_motion.h"

namespace ossa::recon {
namespace {

std::unique_ptr<Reconstructor> Plantard2016() {
  static const auto database =
      std::make_shared<PostureDatabase>(PostureDatabase::Build(test::GestureClips(), {}));
  ReconstructorOptions options;
  options.method = "plantard-2016";
  options.database = database;
  return MakeReconstructor(options);
}

constexpr size_t kLeftHand = 7;

// Sc of sec. 6.1: for a hidden arm the similarity Ss is equal for all positions; continuity selects
// the last one.
TEST(Plantard2016, KeepsAHiddenArmAsItWas) {
  const auto method = Plantard2016();
  const Posture truth = test::InFrontOfCamera(test::Gesture(1.5, 0.5, 0.3));
  TrackedPosture seen = test::AllTracked(truth);
  for (int f = 0; f < 10; ++f) method->Step({seen, f / 30.0, nullptr});
  for (const size_t joint : {size_t{5}, size_t{6}, kLeftHand}) {
    seen.state[joint] = TrackingState::kNotTracked;
  }
  Posture made;
  for (int f = 10; f < 20; ++f) made = method->Step({seen, f / 30.0, nullptr}).posture;
  // The database's postures are 20 cm apart; hanging, the hand would be a metre away.
  EXPECT_LT((made.position_m[kLeftHand] - truth.position_m[kLeftHand]).norm(), 0.2);
}

// Sec. 6.2 searches the neighbours of the nodes used last; where none of them resembles what is
// seen any more, all nodes are searched at once (a departure). Two clips that no edge joins: arms
// hang, or are stretched above the head of a person who squats.
TEST(Plantard2016, FindsAPostureFarFromTheLastOneInOneFrame) {
  std::vector<PostureClip> clips(2);
  for (double more_rad = 0.0; more_rad < 0.8; more_rad += 0.05) {
    clips[0].postures.push_back(test::Gesture(more_rad, 0.1, 0.0));
    clips[1].postures.push_back(test::Gesture(2.2 + more_rad, 2.9, 0.0, 1.5));
  }
  ReconstructorOptions options;
  options.method = "plantard-2016";
  options.database = std::make_shared<PostureDatabase>(PostureDatabase::Build(clips, {}));
  options.local_pca.neighbours = 2;
  const auto method = MakeReconstructor(options);
  const Posture hanging = test::InFrontOfCamera(test::Gesture(0.1, 0.1, 0.0));
  const Posture raised = test::InFrontOfCamera(test::Gesture(2.6, 2.9, 0.0, 1.5));
  for (int f = 0; f < 10; ++f) method->Step({test::AllTracked(hanging), f / 30.0, nullptr});
  const Posture made = method->Step({test::AllTracked(raised), 10 / 30.0, nullptr}).posture;
  EXPECT_LT(test::MeanDistance_m(made, raised), 0.1);  // of half a metre
}

/// Section 6 written out for a person of the standard size, all of whose joints
/// are present: the postures of eq. 12 frame by frame, normalised.
class SectionSix {
 public:
  SectionSix(std::shared_ptr<const PostureDatabase> database, const LocalPcaOptions& options)
      : database_(std::move(database)), search_(database_), options_(options) {}

  PostureVector Step(const PostureVector& observed, const JointWeights& reliability, double dt_s) {
    PoseQuery query{observed, reliability, last_};
    if (last_ && before_last_) {
      *query.predicted += (*last_ - *before_last_) * static_cast<float>(dt_s / last_dt_s_);
    }
    last_dt_s_ = dt_s;
    std::vector<int> candidates = nodes_;
    for (const int node : nodes_) {
      const auto near = database_->neighbours(node);
      candidates.insert(candidates.end(), near.begin(), near.end());
    }
    std::sort(candidates.begin(), candidates.end());
    candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
    const auto k = static_cast<size_t>(options_.neighbours);
    nodes_ = (nodes_.empty() ? search_.SelectBestOfAll(query, k, {})
                             : search_.SelectBest(candidates, query, k))
                 .nodes;
    const PostureSpace space = MakePostureSpace(*database_, nodes_, options_.dimensions);
    LocalPcaOptions mean_control = options_;
    mean_control.control /= kJointCount;  // eq. 8 is a mean
    const EnergyInputs inputs{observed, reliability, database_->bone_lengths_m(), last_,
                              before_last_};
    const Eigen::VectorXf start =
        last_ ? space.Project(*last_) : Eigen::VectorXf(space.neighbours.col(0));
    before_last_ = last_;
    last_ = space.Posture(SearchCeres(space, inputs, mean_control, start).q);
    return *last_;
  }

 private:
  std::shared_ptr<const PostureDatabase> database_;
  PoseGraphSearch search_;
  LocalPcaOptions options_;
  std::vector<int> nodes_;
  std::optional<PostureVector> last_, before_last_;
  double last_dt_s_ = 0.0;
};

TEST(Plantard2016, IsSectionSixWrittenOut) {
  ReconstructorOptions options;
  options.method = "plantard-2016";
  const auto whole = PostureDatabase::Build(test::GestureClips(), {});
  options.database = std::make_shared<PostureDatabase>(whole.WithEdges(4));
  options.local_pca.solver = "ceres";
  options.local_pca.neighbours = 8;
  const auto method = MakeReconstructor(options);
  SectionSix expected(options.database, options.local_pca);
  ReliabilityEstimator reliability;
  double t = 0.0;
  for (int f = 0; f < 16; ++f) {
    const double dt_s = f % 2 == 0 ? 1.0 / 32 : 1.0 / 16;
    t += dt_s;
    const Posture posture = test::Motion(6.0 * t);  // 20 cm and more between frames
    TrackedPosture seen = test::AllTracked(test::InFrontOfCamera(posture));
    for (size_t i = 5; i < 8; ++i) {  // from the sixth frame on an arm is guessed
      if (f > 5) seen.state[i] = TrackingState::kInferred;
    }
    const JointWeights rate = reliability.Step(seen, nullptr, dt_s).rate;
    const Posture made = method->Step({seen, t, nullptr}).posture;
    const Posture wanted =
        test::InFrontOfCamera(ToPosture(expected.Step(ToVector(posture), rate, dt_s)));
    for (size_t i = 0; i < kJointCount; ++i) {
      ASSERT_LT((made.position_m[i] - wanted.position_m[i]).norm(), 2e-3) << f << " " << i;
    }
  }
}

}  // namespace
}  // namespace ossa::recon
