// The functions of NiTE 2.2. They do not throw.
#include <NiteCAPI.h>
#include <OpenNI.h>

#include <exception>

#include "tools/nite2/open_trackers_internal.h"

namespace {

using ossa::nite2::Callback;
using ossa::nite2::HandTracker;
using ossa::nite2::Session;
using ossa::nite2::UserTracker;

constexpr NiteVersion kVersion = {2, 2, 0, 0};  // whose interface this is

NiteStatus StatusOf(bool good) { return good ? NITE_STATUS_OK : NITE_STATUS_ERROR; }

template <typename Call>
NiteStatus Guarded(const Call& call) {
  try {
    return call();
  } catch (const std::exception&) {
    return NITE_STATUS_ERROR;
  }
}

// Calls `call` with the open tracker of the handle.
template <typename Call>
NiteStatus With(NiteUserTrackerHandle handle, const Call& call) {
  return Guarded([&] {
    const auto tracker = Session::Instance().users.Find(handle);
    return tracker ? call(*tracker) : NITE_STATUS_ERROR;
  });
}
template <typename Call>
NiteStatus With(NiteHandTrackerHandle handle, const Call& call) {
  return Guarded([&] {
    const auto tracker = Session::Instance().hands.Find(handle);
    return tracker ? call(*tracker) : NITE_STATUS_ERROR;
  });
}

// The same for calls without a result.
template <typename Handle, typename Call>
void Do(Handle handle, const Call& call) {
  With(handle, [&](auto& tracker) {
    call(tracker);
    return NITE_STATUS_OK;
  });
}

// Programs pass the device as OpenNI2's C++ object.
OniDeviceHandle DeviceOf(void* device) {
  return device == nullptr ? nullptr : static_cast<openni::Device*>(device)->_getHandle();
}

template <typename Callbacks>
NiteStatus AddCallback(auto handle, Callbacks* callbacks, void* cookie) {
  if (callbacks == nullptr || callbacks->readyForNextFrame == nullptr) return NITE_STATUS_ERROR;
  return With(handle, [&](auto& tracker) {
    return StatusOf(tracker.AddCallback({callbacks, callbacks->readyForNextFrame, cookie}));
  });
}

template <typename Frame>
NiteStatus ReadFrame(auto handle, Frame** frame) {
  if (frame == nullptr) return NITE_STATUS_ERROR;
  *frame = nullptr;
  return With(handle, [&](auto& tracker) { return tracker.Read(frame); });
}

NiteStatus GetFactor(auto handle, float* factor) {
  if (factor == nullptr) return NITE_STATUS_ERROR;
  return With(handle, [&](auto& tracker) {
    *factor = tracker.smoothing();
    return NITE_STATUS_OK;
  });
}

NiteStatus ToPixel(auto handle, NitePoint3f point, float* x, float* y) {
  if (x == nullptr || y == nullptr) return NITE_STATUS_ERROR;
  return With(handle, [&](auto& tracker) {
    return StatusOf(tracker.ToPixel(point.x, point.y, point.z, x, y));
  });
}

struct Pixel {
  int x, y, depth_mm;
};

NiteStatus ToPoint(auto handle, Pixel pixel, float* x, float* y) {
  if (x == nullptr || y == nullptr) return NITE_STATUS_ERROR;
  return With(handle, [&](auto& tracker) {
    return StatusOf(tracker.ToPoint(pixel.x, pixel.y, pixel.depth_mm, x, y));
  });
}

}  // namespace

NiteStatus niteInitialize() {
  return Guarded([] {
    Session::Instance().Begin();
    return NITE_STATUS_OK;
  });
}

void niteShutdown() {
  Guarded([] {
    Session::Instance().End();
    return NITE_STATUS_OK;
  });
}

NiteVersion niteGetVersion() { return kVersion; }

NiteStatus niteInitializeUserTrackerByDevice(void* pDevice, NiteUserTrackerHandle* pUserTracker) {
  if (pUserTracker == nullptr) return NITE_STATUS_ERROR;
  *pUserTracker = nullptr;
  return Guarded([&] {
    *pUserTracker = Session::Instance().OpenUserTracker(DeviceOf(pDevice));
    return NITE_STATUS_OK;
  });
}

