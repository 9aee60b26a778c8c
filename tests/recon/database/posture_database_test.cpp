#include "recon/database/posture_database.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "depth/base/error.h"
#include "recon/database/nearest.h"
#include "recon/orientation.h"
#include "tests/recon/synthetic_motion.h"
#include "tests/support/temporary_folder.h"

namespace ossa::recon {
namespace {

double Distance(const PostureDatabase& db, int a, int b) {
  double largest = 0.0, sum = 0.0;
  for (size_t i = 0; i < kJointCount; ++i) {
    const double d2 = (db.posture(a).position_m[i] - db.posture(b).position_m[i]).squaredNorm();
    largest = std::max(largest, d2);
    sum += d2;
  }
  return std::sqrt(db.options().filter == DatabaseFilter::kMaxJoint ? largest : sum);
}

TEST(PostureDatabase, KeepsNoTwoPosturesNearerThanTheThreshold) {
  for (const auto filter : {DatabaseFilter::kMaxJoint, DatabaseFilter::kSumSquared}) {
    const auto db = PostureDatabase::Build(test::GestureClips(), {.filter = filter});
    ASSERT_GT(db.size(), 50);
    EXPECT_LT(db.size(), db.source_postures());
    for (int a = 0; a < db.size(); ++a) {
      for (int b = 0; b < a; ++b) EXPECT_GT(Distance(db, a, b), 0.2 - 1e-5);
    }
  }
}

// Sec. 5.1 of Shum & Ho 2012: place, heading and size of whoever was recorded are removed.
TEST(PostureDatabase, NormalisesPlaceHeadingAndSize) {
  const Posture posture = test::Gesture(0.4, 1.2, 0.5);
  PostureClip clip{"turned", {}, {}};
  clip.postures = {Placed(Retargeted(posture, ScaledBoneLengths(1.3)), {{0.5, 0.1, 3.0}, 1.1})};
  const auto db = PostureDatabase::Build({clip}, {});
  EXPECT_LT(test::MeanDistance_m(db.posture(0), posture), 1e-6);  // single precision
  const JointOrientations expected = ComputeOrientations(posture);
  for (size_t i = 1; i < kJointCount; ++i) {
    EXPECT_LT(db.orientations(0)[i].angularDistance(expected[i]), 1e-3) << i;
  }
}

// Below single precision all distances are 0, and one posture would be left; a file with a
// threshold of kilometres could not be read again.
TEST(PostureDatabase, RefusesThresholdsThatCannotFilter) {
  for (const double threshold_m : {0.0, -0.2, 1e-50, 2000.0, std::nan("")}) {
    EXPECT_THROW(PostureDatabase::Build(test::GestureClips(), {.threshold_m = threshold_m}),
                 InputError)
        << threshold_m;
  }
}

TEST(PostureDatabase, KeepsAPostureWithinTheThresholdOfEveryGivenOne) {
  const auto clips = test::GestureClips();
  const auto db = PostureDatabase::Build(clips, {});
  for (const PostureClip& clip : clips) {
    for (size_t f = 0; f < clip.postures.size(); f += 7) {
      double nearest = 1e9;
      for (int i = 0; i < db.size(); ++i) {
        double largest = 0.0;
        for (size_t j = 0; j < kJointCount; ++j) {
          const auto& p = clip.postures[f].position_m[j];
          largest = std::max(largest, (p - db.posture(i).position_m[j]).norm());
        }
        nearest = std::min(nearest, largest);
      }
      // The intra filter may drop a posture in favour of one that the inter filter drops in turn: 2
      // x 0.2.
      EXPECT_LT(nearest, 0.4);
    }
  }
}

TEST(PostureDatabase, EdgesAreSymmetricAndJoinNearNodes) {
  const auto db = PostureDatabase::Build(test::GestureClips(), {.most_edges = 10000});
  for (int i = 0; i < db.size(); ++i) {
    int near = 0;
    for (int j = 0; j < db.size(); ++j) {
      near += i != j && Distance(db, i, j) <= db.edge_threshold_m() ? 1 : 0;
    }
    EXPECT_NEAR(static_cast<double>(db.neighbours(i).size()), near, 1.0);  // ties by rounding
    for (const int j : db.neighbours(i)) {
      const auto back = db.neighbours(j);
      EXPECT_NE(std::find(back.begin(), back.end(), i), back.end());
    }
  }
}

// Plantard 2016 algorithm 1 and eq. 2 written out. One arm is raised and lowered, then the other:
// lowering adds no postures, but is no gap between those kept before and after it.
TEST(PostureDatabase, EdgesAreNoLongerThanStepsOfClips) {
  PostureClip clip;
  for (double lift = 0.0; lift < 1.5; lift += 0.04)
    clip.postures.push_back(test::Gesture(lift, 0.0, 0.1));
  for (double lift = 1.5; lift > 0.0; lift -= 0.04)
    clip.postures.push_back(test::Gesture(lift, 0.0, 0.1));
  for (double lift = 0.0; lift < 1.5; lift += 0.04)
    clip.postures.push_back(test::Gesture(0.0, lift, 0.1));
  Posture kept = clip.postures[0];
  std::vector<double> steps;
  for (const Posture& p : clip.postures) {
    double farthest = 0.0;  // eq. 1
    for (size_t j = 0; j < kJointCount; ++j) {
      farthest = std::max(farthest, (p.position_m[j] - kept.position_m[j]).norm());
    }
    if (farthest <= 0.2) continue;
    steps.push_back(farthest);
    kept = p;
  }
  double mean = 0.0, variance = 0.0;
  for (const double step : steps) mean += step / static_cast<double>(steps.size());
  for (const double step : steps)
    variance += std::pow(step - mean, 2) / static_cast<double>(steps.size());
  const auto db = PostureDatabase::Build({clip}, {});
  EXPECT_NEAR(db.edge_threshold_m(), mean + 2.0 * std::sqrt(variance), 1e-5);  // single precision
  EXPECT_LT(db.edge_threshold_m(), 0.3);  // the paper's is 0.25 m
}

TEST(PostureDatabase, CanBeFilteredAgainAndKeepsItsNearestEdges) {
  const auto db = PostureDatabase::Build(test::GestureClips(), {});
  const auto sparse = db.Filtered(0.4);
  EXPECT_LT(sparse.size(), db.size());
  for (int a = 0; a < sparse.size(); ++a) {
    for (int b = 0; b < a; ++b) EXPECT_GT(Distance(sparse, a, b), 0.4 - 1e-5);
  }
  const auto few = db.WithEdges(2);
  EXPECT_EQ(few.postures(), db.postures());
  for (int i = 0; i < db.size(); ++i) {
    const auto all = db.neighbours(i), two = few.neighbours(i);
    ASSERT_EQ(two.size(), std::min<size_t>(2, all.size()));
    for (size_t k = 0; k < two.size(); ++k) EXPECT_EQ(two[k], all[k]);
    for (size_t k = 1; k < all.size(); ++k) {
      EXPECT_LE(Distance(db, i, all[k - 1]), Distance(db, i, all[k]) + 1e-6);
    }
  }
}

TEST(PostureDatabase, KeepsAddedPosturesThatItsFilterWouldDrop) {
  for (const DatabaseFilter filter : {DatabaseFilter::kMaxJoint, DatabaseFilter::kSumSquared}) {
    DatabaseOptions options;
    options.filter = filter;
    const auto db = PostureDatabase::Build(test::GestureClips(), options);
    PostureVector moved = db.postures().col(7);
    EXPECT_TRUE(db.Has(moved));
    // Three joints by 15 cm each: 15 cm by the one distance, 26 by the other.
    for (const Joint joint : {Joint::kHead, Joint::kFootLeft, Joint::kFootRight}) {
      moved[FirstCoordinate(Index(joint)) + 2] -= 0.15F;
    }
    EXPECT_EQ(db.Has(moved), filter == DatabaseFilter::kMaxJoint);
  }
}

TEST(PostureDatabase, AddingPosturesMovesNoOthers) {
  auto db = PostureDatabase::Build(test::GestureClips(), {});
  const auto before = db;
  PostureVector bowed = db.postures().col(0);
  bowed[FirstCoordinate(Index(Joint::kHead)) + 2] += 0.3F;
  const JointOrientations turns = ComputeOrientations(ToPosture(bowed));
  db.Add(bowed, turns, "observed");
  const float* place = db.postures().data();
  for (int i = 1; i < before.size(); ++i) db.Add(bowed, turns, "observed");
  EXPECT_EQ(db.postures().data(), place);
  ASSERT_EQ(db.size(), 2 * before.size());
  EXPECT_EQ(db.postures().leftCols(before.size()), before.postures());
  EXPECT_EQ(db.postures().col(before.size()), bowed);
  EXPECT_EQ(db.clip_of(before.size()), "observed");
  EXPECT_TRUE(db.neighbours(before.size()).empty());
  for (size_t j = 0; j < kJointCount; ++j) {
    EXPECT_LT(db.orientations(before.size())[j].angularDistance(turns[j]), 1e-3);
  }
}

TEST(PostureDatabase, FileIsReadAndWrittenWithTheSameBytes) {
  const ossa::test::TemporaryFolder folder;
  const auto db = PostureDatabase::Build(test::GestureClips(), {});
  db.Save(folder / "a.ossadb");
  const auto again = PostureDatabase::Load(folder / "a.ossadb");
  EXPECT_EQ(again.size(), db.size());
  EXPECT_EQ(again.postures(), db.postures());
  EXPECT_EQ(again.clip_of(3), db.clip_of(3));
  again.Save(folder / "b.ossadb");
  std::ifstream a(folder / "a.ossadb", std::ios::binary), b(folder / "b.ossadb", std::ios::binary);
  const std::string bytes_a((std::istreambuf_iterator<char>(a)), {});
  const std::string bytes_b((std::istreambuf_iterator<char>(b)), {});
  EXPECT_EQ(bytes_a, bytes_b);
}

TEST(PostureDatabase, RefusesATruncatedAndADamagedFileByName) {
  const ossa::test::TemporaryFolder folder;
  PostureDatabase::Build(test::GestureClips(), {}).Save(folder / "a.ossadb");
  std::ifstream in(folder / "a.ossadb", std::ios::binary);
  const std::string whole((std::istreambuf_iterator<char>(in)), {});
  for (const size_t keep : {size_t{0}, size_t{7}, size_t{40}, whole.size() - 1}) {
    std::ofstream(folder / "bad.ossadb", std::ios::binary) << whole.substr(0, keep);
    try {
      PostureDatabase::Load(folder / "bad.ossadb");
      FAIL() << keep;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("bad.ossadb"), std::string::npos);
    }
  }
  std::string damaged = whole;
  damaged[whole.size() / 2] = static_cast<char>(damaged[whole.size() / 2] ^ 0x10);
  std::ofstream(folder / "bad.ossadb", std::ios::binary) << damaged;
  EXPECT_THROW(PostureDatabase::Load(folder / "bad.ossadb"), InputError);
}

TEST(NearestPostures, EqualBruteForceWithAndWithoutHints) {
  const auto db = PostureDatabase::Build(test::GestureClips(), {});
  JointWeights weights{};
  for (size_t i = 0; i < kJointCount; ++i) weights[i] = static_cast<double>(i % 3) / 2.0;
  std::vector<int> hints;
  for (double t = 0.0; t < 3.0; t += 0.1) {
    const PostureVector query = ToVector(test::Motion(t));
    std::vector<double> all;
    for (int i = 0; i < db.size(); ++i) {
      all.push_back(WeightedDistance(db.postures().col(i), query, weights));
    }
    std::sort(all.begin(), all.end());
    const auto nearest = NearestPostures(db, query, weights, 30, hints);
    ASSERT_EQ(nearest.size(), 30U);
    hints.clear();
    for (size_t k = 0; k < nearest.size(); ++k) {
      EXPECT_NEAR(nearest[k].distance, all[k], 1e-5);  // single precision sums of square metres
      hints.push_back(nearest[k].index);
    }
  }
}

}  // namespace
}  // namespace ossa::recon
