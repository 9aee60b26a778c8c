// Cross-validation folds for learning a sensor's errors.
#include "recon/models/pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace ossa::recon {
namespace {

std::vector<PosturePair> PairsOf(const std::vector<int>& people, int each) {
  std::vector<PosturePair> pairs;
  for (const int person : people) {
    for (int i = 0; i < each; ++i) pairs.emplace_back().group = person;
  }
  return pairs;
}

TEST(AssignFolds, LeavesAPersonOutWithAllPairs) {
  const auto pairs = PairsOf({4, 9, 4, 2}, 10);
  const std::vector<int> fold = AssignFolds(pairs, 7);
  ASSERT_EQ(fold.size(), pairs.size());
  EXPECT_FALSE(OfOnePerson(pairs));
  for (size_t i = 0; i < pairs.size(); ++i) {
    for (size_t k = 0; k < pairs.size(); ++k) {
      EXPECT_EQ(fold[i] == fold[k], pairs[i].group == pairs[k].group) << i << " " << k;
    }
  }
}

TEST(AssignFolds, DistributesMorePeopleThanFoldsInTurn) {
  const std::vector<int> fold = AssignFolds(PairsOf({0, 1, 2, 3, 4}, 1), 2);
  EXPECT_EQ(fold, (std::vector<int>{0, 1, 0, 1, 0}));
}

TEST(AssignFolds, SplitsOnePersonIntoFourBlocksOfTimeWithGaps) {
  const auto pairs = PairsOf({3}, 400);
  EXPECT_TRUE(OfOnePerson(pairs));
  const std::vector<int> fold = AssignFolds(pairs, 7);
  // A block of 100 gives 5 pairs at either end to the gap there.
  for (const auto& [pair, expected] : {std::pair{0, 0},
                                       {94, 0},
                                       {96, kNoFold},
                                       {104, kNoFold},
                                       {105, 1},
                                       {194, 1},
                                       {299, kNoFold},
                                       {305, 3},
                                       {399, 3}}) {
    EXPECT_EQ(fold[static_cast<size_t>(pair)], expected) << pair;
  }
  EXPECT_EQ(std::set<int>(fold.begin(), fold.end()), (std::set<int>{kNoFold, 0, 1, 2, 3}));
}

TEST(AssignFolds, FewPairsStayInOrder) {
  for (size_t count = 0; count < 9; ++count) {
    std::vector<int> fold = AssignFolds(PairsOf({0}, static_cast<int>(count)), 7);
    EXPECT_EQ(fold.size(), count);
    std::erase(fold, kNoFold);
    EXPECT_TRUE(std::is_sorted(fold.begin(), fold.end())) << count;
  }
}

}  // namespace
}  // namespace ossa::recon
