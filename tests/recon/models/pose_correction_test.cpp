#include "recon/models/pose_correction.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "depth/base/error.h"
#include "recon/models/learned_models.h"
#include "tests/recon/synthetic_motion.h"
#include "tests/support/temporary_folder.h"

namespace ossa::recon {
namespace {

/// A sensor that sees the left hand too low when it is raised, or errs at random.
std::vector<PosturePair> Pairs(bool systematic) {
  std::mt19937_64 rng(11);
  std::normal_distribution<double> normal(0.0, 0.03);
  std::vector<PosturePair> pairs;
  for (int f = 0; f < 400; ++f) {
    PosturePair& pair = pairs.emplace_back();
    pair.observed = test::Motion(f / 10.0);
    pair.known.fill(1.0);
    for (const size_t hand : {size_t{7}, size_t{11}}) {
      const double height_m = pair.observed.position_m[hand].y();
      const Eigen::Vector3d random(normal(rng), normal(rng), normal(rng));
      pair.residual.position_m[hand] =
          systematic ? Eigen::Vector3d(0.0, 0.04 + 0.1 * height_m, 0.0) : random;
    }
  }
  return pairs;
}

/// Ratio of the left hand's mean error with correction to that without, on unseen postures.
double Left(const PoseCorrection& correction) {
  double before = 0.0, after = 0.0;
  for (int f = 0; f < 100; ++f) {
    const Posture seen = test::Motion(0.05 + f / 7.0);
    const Eigen::Vector3d truth(0.0, 0.04 + 0.1 * seen.position_m[7].y(), 0.0);
    before += truth.norm();
    after += (correction.Offsets(seen).position_m[7] - truth).norm();
  }
  return after / before;
}

TEST(PoseCorrection, CorrectsSystematicErrorsOfUnseenPostures) {
  auto pairs = Pairs(true);
  for (size_t i = 0; i < pairs.size(); ++i) pairs[i].group = static_cast<int>(4 * i / pairs.size());
  EXPECT_LT(Left(PoseCorrection::Learn(pairs)), 0.1);  // a noiseless linear law
}

TEST(PoseCorrection, HalvesCorrectionsLearnedFromOnePerson) {
  EXPECT_NEAR(Left(PoseCorrection::Learn(Pairs(true))), 0.5, 0.05);
}

TEST(PoseCorrection, IgnoresErrorsOfAPartOfARecording) {
  auto pairs = Pairs(true);
  for (size_t i = pairs.size() / 2; i < pairs.size(); ++i) {
    for (auto& p : pairs[i].residual.position_m) p = -p;
  }
  const PoseCorrection correction = PoseCorrection::Learn(pairs);
  // A block's neighbours err the other way as often as not: nothing holds for the block left out.
  EXPECT_LT(correction.Offsets(test::Motion(1.0)).position_m[7].norm(), 0.005);
}

TEST(PoseCorrection, IgnoresUnsystematicErrors) {
  const PoseCorrection correction = PoseCorrection::Learn(Pairs(false));
  for (int f = 0; f < 20; ++f) {
    // The held-out gain lets through less than a tenth of errors of 5 cm.
    EXPECT_LT(correction.Offsets(test::Motion(f / 3.0)).position_m[7].norm(), 0.005);
  }
}

TEST(PoseCorrection, CentresAreNotPosturesOfTheData) {
  const auto pairs = Pairs(true);
  const PoseCorrection correction = PoseCorrection::Learn(pairs);
  // Each is a mean of ten observations or more, and each observation is in one mean at most; every
  // pair is there twice, mirrored.
  ASSERT_GT(correction.centres.cols(), 0);
  EXPECT_LE(correction.centres.cols() * 10, static_cast<Eigen::Index>(2 * pairs.size()));
  for (const PosturePair& pair : pairs) {
    const Eigen::VectorXf feature = CorrectionFeature(pair.observed);
    for (Eigen::Index c = 0; c < correction.centres.cols(); ++c) {
      // Directions count 0.3 m a radian: no centre is a posture to within a third of a degree.
      EXPECT_GT((correction.centres.col(c) - feature).norm(), 0.002F);
    }
  }
}

TEST(PoseCorrection, IgnoresErrorsOfASinglePerson) {
  auto pairs = Pairs(true);
  for (size_t i = 0; i < pairs.size(); ++i) {
    PosturePair& pair = pairs[i];
    pair.group = static_cast<int>(4 * i / pairs.size());  // four people, two of them the other way
    for (auto& p : pair.residual.position_m) p *= pair.group % 2 == 0 ? 1.0 : -1.0;
  }
  const PoseCorrection correction = PoseCorrection::Learn(pairs);
  // Of the other three two err the other way: nothing holds for the person left out.
  EXPECT_LT(correction.Offsets(test::Motion(1.0)).position_m[7].norm(), 0.005);
}

// The ground truth's hand may be the tip of a stick.
TEST(LearnedModels, DropImplausibleBonesAndStayReadable) {
  auto pairs = Pairs(true);
  for (PosturePair& pair : pairs) {
    const Eigen::Vector3d bone_m = pair.observed.position_m[7] - pair.observed.position_m[6];
    pair.residual.position_m[7] = 0.7 * bone_m.normalized();
  }
  LearnOptions options;
  options.processes = false;
  const ossa::test::TemporaryFolder folder;
  LearnedModels::Learn(pairs, options).Save(folder / "models.ossagp");
  const auto read = LearnedModels::Load(folder / "models.ossagp").correction;
  EXPECT_EQ(read.proportions[7], 0.0);
  EXPECT_GT(read.proportions[6], 0.5);
}

TEST(LearnedModels, SurviveAFileAndTruncationIsRefused) {
  LearnOptions options;
  options.processes = false;
  const LearnedModels made = LearnedModels::Learn(Pairs(true), options);
  const ossa::test::TemporaryFolder folder;
  const auto path = folder / "models.ossagp";
  made.Save(path);
  const LearnedModels read = LearnedModels::Load(path);
  const Posture at = test::Motion(0.7);
  EXPECT_EQ(made.correction.Offsets(at).position_m[7], read.correction.Offsets(at).position_m[7]);
  EXPECT_EQ(made.correction.proportions, read.correction.proportions);
  std::filesystem::resize_file(path, std::filesystem::file_size(path) - 1);
  EXPECT_THROW(LearnedModels::Load(path), InputError);
}

}  // namespace
}  // namespace ossa::recon