NiteStatus niteInitializeUserTracker(NiteUserTrackerHandle* pUserTracker) {
  return niteInitializeUserTrackerByDevice(nullptr, pUserTracker);
}

NiteStatus niteShutdownUserTracker(NiteUserTrackerHandle userTracker) {
  return Guarded([&] { return StatusOf(Session::Instance().users.Close(userTracker)); });
}

NiteStatus niteStartSkeletonTracking(NiteUserTrackerHandle userTracker, NiteUserId id) {
  return With(userTracker, [&](UserTracker& tracker) { return tracker.StartSkeleton(id); });
}

void niteStopSkeletonTracking(NiteUserTrackerHandle userTracker, NiteUserId id) {
  Do(userTracker, [&](UserTracker& tracker) { tracker.StopSkeleton(id); });
}

bool niteIsSkeletonTracking(NiteUserTrackerHandle userTracker, NiteUserId id) {
  return With(userTracker, [&](UserTracker& tracker) {
           return StatusOf(tracker.IsTracking(id));
         }) == NITE_STATUS_OK;
}

NiteStatus niteSetSkeletonSmoothing(NiteUserTrackerHandle userTracker, float factor) {
  return With(userTracker,
              [&](UserTracker& tracker) { return StatusOf(tracker.SetSmoothing(factor)); });
}

NiteStatus niteGetSkeletonSmoothing(NiteUserTrackerHandle userTracker, float* pFactor) {
  return GetFactor(userTracker, pFactor);
}

NiteStatus niteStartPoseDetection(NiteUserTrackerHandle userTracker, NiteUserId id,
                                  NitePoseType poseType) {
  return With(userTracker, [&](UserTracker& tracker) { return tracker.StartPose(id, poseType); });
}

void niteStopPoseDetection(NiteUserTrackerHandle userTracker, NiteUserId id,
                           NitePoseType poseType) {
  Do(userTracker, [&](UserTracker& tracker) { tracker.StopPose(id, poseType); });
}

void niteStopAllPoseDetection(NiteUserTrackerHandle userTracker, NiteUserId id) {
  Do(userTracker, [&](UserTracker& tracker) { tracker.StopPoses(id); });
}

NiteStatus niteRegisterUserTrackerCallbacks(NiteUserTrackerHandle userTracker,
                                            NiteUserTrackerCallbacks* pCallbacks, void* pCookie) {
  return AddCallback(userTracker, pCallbacks, pCookie);
}

void niteUnregisterUserTrackerCallbacks(NiteUserTrackerHandle userTracker,
                                        NiteUserTrackerCallbacks* pCallbacks) {
  Do(userTracker, [&](UserTracker& tracker) { tracker.RemoveCallback(pCallbacks); });
}

NiteStatus niteReadUserTrackerFrame(NiteUserTrackerHandle userTracker,
                                    NiteUserTrackerFrame** pUserTrackerFrame) {
  return ReadFrame(userTracker, pUserTrackerFrame);
}

NiteStatus niteUserTrackerFrameAddRef(NiteUserTrackerHandle userTracker,
                                      NiteUserTrackerFrame* pUserTrackerFrame) {
  return With(userTracker, [&](UserTracker& tracker) {
    return StatusOf(tracker.frames.AddRef(pUserTrackerFrame));
  });
}

NiteStatus niteUserTrackerFrameRelease(NiteUserTrackerHandle userTracker,
                                       NiteUserTrackerFrame* pUserTrackerFrame) {
  return With(userTracker, [&](UserTracker& tracker) {
    return StatusOf(tracker.frames.Release(pUserTrackerFrame));
  });
}

NiteStatus niteInitializeHandTrackerByDevice(void* pDevice, NiteHandTrackerHandle* pHandTracker) {
  if (pHandTracker == nullptr) return NITE_STATUS_ERROR;
  *pHandTracker = nullptr;
  return Guarded([&] {
    *pHandTracker = Session::Instance().OpenHandTracker(DeviceOf(pDevice));
    return NITE_STATUS_OK;
  });
}

NiteStatus niteInitializeHandTracker(NiteHandTrackerHandle* pHandTracker) {
  return niteInitializeHandTrackerByDevice(nullptr, pHandTracker);
}

NiteStatus niteShutdownHandTracker(NiteHandTrackerHandle handTracker) {
  return Guarded([&] { return StatusOf(Session::Instance().hands.Close(handTracker)); });
}

