#include <gtest/gtest.h>

#include "recon/methods/reconstructor.h"
#include "recon/spectrum.h"
#include "tests/recon/synthetic_motion.h"

namespace ossa::recon {
namespace {

constexpr std::array<size_t, 3> kLeftArm = {5, 6, 7};

/// Sec. 5.2 written out: the nearest posture in the first seven principal components of the
/// database, the left arm of the query at the database's mean.
int MatchWithoutLeftArm(const PostureDatabase& database, const Posture& seen) {
  constexpr int kDimensions = 7;
  const Eigen::MatrixXd postures = database.postures().cast<double>();
  const Eigen::VectorXd mean = postures.rowwise().mean();
  const Eigen::MatrixXd centred = postures.colwise() - mean;
  const Eigen::MatrixXd projection =
      DecomposeSymmetric(Eigen::MatrixXd(centred * centred.transpose()))
          .vectors.rightCols(kDimensions)
          .transpose();
  Eigen::VectorXd query = ToVector(seen).cast<double>() - mean;
  for (const size_t joint : kLeftArm) query.segment<3>(FirstCoordinate(joint)).setZero();
  int best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < database.size(); ++i) {
    const double d = (projection * (centred.col(i) - query)).squaredNorm();
    if (d < least) least = d, best = i;
  }
  return best;
}

TEST(ShumHo2012, CompletesMissingJointsFromTheMatchedPostureAtOnce) {
  ReconstructorOptions options;
  options.method = "shum-ho-2012";
  auto clips = test::GestureClips();
  for (PostureClip& clip : clips) {
    // The right arm stays lower than the left one: else components come in pairs, and which of a
    // pair is the seventh is a matter of rounding.
    std::erase_if(clip.postures, [](const Posture& p) {
      return p[Joint::kElbowRight].y() > p[Joint::kShoulderRight].y() - 0.1;
    });
  }
  const auto database = std::make_shared<PostureDatabase>(PostureDatabase::Build(clips, {}));
  options.database = database;
  const auto method = MakeReconstructor(options);
  const Posture posture = test::Gesture(0.6, 1.1, 0.4, 0.3);
  TrackedPosture seen = test::AllTracked(test::InFrontOfCamera(posture));
  for (const size_t joint : {9U, 10U, 11U}) {  // guessed, which counts as seen
    seen.state[joint] = TrackingState::kInferred;
  }
  for (int f = 0; f < 10; ++f) method->Step({seen, f / 30.0, nullptr});
  for (const size_t joint : kLeftArm) {  // from this frame on
    seen.state[joint] = TrackingState::kNotTracked;
    seen.posture.position_m[joint].setZero();
  }
  const Posture made = method->Step({seen, 10 / 30.0, nullptr}).posture;
  Posture expected = posture;  // sec. 6.1, the arm hung on its shoulder
  const Posture matched = database->posture(MatchWithoutLeftArm(*database, posture));
  for (const size_t joint : kLeftArm) {
    expected.position_m[joint] =
        expected.position_m[joint - 1] + matched.position_m[joint] - matched.position_m[joint - 1];
  }
  expected = test::InFrontOfCamera(expected);
  for (size_t i = 0; i < kJointCount; ++i) {
    EXPECT_LT((made.position_m[i] - expected.position_m[i]).norm(), 1e-4) << kJointNames[i];
  }
}

}  // namespace
}  // namespace ossa::recon
