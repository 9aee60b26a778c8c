#include "recon/methods/pose_graph_search_internal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "tests/recon/synthetic_motion.h"

namespace ossa::recon {
namespace {

constexpr size_t kBest = 30;

/// Clips in which limbs and trunk swing, each with speeds and phases of its own.
std::vector<PostureClip> SwingingClips(int count, uint64_t seed) {
  std::mt19937_64 rng(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<PostureClip> clips;
  for (int c = 0; c < count; ++c) {
    std::array<double, 4> speed{}, phase{};
    for (double& s : speed) s = 0.3 + unit(rng);
    for (double& p : phase) p = 6.3 * unit(rng);
    clips.emplace_back().name = "swing " + std::to_string(c);
    for (int f = 0; f < 1000; ++f) {
      const auto swing = [&](size_t k) {
        return 0.5 + 0.5 * std::sin(phase[k] + speed[k] * f / 30.0);
      };
      clips.back().postures.push_back(
          test::Gesture(2.5 * swing(0), 2.5 * swing(1), 1.8 * swing(2), swing(3)));
    }
  }
  return clips;
}

std::shared_ptr<const PostureDatabase> Large() {
  static const auto made = std::make_shared<const PostureDatabase>(
      PostureDatabase::Build(SwingingClips(12, 7), {.threshold_m = 0.005, .most_edges = 16}));
  return made;
}

PoseQuery QueryFor(const Posture& posture) {
  JointWeights all;
  all.fill(1.0);
  const Placement placement = EstimatePlacement(posture, all, 0.0);
  PoseQuery query;
  query.observed = ToVector(Retargeted(Normalised(posture, placement), StandardBoneLengths()));
  query.reliability.fill(1.0);
  for (size_t i = 5; i < 8; ++i) query.reliability[i] = 0.1;  // an arm that is hardly seen
  return query;
}

PoseSelection ByBruteForce(const PoseGraphSearch& search, const PoseQuery& query) {
  std::vector<int> all(static_cast<size_t>(Large()->size()));
  std::iota(all.begin(), all.end(), 0);
  return search.SelectBest(all, query, kBest);
}

// Movements that the graph does not hold. What the way down misses is little beside what the best
// node is off: 15 % is where most nodes of the neighbourhood lie.
TEST(PoseGraphSearch, FindsNearlyTheOptimumOfBruteForce) {
  ASSERT_GT(Large()->size(), 5000);
  const PoseGraphSearch search(Large());
  double best_m = 0.0, found_m = 0.0;
  int same = 0, queries = 0;
  for (const PostureClip& clip : SwingingClips(3, 99)) {
    for (size_t f = 0; f < clip.postures.size(); f += 50, ++queries) {
      const PoseQuery query = QueryFor(clip.postures[f]);
      const auto brute = ByBruteForce(search, query),
                 found = search.SelectBestOfAll(query, kBest, {});
      ASSERT_EQ(found.nodes.size(), kBest);
      best_m += brute.similarity_m, found_m += found.similarity_m;
      same += brute.nodes.front() == found.nodes.front();
      EXPECT_GE(found.similarity_m, brute.similarity_m - 1e-9);
    }
  }
  EXPECT_LT(found_m, 1.15 * best_m);
  EXPECT_GT(same, queries * 3 / 4);
}

TEST(PoseGraphSearch, NeverReturnsWorseThanItsStart) {
  const PoseGraphSearch search(Large());
  const int node = 4321;
  PoseQuery query = QueryFor(Large()->posture(node));
  query.observed = Large()->postures().col(node);
  const auto found = search.SelectBestOfAll(query, kBest, std::array{node});
  EXPECT_EQ(found.nodes.front(), node);
  EXPECT_EQ(found.similarity_m, 0.0);
}

// Eqs. 6-7 written out: the weighted distances of reliable joints from what is seen, of the others
// from the prediction.
TEST(PoseGraphSearch, RanksByEquations6And7) {
  const auto small =
      std::make_shared<const PostureDatabase>(PostureDatabase::Build(test::GestureClips(), {}));
  PoseQuery query = QueryFor(test::Gesture(1.0, 0.2, 0.9));
  query.predicted = ToVector(test::Gesture(0.3, 0.8, 0.1, 0.5));
  for (size_t i = 0; i < kJointCount; ++i) {
    query.reliability[i] = 0.05 * static_cast<double>(i % 3);
  }
  std::vector<std::pair<double, int>> scores;
  for (int n = 0; n < small->size(); ++n) {
    const Posture node = small->posture(n);
    double score = 0.0;
    for (size_t i = 0; i < kJointCount; ++i) {
      const double r = query.reliability[i];
      score += r * (ToPosture(query.observed).position_m[i] - node.position_m[i]).norm();
      score += (1.0 - r) * (ToPosture(*query.predicted).position_m[i] - node.position_m[i]).norm();
    }
    scores.emplace_back(score, n);
  }
  std::sort(scores.begin(), scores.end());
  const auto found = PoseGraphSearch(small).SelectBestOfAll(query, kBest, {});
  ASSERT_EQ(found.nodes.size(), kBest);
  for (size_t k = 0; k < kBest; ++k) {
    // Single precision may exchange equals.
    const auto of_found = std::find_if(scores.begin(), scores.end(), [&](const auto& scored) {
      return scored.second == found.nodes[k];
    });
    EXPECT_NEAR(of_found->first, scores[k].first, 1e-4) << k;
  }
}

TEST(PoseGraphSearch, VisitsEveryNodeOfASmallGraph) {
  const auto small =
      std::make_shared<const PostureDatabase>(PostureDatabase::Build(test::GestureClips(), {}));
  const PoseGraphSearch search(small);
  std::vector<int> all(static_cast<size_t>(small->size()));
  std::iota(all.begin(), all.end(), 0);
  const PoseQuery query = QueryFor(test::Gesture(1.0, 0.2, 0.9));
  EXPECT_EQ(search.SelectBestOfAll(query, kBest, {}).nodes,
            search.SelectBest(all, query, kBest).nodes);
}

}  // namespace
}  // namespace ossa::recon
