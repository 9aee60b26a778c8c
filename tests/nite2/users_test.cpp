#include "tools/nite2/users.h"

#include <gtest/gtest.h>

#include <vector>

namespace ossa::nite2 {
namespace {

tracker::BodyFrame FrameOf(const std::vector<int>& ids, double time_s) {
  tracker::BodyFrame frame;
  frame.time_s = time_s;
  for (const int id : ids) frame.bodies.emplace_back().id = id;
  return frame;
}

std::vector<int> StatesOf(const std::vector<NiteUserData>& users) {
  std::vector<int> states;
  for (const NiteUserData& user : users) states.push_back(user.state);
  return states;
}

struct UsersOverTime : testing::Test {
  std::vector<int> Step(const std::vector<int>& ids, double time_s) {
    return StatesOf(users.Step(FrameOf(ids, time_s), {}, {}, false));
  }
  Users users;
};

constexpr int kOutOfView = 0;
using States = std::vector<int>;

TEST_F(UsersOverTime, AreNewThenVisibleThenOutOfViewAndLostAfterTenSeconds) {
  EXPECT_EQ(Step({7}, 0.0), States{NITE_USER_STATE_NEW});
  EXPECT_EQ(Step({7}, 1.0), States{NITE_USER_STATE_VISIBLE});
  EXPECT_EQ(Step({}, 1.1), States{kOutOfView});
  EXPECT_EQ(Step({}, 11.0), States{kOutOfView});
  EXPECT_EQ(Step({}, 11.1), States{NITE_USER_STATE_LOST});
  EXPECT_EQ(Step({}, 11.2), States{});
}

TEST_F(UsersOverTime, AreOutOfViewInAFrameOfTheSameTime) {
  Step({7, 8}, 5.0);
  EXPECT_EQ(Step({8}, 5.0), (States{kOutOfView, NITE_USER_STATE_VISIBLE}));
}

}  // namespace
}  // namespace ossa::nite2
