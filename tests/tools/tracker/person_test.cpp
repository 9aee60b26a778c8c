#include <gtest/gtest.h>

#include "tools/tracker/person_internal.h"

namespace ossa::tracker {
namespace {

std::vector<int> IdsLeft(const std::vector<int>& in_view, double time_s) {
  std::map<int, Person> people;
  for (const auto& [id, seen_s] : {std::pair(1, 10.0), {2, 12.0}, {3, 17.0}}) {
    people[id].id = id;
    people[id].seen_s = seen_s;
  }
  DeleteGone(in_view, time_s, 5.0, people);
  std::vector<int> ids;
  for (const auto& [id, person] : people) ids.push_back(id);
  return ids;
}

TEST(Person, IsForgottenAfterAWhileOutOfView) {
  EXPECT_EQ(IdsLeft({}, 17.0), (std::vector<int>{2, 3}));
  EXPECT_EQ(IdsLeft({3}, 18.0), (std::vector<int>{3}));
}

// A loop or another file: the id may be given to anybody before that time comes again.
TEST(Person, IsForgottenOutOfViewWhenTimeGoesBack) {
  EXPECT_EQ(IdsLeft({3}, 11.0), (std::vector<int>{1, 3}));
  EXPECT_TRUE(IdsLeft({}, 0.0).empty());
}

TEST(Person, IsRememberedOutOfViewIfTimestampsJitter) {
  EXPECT_EQ(IdsLeft({}, 16.998), (std::vector<int>{2, 3}));
  EXPECT_EQ(IdsLeft({}, 16.994), (std::vector<int>{2}));
}

// Rounding makes steps of i / 5 a little longer or shorter.
TEST(Person, CountsAsSeenInThePreviousFrameAt5Hz) {
  const HoldOptions options;
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(IsRecent((i + 1) / 5.0 - i / 5.0, options)) << i;
  EXPECT_TRUE(IsRecent(0.0, options));
  EXPECT_FALSE(IsRecent(0.5, options));
  EXPECT_FALSE(IsRecent(-1.0, options));
}

}  // namespace
}  // namespace ossa::tracker
