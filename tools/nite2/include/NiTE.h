#pragma once
// The C++ interface of NiTE 2 by its names, over the C interface of ossa's libNiTE2.so: programs
// that were written against NiTE.h compile unchanged. Everything here is inline.
#include <OpenNI.h>

#include <memory>

#include "NiteCAPI.h"
#include "NiteEnums.h"

namespace nite {

using UserId = NiteUserId;
using HandId = NiteHandId;

/// Millimetres.
class Point3f : public NitePoint3f {
 public:
  Point3f() { set(0.0F, 0.0F, 0.0F); }
  Point3f(float px, float py, float pz) { set(px, py, pz); }
  Point3f(const NitePoint3f& other) { set(other.x, other.y, other.z); }

  void set(float px, float py, float pz) {
    x = px;
    y = py;
    z = pz;
  }
  bool operator==(const Point3f& other) const {
    return x == other.x && y == other.y && z == other.z;
  }
  bool operator!=(const Point3f& other) const { return !(*this == other); }
};

class Quaternion : public NiteQuaternion {
 public:
  Quaternion() : NiteQuaternion{0.0F, 0.0F, 0.0F, 1.0F} {}
  Quaternion(float qw, float qx, float qy, float qz) : NiteQuaternion{qx, qy, qz, qw} {}

  bool operator==(const Quaternion& other) const {
    return w == other.w && x == other.x && y == other.y && z == other.z;
  }
  bool operator!=(const Quaternion& other) const { return !(*this == other); }
};

class Plane : public NitePlane {
 public:
  Plane() : Plane(Point3f(), Point3f()) {}
  Plane(const Point3f& at, const Point3f& upright) : NitePlane{at, upright} {}
};

class BoundingBox : public NiteBoundingBox {
 public:
  BoundingBox() : BoundingBox(Point3f(), Point3f()) {}
  BoundingBox(const Point3f& low, const Point3f& high) : NiteBoundingBox{low, high} {}
};

using Version = NiteVersion;

/// So many T in a row that somebody else owns.
template <class T>
class Array {
 public:
  Array() = default;
  Array(const Array&) = delete;
  Array& operator=(const Array&) = delete;

  int getSize() const { return size_; }
  bool isEmpty() const { return size_ == 0; }
  const T& operator[](int index) const { return data_[index]; }

  void _setData(int size, const T* data) {
    size_ = size;
    data_ = data;
  }

