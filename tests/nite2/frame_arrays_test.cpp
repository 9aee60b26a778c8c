// Arrays of a frame of the C++ interface, over a stand-in for the C interface.
#include <gtest/gtest.h>

#include "tools/nite2/include/NiTE.h"

namespace {
int released = 0;
}

NiteStatus niteUserTrackerFrameAddRef(NiteUserTrackerHandle, NiteUserTrackerFrame*) {
  return NITE_STATUS_OK;
}
NiteStatus niteUserTrackerFrameRelease(NiteUserTrackerHandle, NiteUserTrackerFrame*) {
  ++released;
  return NITE_STATUS_OK;
}

namespace {

// Programs take the array once, before their loop.
TEST(FrameArrays, BelongToTheLastFrameRead) {
  NiteUserData first[1] = {}, second[2] = {};
  first[0].id = 1, second[0].id = 2, second[1].id = 3;
  NiteUserTrackerFrame frames[2] = {};
  frames[0].userCount = 1, frames[0].pUser = first;
  frames[1].userCount = 2, frames[1].pUser = second;
  nite::UserTrackerFrameRef frame;
  const nite::Array<nite::UserData>& users = frame.getUsers();
  EXPECT_TRUE(users.isEmpty());
  frame.setReference(nullptr, &frames[0]);
  ASSERT_EQ(users.getSize(), 1);
  EXPECT_EQ(users[0].getId(), 1);
  frame.setReference(nullptr, &frames[1]);
  ASSERT_EQ(users.getSize(), 2);
  EXPECT_EQ(users[1].getId(), 3);
  const nite::UserTrackerFrameRef copy = frame;
  EXPECT_EQ(copy.getUsers()[0].getId(), 2);
  frame.release();
  EXPECT_TRUE(users.isEmpty());
  EXPECT_EQ(copy.getUsers().getSize(), 2);
  EXPECT_EQ(released, 2);
}

}  // namespace
