// Uses of the C++ types that occur in public programs, over a stand-in for the C interface.
#include <gtest/gtest.h>

#include "tools/nite2/include/NiTE.h"

namespace {
int closed = 0;
int place = 0;  // a handle points somewhere
}  // namespace

NiteStatus niteInitializeUserTracker(NiteUserTrackerHandle* handle) {
  *handle = reinterpret_cast<NiteUserTrackerHandle>(&place);
  return NITE_STATUS_OK;
}
NiteStatus niteShutdownUserTracker(NiteUserTrackerHandle) {
  ++closed;
  return NITE_STATUS_OK;
}

namespace {

// ofxNiTE2 hands out its tracker by value; others assign a fresh one to it.
TEST(Trackers, AreClosedWithTheirLastCopy) {
  closed = 0;
  {
    nite::UserTracker tracker;
    ASSERT_EQ(tracker.create(), nite::STATUS_OK);
    { const nite::UserTracker copy = tracker; }
    EXPECT_EQ(closed, 0);
    EXPECT_TRUE(tracker.isValid());
    tracker = nite::UserTracker();
    EXPECT_EQ(closed, 1);
    EXPECT_FALSE(tracker.isValid());
  }
  EXPECT_EQ(closed, 1);
}

TEST(Trackers, AreClosedForAllCopiesByDestroy) {
  closed = 0;
  nite::UserTracker tracker;
  ASSERT_EQ(tracker.create(), nite::STATUS_OK);
  const nite::UserTracker copy = tracker;
  tracker.destroy();
  EXPECT_FALSE(copy.isValid());
  EXPECT_EQ(closed, 1);
}

// The Cinder block makes planes of its own.
TEST(PlanesAndBoxes, AreConstructedFromTwoPoints) {
  const nite::Plane plane(nite::Point3f(1, 2, 3), nite::Point3f(0, 1, 0));
  EXPECT_EQ(plane.point.z, 3);
  EXPECT_EQ(plane.normal.y, 1);
  const nite::BoundingBox box(nite::Point3f(1, 2, 0), nite::Point3f(3, 4, 0));
  EXPECT_EQ(box.max.x, 3);
  EXPECT_EQ(nite::BoundingBox().min.x, 0);
}

}  // namespace