NiteStatus niteStartHandTracking(NiteHandTrackerHandle handTracker, const NitePoint3f* pPosition,
                                 NiteHandId* pNewHandId) {
  if (pPosition == nullptr || pNewHandId == nullptr) return NITE_STATUS_ERROR;
  return With(handTracker, [&](HandTracker& tracker) {
    *pNewHandId = tracker.StartHand(*pPosition);
    return NITE_STATUS_OK;
  });
}

void niteStopHandTracking(NiteHandTrackerHandle handTracker, NiteHandId id) {
  Do(handTracker, [&](HandTracker& tracker) { tracker.StopHand(id); });
}

void niteStopAllHandTracking(NiteHandTrackerHandle handTracker) {
  Do(handTracker, [](HandTracker& tracker) { tracker.StopHands(); });
}

NiteStatus niteSetHandSmoothingFactor(NiteHandTrackerHandle handTracker, float factor) {
  return With(handTracker,
              [&](HandTracker& tracker) { return StatusOf(tracker.SetSmoothing(factor)); });
}

NiteStatus niteGetHandSmoothingFactor(NiteHandTrackerHandle handTracker, float* pFactor) {
  return GetFactor(handTracker, pFactor);
}

NiteStatus niteRegisterHandTrackerCallbacks(NiteHandTrackerHandle handTracker,
                                            NiteHandTrackerCallbacks* pCallbacks, void* pCookie) {
  return AddCallback(handTracker, pCallbacks, pCookie);
}

void niteUnregisterHandTrackerCallbacks(NiteHandTrackerHandle handTracker,
                                        NiteHandTrackerCallbacks* pCallbacks) {
  Do(handTracker, [&](HandTracker& tracker) { tracker.RemoveCallback(pCallbacks); });
}

NiteStatus niteReadHandTrackerFrame(NiteHandTrackerHandle handTracker,
                                    NiteHandTrackerFrame** pHandTrackerFrame) {
  return ReadFrame(handTracker, pHandTrackerFrame);
}

NiteStatus niteHandTrackerFrameAddRef(NiteHandTrackerHandle handTracker,
                                      NiteHandTrackerFrame* pHandTrackerFrame) {
  return With(handTracker, [&](HandTracker& tracker) {
    return StatusOf(tracker.frames.AddRef(pHandTrackerFrame));
  });
}

NiteStatus niteHandTrackerFrameRelease(NiteHandTrackerHandle handTracker,
                                       NiteHandTrackerFrame* pHandTrackerFrame) {
  return With(handTracker, [&](HandTracker& tracker) {
    return StatusOf(tracker.frames.Release(pHandTrackerFrame));
  });
}

NiteStatus niteStartGestureDetection(NiteHandTrackerHandle handTracker, NiteGestureType type) {
  return With(handTracker,
              [&](HandTracker& tracker) { return StatusOf(tracker.StartGesture(type)); });
}

void niteStopGestureDetection(NiteHandTrackerHandle handTracker, NiteGestureType type) {
  Do(handTracker, [&](HandTracker& tracker) { tracker.StopGesture(type); });
}

void niteStopAllGestureDetection(NiteHandTrackerHandle handTracker) {
  Do(handTracker, [](HandTracker& tracker) { tracker.StopGestures(); });
}

NiteStatus niteConvertJointCoordinatesToDepth(NiteUserTrackerHandle userTracker, float x, float y,
                                              float z, float* pX, float* pY) {
  return ToPixel(userTracker, {x, y, z}, pX, pY);
}

NiteStatus niteConvertDepthCoordinatesToJoint(NiteUserTrackerHandle userTracker, int x, int y,
                                              int z, float* pX, float* pY) {
  return ToPoint(userTracker, {x, y, z}, pX, pY);
}

NiteStatus niteConvertHandCoordinatesToDepth(NiteHandTrackerHandle handTracker, float x, float y,
                                             float z, float* pX, float* pY) {
  return ToPixel(handTracker, {x, y, z}, pX, pY);
}

NiteStatus niteConvertDepthCoordinatesToHand(NiteHandTrackerHandle handTracker, int x, int y, int z,
                                             float* pX, float* pY) {
  return ToPoint(handTracker, {x, y, z}, pX, pY);
}