 private:
  int size_ = 0;
  const T* data_ = nullptr;
};

class PoseData : protected NitePoseData {
 public:
  PoseType getType() const { return static_cast<PoseType>(type); }
  bool isHeld() const { return (state & (NITE_POSE_STATE_IN_POSE | NITE_POSE_STATE_ENTER)) != 0; }
  bool isEntered() const { return (state & NITE_POSE_STATE_ENTER) != 0; }
  bool isExited() const { return (state & NITE_POSE_STATE_EXIT) != 0; }
};

class SkeletonJoint : private NiteSkeletonJoint {
 public:
  JointType getType() const { return static_cast<JointType>(jointType); }
  const Point3f& getPosition() const { return static_cast<const Point3f&>(position); }
  float getPositionConfidence() const { return positionConfidence; }
  const Quaternion& getOrientation() const { return static_cast<const Quaternion&>(orientation); }
  float getOrientationConfidence() const { return orientationConfidence; }
};

class Skeleton : private NiteSkeleton {
 public:
  const SkeletonJoint& getJoint(JointType type) const {
    return reinterpret_cast<const SkeletonJoint&>(joints[type]);
  }
  SkeletonState getState() const { return static_cast<SkeletonState>(state); }
};

class UserData : private NiteUserData {
 public:
  UserId getId() const { return id; }
  const BoundingBox& getBoundingBox() const { return static_cast<const BoundingBox&>(boundingBox); }
  const Point3f& getCenterOfMass() const { return static_cast<const Point3f&>(centerOfMass); }
  bool isNew() const { return state == NITE_USER_STATE_NEW; }
  bool isVisible() const { return (state & NITE_USER_STATE_VISIBLE) != 0; }
  bool isLost() const { return (state & NITE_USER_STATE_LOST) != 0; }
  const Skeleton& getSkeleton() const { return reinterpret_cast<const Skeleton&>(skeleton); }
  const PoseData& getPose(PoseType type) const {
    return reinterpret_cast<const PoseData&>(poses[type]);
  }
};

class GestureData : protected NiteGestureData {
 public:
  GestureType getType() const { return static_cast<GestureType>(type); }
  const Point3f& getCurrentPosition() const { return static_cast<const Point3f&>(currentPosition); }
  bool isComplete() const { return (state & NITE_GESTURE_STATE_COMPLETED) != 0; }
  bool isInProgress() const { return (state & NITE_GESTURE_STATE_IN_PROGRESS) != 0; }
};

class HandData : protected NiteHandData {
 public:
  HandId getId() const { return id; }
  const Point3f& getPosition() const { return static_cast<const Point3f&>(position); }
  bool isNew() const { return (state & NITE_HAND_STATE_NEW) != 0; }
  bool isLost() const { return state == NITE_HAND_STATE_LOST; }
  bool isTracking() const { return (state & NITE_HAND_STATE_TRACKED) != 0; }
  bool isTouchingFov() const { return (state & NITE_HAND_STATE_TOUCHING_FOV) != 0; }
};

class UserMap : private NiteUserMap {
 public:
  UserMap() : NiteUserMap() {}
  explicit UserMap(const NiteUserMap& map) : NiteUserMap(map) {}
  const UserId* getPixels() const { return pixels; }
  int getWidth() const { return width; }
  int getHeight() const { return height; }
  int getStride() const { return stride; }
};

/// What trackers of users and of hands have in common. `C`: the C interface of one of them.
namespace shared {

/// `count` of the C interface's structures, which a T is.
template <class T, class From>
void show(int count, const From* from, Array<T>& array) {
  array._setData(count, reinterpret_cast<const T*>(from));
}

struct UserInterface {
  using Handle = NiteUserTrackerHandle;
  using Frame = NiteUserTrackerFrame;
  struct Arrays {
    Array<UserData> users;
    void of(const Frame& frame) { show(frame.userCount, frame.pUser, users); }
  };
  using Callbacks = NiteUserTrackerCallbacks;
  static NiteStatus open(Handle* handle) { return niteInitializeUserTracker(handle); }
  static NiteStatus open(void* device, Handle* handle) {
    return niteInitializeUserTrackerByDevice(device, handle);
  }
  static void close(Handle handle) { niteShutdownUserTracker(handle); }
  static NiteStatus read(Handle handle, Frame** frame) {
    return niteReadUserTrackerFrame(handle, frame);
  }
  static void addRef(Handle handle, Frame* frame) { niteUserTrackerFrameAddRef(handle, frame); }
  static void release(Handle handle, Frame* frame) { niteUserTrackerFrameRelease(handle, frame); }
  static void listen(Handle handle, Callbacks* callbacks, void* cookie) {
    niteRegisterUserTrackerCallbacks(handle, callbacks, cookie);
  }
  static void unlisten(Handle handle, Callbacks* callbacks) {
    niteUnregisterUserTrackerCallbacks(handle, callbacks);
  }
};

struct HandInterface {
  using Handle = NiteHandTrackerHandle;
  using Frame = NiteHandTrackerFrame;
  struct Arrays {
    Array<HandData> hands;
    Array<GestureData> gestures;
    void of(const Frame& frame) {
      show(frame.handCount, frame.pHands, hands);
      show(frame.gestureCount, frame.pGestures, gestures);
    }
  };
  using Callbacks = NiteHandTrackerCallbacks;
  static NiteStatus open(Handle* handle) { return niteInitializeHandTracker(handle); }
  static NiteStatus open(void* device, Handle* handle) {
    return niteInitializeHandTrackerByDevice(device, handle);
  }
  static void close(Handle handle) { niteShutdownHandTracker(handle); }
  static NiteStatus read(Handle handle, Frame** frame) {
    return niteReadHandTrackerFrame(handle, frame);
  }
  static void addRef(Handle handle, Frame* frame) { niteHandTrackerFrameAddRef(handle, frame); }
  static void release(Handle handle, Frame* frame) { niteHandTrackerFrameRelease(handle, frame); }
  static void listen(Handle handle, Callbacks* callbacks, void* cookie) {
    niteRegisterHandTrackerCallbacks(handle, callbacks, cookie);
  }
  static void unlisten(Handle handle, Callbacks* callbacks) {
    niteUnregisterHandTrackerCallbacks(handle, callbacks);
  }
};

/// Shares one frame; the last one gives it back.
template <class C>
class FrameRef {
 public:
  FrameRef() = default;
  ~FrameRef() { release(); }
  FrameRef(const FrameRef& other) { *this = other; }
  FrameRef& operator=(const FrameRef& other) {
    if (this == &other) return *this;
    if (other.isValid()) C::addRef(other.handle_, other.frame_);
    setReference(other.handle_, other.frame_);
    return *this;
  }

