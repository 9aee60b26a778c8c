// The layouts that programs were compiled with (x86-64), as the PyPI package openni 2.3.0 declares
// them in openni/_nite2.py.
#include <NiteCTypes.h>

#include <cstddef>

namespace {

static_assert(sizeof(NitePoint3f) == 12 && offsetof(NitePoint3f, z) == 8);
static_assert(sizeof(NiteQuaternion) == 16 && offsetof(NiteQuaternion, w) == 12);
static_assert(sizeof(NiteSkeletonJoint) == 40 && offsetof(NiteSkeletonJoint, position) == 4 &&
              offsetof(NiteSkeletonJoint, positionConfidence) == 16 &&
              offsetof(NiteSkeletonJoint, orientation) == 20 &&
              offsetof(NiteSkeletonJoint, orientationConfidence) == 36);
static_assert(sizeof(NiteBoundingBox) == 24 && offsetof(NiteBoundingBox, max) == 12);
static_assert(sizeof(NitePoseData) == 8 && offsetof(NitePoseData, state) == 4);
static_assert(sizeof(NiteSkeleton) == 608 && offsetof(NiteSkeleton, state) == 600 &&
              offsetof(NiteSkeleton, internalState) == 604);
static_assert(sizeof(NiteUserData) == 668 && offsetof(NiteUserData, boundingBox) == 4 &&
              offsetof(NiteUserData, centerOfMass) == 28 && offsetof(NiteUserData, state) == 40 &&
              offsetof(NiteUserData, skeleton) == 44 && offsetof(NiteUserData, poses) == 652);
static_assert(sizeof(NiteUserMap) == 24 && offsetof(NiteUserMap, width) == 8 &&
              offsetof(NiteUserMap, height) == 12 && offsetof(NiteUserMap, stride) == 16);
static_assert(sizeof(NitePlane) == 24 && offsetof(NitePlane, normal) == 12);
static_assert(sizeof(NiteUserTrackerFrame) == 88 && offsetof(NiteUserTrackerFrame, pUser) == 8 &&
              offsetof(NiteUserTrackerFrame, userMap) == 16 &&
              offsetof(NiteUserTrackerFrame, pDepthFrame) == 40 &&
              offsetof(NiteUserTrackerFrame, timestamp) == 48 &&
              offsetof(NiteUserTrackerFrame, frameIndex) == 56 &&
              offsetof(NiteUserTrackerFrame, floorConfidence) == 60 &&
              offsetof(NiteUserTrackerFrame, floor) == 64);
static_assert(sizeof(NiteHandData) == 20 && offsetof(NiteHandData, position) == 4 &&
              offsetof(NiteHandData, state) == 16);
static_assert(sizeof(NiteGestureData) == 20 && offsetof(NiteGestureData, currentPosition) == 4 &&
              offsetof(NiteGestureData, state) == 16);
static_assert(sizeof(NiteHandTrackerFrame) == 56 && offsetof(NiteHandTrackerFrame, pHands) == 8 &&
              offsetof(NiteHandTrackerFrame, gestureCount) == 16 &&
              offsetof(NiteHandTrackerFrame, pGestures) == 24 &&
              offsetof(NiteHandTrackerFrame, pDepthFrame) == 32 &&
              offsetof(NiteHandTrackerFrame, timestamp) == 40 &&
              offsetof(NiteHandTrackerFrame, frameIndex) == 48);
static_assert(sizeof(NiteUserTrackerCallbacks) == 8 && sizeof(NiteHandTrackerCallbacks) == 8);
static_assert(sizeof(NiteVersion) == 16 && offsetof(NiteVersion, build) == 12);
static_assert(sizeof(NiteUserId) == 2 && sizeof(NiteHandId) == 2);
static_assert(sizeof(NiteJointType) == 4 && sizeof(NiteStatus) == 4 && sizeof(NitePoseType) == 4);

}  // namespace
