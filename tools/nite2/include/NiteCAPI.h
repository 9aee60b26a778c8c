#pragma once
/* The functions of the NiTE 2 C interface, as ossa's libNiTE2.so has them. All may be called from
 * any thread; what is not valid (any more) gives an error status. */
#include <NiteCTypes.h>
#ifndef __cplusplus
#include <stdbool.h>
#endif

#ifdef __cplusplus
#define NITE_API extern "C" __attribute__((visibility("default")))
#else
#define NITE_API __attribute__((visibility("default")))
#endif

/* Starts OpenNI2, too; counted. */
NITE_API NiteStatus niteInitialize(void);
/* The last one closes what trackers and frames are left. */
NITE_API void niteShutdown(void);
NITE_API NiteVersion niteGetVersion(void);

/* On the first device there is; or on an open one, given as an openni::Device of OpenNI2's C++
 * interface. The tracker holds the device open for itself. */
NITE_API NiteStatus niteInitializeUserTracker(NiteUserTrackerHandle* pUserTracker);
NITE_API NiteStatus niteInitializeUserTrackerByDevice(void* pDevice,
                                                      NiteUserTrackerHandle* pUserTracker);
NITE_API NiteStatus niteShutdownUserTracker(NiteUserTrackerHandle userTracker);

NITE_API NiteStatus niteStartSkeletonTracking(NiteUserTrackerHandle userTracker, NiteUserId id);
NITE_API void niteStopSkeletonTracking(NiteUserTrackerHandle userTracker, NiteUserId id);
NITE_API bool niteIsSkeletonTracking(NiteUserTrackerHandle userTracker, NiteUserId id);
/* 0: as measured, 1: nothing moves. */
NITE_API NiteStatus niteSetSkeletonSmoothing(NiteUserTrackerHandle userTracker, float factor);
NITE_API NiteStatus niteGetSkeletonSmoothing(NiteUserTrackerHandle userTracker, float* pFactor);
NITE_API NiteStatus niteStartPoseDetection(NiteUserTrackerHandle userTracker, NiteUserId id,
                                           NitePoseType poseType);
NITE_API void niteStopPoseDetection(NiteUserTrackerHandle userTracker, NiteUserId id,
                                    NitePoseType poseType);
NITE_API void niteStopAllPoseDetection(NiteUserTrackerHandle userTracker, NiteUserId id);

/* The structure of callbacks is also what unregisters them. */
NITE_API NiteStatus niteRegisterUserTrackerCallbacks(NiteUserTrackerHandle userTracker,
                                                     NiteUserTrackerCallbacks* pCallbacks,
                                                     void* pCookie);
NITE_API void niteUnregisterUserTrackerCallbacks(NiteUserTrackerHandle userTracker,
                                                 NiteUserTrackerCallbacks* pCallbacks);
/* Waits up to two seconds for a depth frame. The frame comes with one reference. */
NITE_API NiteStatus niteReadUserTrackerFrame(NiteUserTrackerHandle userTracker,
                                             NiteUserTrackerFrame** pUserTrackerFrame);
NITE_API NiteStatus niteUserTrackerFrameAddRef(NiteUserTrackerHandle userTracker,
                                               NiteUserTrackerFrame* pUserTrackerFrame);
NITE_API NiteStatus niteUserTrackerFrameRelease(NiteUserTrackerHandle userTracker,
                                                NiteUserTrackerFrame* pUserTrackerFrame);

NITE_API NiteStatus niteInitializeHandTracker(NiteHandTrackerHandle* pHandTracker);
NITE_API NiteStatus niteInitializeHandTrackerByDevice(void* pDevice,
                                                      NiteHandTrackerHandle* pHandTracker);
NITE_API NiteStatus niteShutdownHandTracker(NiteHandTrackerHandle handTracker);

/* Follows the hand nearest to the position; the frames to come tell whether there was one. */
NITE_API NiteStatus niteStartHandTracking(NiteHandTrackerHandle handTracker,
                                          const NitePoint3f* pPosition, NiteHandId* pNewHandId);
NITE_API void niteStopHandTracking(NiteHandTrackerHandle handTracker, NiteHandId id);
NITE_API void niteStopAllHandTracking(NiteHandTrackerHandle handTracker);
NITE_API NiteStatus niteSetHandSmoothingFactor(NiteHandTrackerHandle handTracker, float factor);
NITE_API NiteStatus niteGetHandSmoothingFactor(NiteHandTrackerHandle handTracker, float* pFactor);
NITE_API NiteStatus niteRegisterHandTrackerCallbacks(NiteHandTrackerHandle handTracker,
                                                     NiteHandTrackerCallbacks* pCallbacks,
                                                     void* pCookie);
NITE_API void niteUnregisterHandTrackerCallbacks(NiteHandTrackerHandle handTracker,
                                                 NiteHandTrackerCallbacks* pCallbacks);
NITE_API NiteStatus niteReadHandTrackerFrame(NiteHandTrackerHandle handTracker,
                                             NiteHandTrackerFrame** pHandTrackerFrame);
NITE_API NiteStatus niteHandTrackerFrameAddRef(NiteHandTrackerHandle handTracker,
                                               NiteHandTrackerFrame* pHandTrackerFrame);
NITE_API NiteStatus niteHandTrackerFrameRelease(NiteHandTrackerHandle handTracker,
                                                NiteHandTrackerFrame* pHandTrackerFrame);
NITE_API NiteStatus niteStartGestureDetection(NiteHandTrackerHandle handTracker,
                                              NiteGestureType type);
NITE_API void niteStopGestureDetection(NiteHandTrackerHandle handTracker, NiteGestureType type);
NITE_API void niteStopAllGestureDetection(NiteHandTrackerHandle handTracker);

/* Between millimetres and pixels of the depth image. */
NITE_API NiteStatus niteConvertJointCoordinatesToDepth(NiteUserTrackerHandle userTracker, float x,
                                                       float y, float z, float* pX, float* pY);
NITE_API NiteStatus niteConvertDepthCoordinatesToJoint(NiteUserTrackerHandle userTracker, int x,
                                                       int y, int z, float* pX, float* pY);
NITE_API NiteStatus niteConvertHandCoordinatesToDepth(NiteHandTrackerHandle handTracker, float x,
                                                      float y, float z, float* pX, float* pY);
NITE_API NiteStatus niteConvertDepthCoordinatesToHand(NiteHandTrackerHandle handTracker, int x,
                                                      int y, int z, float* pX, float* pY);