  bool isValid() const { return frame_ != nullptr; }
  void release() { setReference(nullptr, nullptr); }

  openni::VideoFrameRef getDepthFrame() const {
    openni::VideoFrameRef frame;
    if (isValid()) frame._setFrame(frame_->pDepthFrame);
    return frame;
  }
  uint64_t getTimestamp() const { return frame_->timestamp; }
  int getFrameIndex() const { return frame_->frameIndex; }

  /// Of trackers: takes over the reference that the C interface gave.
  void setReference(typename C::Handle handle, typename C::Frame* frame) {
    if (isValid()) C::release(handle_, frame_);
    handle_ = handle;
    frame_ = frame;
    arrays_.of(frame == nullptr ? typename C::Frame{} : *frame);
  }

 protected:
  const typename C::Frame* frame() const { return frame_; }
  /// The frame's own: whoever keeps a reference to one sees what is read into it next.
  const typename C::Arrays& arrays() const { return arrays_; }

 private:
  typename C::Arrays arrays_;
  typename C::Frame* frame_ = nullptr;
  typename C::Handle handle_ = nullptr;
};

template <class C, class Tracker>
class TrackerOf;

/// Told when there is a frame to read; may read it.
template <class C, class Tracker>
class NewFrameListener {
 public:
  NewFrameListener() { callbacks_.readyForNextFrame = &NewFrameListener::onReady; }
  virtual ~NewFrameListener() = default;
  virtual void onNewFrame(Tracker& tracker) = 0;

 private:
  friend class TrackerOf<C, Tracker>;
  static void ONI_CALLBACK_TYPE onReady(void* cookie) {
    auto* listener = static_cast<NewFrameListener*>(cookie);
    if (listener->tracker_ != nullptr) listener->onNewFrame(*listener->tracker_);
  }
  typename C::Callbacks callbacks_{};
  Tracker* tracker_ = nullptr;
};

/// What `Tracker` is over the C interface. Copies, which programs hand out, are the same tracker:
/// the last one closes it, or destroy() of any.
template <class C, class Tracker>
class TrackerOf {
 public:
  using NewFrameListener = shared::NewFrameListener<C, Tracker>;

  /// On the first device there is, or on an open one.
  Status create(openni::Device* device = nullptr) {
    destroy();
    open_ = std::make_shared<Open>();
    return static_cast<Status>(device == nullptr ? C::open(&open_->handle)
                                                 : C::open(device, &open_->handle));
  }
  void destroy() {
    if (open_ != nullptr) open_->close();
    open_ = nullptr;
  }
  bool isValid() const { return handle() != nullptr; }

  Status readFrame(FrameRef<C>* frame) {
    typename C::Frame* read = nullptr;
    const NiteStatus status = C::read(handle(), &read);
    if (status == NITE_STATUS_OK) frame->setReference(handle(), read);
    return static_cast<Status>(status);
  }

  void addNewFrameListener(NewFrameListener* listener) {
    listener->tracker_ = static_cast<Tracker*>(this);
    C::listen(handle(), &listener->callbacks_, listener);
  }
  void removeNewFrameListener(NewFrameListener* listener) {
    C::unlisten(handle(), &listener->callbacks_);
    listener->tracker_ = nullptr;
  }

 protected:
  typename C::Handle handle() const { return open_ == nullptr ? nullptr : open_->handle; }

