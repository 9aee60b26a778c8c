#pragma once
/* Types of the NiTE 2 C interface: names, values and layouts as programs that were written against
 * NiTE 2.2 expect them. Positions are millimetres, x to the right of the image as it is delivered
 * (mirrored or not), y up, z away from the sensor. */
#include <OniCTypes.h>
#include <stdint.h>

enum { NITE_JOINT_COUNT = 15, NITE_POSE_COUNT = 2 };

/* Left and right are the person's own. */
typedef enum {
  NITE_JOINT_HEAD,
  NITE_JOINT_NECK,
  NITE_JOINT_LEFT_SHOULDER,
  NITE_JOINT_RIGHT_SHOULDER,
  NITE_JOINT_LEFT_ELBOW,
  NITE_JOINT_RIGHT_ELBOW,
  NITE_JOINT_LEFT_HAND,
  NITE_JOINT_RIGHT_HAND,
  NITE_JOINT_TORSO,
  NITE_JOINT_LEFT_HIP,
  NITE_JOINT_RIGHT_HIP,
  NITE_JOINT_LEFT_KNEE,
  NITE_JOINT_RIGHT_KNEE,
  NITE_JOINT_LEFT_FOOT,
  NITE_JOINT_RIGHT_FOOT
} NiteJointType;

typedef enum {
  NITE_SKELETON_NONE,        /* not asked for */
  NITE_SKELETON_CALIBRATING, /* asked for, not yet sure */
  NITE_SKELETON_TRACKED,
  NITE_SKELETON_CALIBRATION_ERROR_NOT_IN_POSE,
  NITE_SKELETON_CALIBRATION_ERROR_HANDS,
  NITE_SKELETON_CALIBRATION_ERROR_HEAD,
  NITE_SKELETON_CALIBRATION_ERROR_LEGS,
  NITE_SKELETON_CALIBRATION_ERROR_TORSO
} NiteSkeletonState;

/* Bits: somebody new is visible. 0: known, but not in view. */
typedef enum {
  NITE_USER_STATE_VISIBLE = 1,
  NITE_USER_STATE_NEW = 3,
  NITE_USER_STATE_LOST = 4
} NiteUserState;

typedef enum {
  NITE_STATUS_OK,
  NITE_STATUS_ERROR,
  NITE_STATUS_BAD_USER_ID,
  NITE_STATUS_OUT_OF_FLOW
} NiteStatus;

typedef enum { NITE_POSE_PSI, NITE_POSE_CROSSED_HANDS } NitePoseType;

typedef enum {
  NITE_POSE_STATE_DETECTING = 1,
  NITE_POSE_STATE_IN_POSE = 2,
  NITE_POSE_STATE_ENTER = 4,
  NITE_POSE_STATE_EXIT = 8
} NitePoseState;

typedef enum { NITE_GESTURE_WAVE, NITE_GESTURE_CLICK, NITE_GESTURE_HAND_RAISE } NiteGestureType;

typedef enum {
  NITE_GESTURE_STATE_NEW = 1,
  NITE_GESTURE_STATE_IN_PROGRESS = 2,
  NITE_GESTURE_STATE_COMPLETED = 4
} NiteGestureState;

/* Bits: a hand at the border of the image is tracked and touches it. */
typedef enum {
  NITE_HAND_STATE_LOST = 0,
  NITE_HAND_STATE_NEW = 1,
  NITE_HAND_STATE_TRACKED = 2,
  NITE_HAND_STATE_TOUCHING_FOV = 4
} NiteHandState;

typedef int16_t NiteUserId;
typedef int16_t NiteHandId;
typedef struct NiteUserTracker* NiteUserTrackerHandle;
typedef struct NiteHandTracker* NiteHandTrackerHandle;

typedef struct {
  float x, y, z;
} NitePoint3f;

typedef struct {
  float x, y, z, w;
} NiteQuaternion;

/* The orientation turns the joint's bone from where it is in a T-pose that faces the sensor. */
typedef struct {
  NiteJointType jointType;
  NitePoint3f position;
  float positionConfidence; /* 0 to 1 */
  NiteQuaternion orientation;
  float orientationConfidence;
} NiteSkeletonJoint;

/* Pixels and millimetres of depth. */
typedef struct {
  NitePoint3f min, max;
} NiteBoundingBox;

typedef struct {
  NitePoseType type;
  int state; /* of NitePoseState */
} NitePoseData;

typedef struct {
  NiteSkeletonJoint joints[NITE_JOINT_COUNT];
  NiteSkeletonState state;
  int internalState;
} NiteSkeleton;

typedef struct {
  NiteUserId id; /* from 1 */
  NiteBoundingBox boundingBox;
  NitePoint3f centerOfMass;
  int state; /* of NiteUserState */
  NiteSkeleton skeleton;
  NitePoseData poses[NITE_POSE_COUNT];
} NiteUserData;

/* Whose each pixel is, 0 nobody's; as large as the depth frame. */
typedef struct {
  NiteUserId* pixels;
  int width, height;
  int stride; /* bytes */
} NiteUserMap;

typedef struct {
  NitePoint3f point, normal;
} NitePlane;

typedef struct {
  int userCount;
  NiteUserData* pUser;
  NiteUserMap userMap;
  OniFrame* pDepthFrame;
  unsigned long long timestamp; /* microseconds, of the depth frame */
  int frameIndex;
  float floorConfidence; /* 0: no floor */
  NitePlane floor;
} NiteUserTrackerFrame;

/* There is something to read. */
typedef struct {
  OniGeneralCallback readyForNextFrame;
} NiteUserTrackerCallbacks;

typedef struct {
  NiteHandId id;
  NitePoint3f position;
  int state; /* of NiteHandState */
} NiteHandData;

typedef struct {
  NiteGestureType type;
  NitePoint3f currentPosition;
  int state; /* of NiteGestureState */
} NiteGestureData;

typedef struct {
  int handCount;
  NiteHandData* pHands;
  int gestureCount;
  NiteGestureData* pGestures;
  OniFrame* pDepthFrame;
  unsigned long long timestamp;
  int frameIndex;
} NiteHandTrackerFrame;

typedef struct {
  OniGeneralCallback readyForNextFrame;
} NiteHandTrackerCallbacks;

typedef struct {
  int major, minor, maintenance, build;
} NiteVersion;