 private:
  struct Open {
    typename C::Handle handle = nullptr;
    Open() = default;
    Open(const Open&) = delete;
    Open& operator=(const Open&) = delete;
    ~Open() { close(); }
    void close() {
      if (handle != nullptr) C::close(handle);
      handle = nullptr;
    }
  };
  std::shared_ptr<Open> open_;
};

}  // namespace shared

class UserTrackerFrameRef : public shared::FrameRef<shared::UserInterface> {
 public:
  const Array<UserData>& getUsers() const { return arrays().users; }
  const UserData* getUserById(UserId id) const {
    const Array<UserData>& users = getUsers();
    for (int i = 0; i < users.getSize(); ++i) {
      if (users[i].getId() == id) return &users[i];
    }
    return nullptr;
  }
  UserMap getUserMap() const { return UserMap(frame()->userMap); }
  const Plane& getFloor() const { return static_cast<const Plane&>(frame()->floor); }
  float getFloorConfidence() const { return frame()->floorConfidence; }
};

/// Who is in view, and their skeletons.
class UserTracker : public shared::TrackerOf<shared::UserInterface, UserTracker> {
 public:
  Status startSkeletonTracking(UserId id) {
    return static_cast<Status>(niteStartSkeletonTracking(handle(), id));
  }
  void stopSkeletonTracking(UserId id) { niteStopSkeletonTracking(handle(), id); }
  bool isSkeletonTracking(UserId id) const { return niteIsSkeletonTracking(handle(), id); }
  Status setSkeletonSmoothingFactor(float factor) {
    return static_cast<Status>(niteSetSkeletonSmoothing(handle(), factor));
  }
  float getSkeletonSmoothingFactor() const {
    float factor = 0.0F;
    return niteGetSkeletonSmoothing(handle(), &factor) == NITE_STATUS_OK ? factor : 0.0F;
  }

  Status startPoseDetection(UserId id, PoseType type) {
    return static_cast<Status>(
        niteStartPoseDetection(handle(), id, static_cast<NitePoseType>(type)));
  }
  void stopPoseDetection(UserId id, PoseType type) {
    niteStopPoseDetection(handle(), id, static_cast<NitePoseType>(type));
  }
  void stopAllPoseDetection(UserId id) { niteStopAllPoseDetection(handle(), id); }

  Status convertJointCoordinatesToDepth(float x, float y, float z, float* px, float* py) const {
    return static_cast<Status>(niteConvertJointCoordinatesToDepth(handle(), x, y, z, px, py));
  }
  Status convertDepthCoordinatesToJoint(int x, int y, int z, float* px, float* py) const {
    return static_cast<Status>(niteConvertDepthCoordinatesToJoint(handle(), x, y, z, px, py));
  }
};

class HandTrackerFrameRef : public shared::FrameRef<shared::HandInterface> {
 public:
  const Array<HandData>& getHands() const { return arrays().hands; }
  const Array<GestureData>& getGestures() const { return arrays().gestures; }
};

/// Hands that are followed by id, and gestures that ask for it.
class HandTracker : public shared::TrackerOf<shared::HandInterface, HandTracker> {
 public:
  Status setSmoothingFactor(float factor) {
    return static_cast<Status>(niteSetHandSmoothingFactor(handle(), factor));
  }
  float getSmoothingFactor() const {
    float factor = 0.0F;
    return niteGetHandSmoothingFactor(handle(), &factor) == NITE_STATUS_OK ? factor : 0.0F;
  }

  Status startHandTracking(const Point3f& position, HandId* id) {
    return static_cast<Status>(niteStartHandTracking(handle(), &position, id));
  }
  void stopHandTracking(HandId id) { niteStopHandTracking(handle(), id); }
  void stopAllHandTracking() { niteStopAllHandTracking(handle()); }

  Status startGestureDetection(GestureType type) {
    return static_cast<Status>(
        niteStartGestureDetection(handle(), static_cast<NiteGestureType>(type)));
  }
  void stopGestureDetection(GestureType type) {
    niteStopGestureDetection(handle(), static_cast<NiteGestureType>(type));
  }
  void stopAllGestureDetection() { niteStopAllGestureDetection(handle()); }

  Status convertHandCoordinatesToDepth(float x, float y, float z, float* px, float* py) const {
    return static_cast<Status>(niteConvertHandCoordinatesToDepth(handle(), x, y, z, px, py));
  }
  Status convertDepthCoordinatesToHand(int x, int y, int z, float* px, float* py) const {
    return static_cast<Status>(niteConvertDepthCoordinatesToHand(handle(), x, y, z, px, py));
  }
};

/// The library as a whole.
class NiTE {
 public:
  static Status initialize() { return static_cast<Status>(niteInitialize()); }
  static void shutdown() { niteShutdown(); }
  static Version getVersion() { return niteGetVersion(); }

 private:
  NiTE() = default;
};

}  // namespace nite
