#include "tools/tracker/ossa_c.h"

#include <algorithm>
#include <exception>
#include <stdexcept>
#include <string>

#include "tools/tracker/tracker.h"

struct ossa_tracker {
  ossa::tracker::Tracker tracker;
  ossa::tracker::BodyFrame last;
};

namespace {

using ossa::tracker::Body;

// The one thing a C caller cannot be handed otherwise: why its thread's last call failed.
thread_local std::string last_error;

template <typename Call>
int Guarded(const Call& call) {
  try {
    call();
    return 0;
  } catch (const std::exception& error) {
    last_error = error.what();
  } catch (...) {
    last_error = "unknown failure";
  }
  return 1;
}

std::string TextOr(const char* text, const char* otherwise) {
  return text == nullptr ? otherwise : text;
}

ossa::tracker::TrackerOptions OptionsOf(const ossa_options* c) {
  ossa::tracker::TrackerOptions options;
  if (c == nullptr) return options;
  options.model = TextOr(c->model, "");
  options.database = TextOr(c->database, "");
  options.method = TextOr(c->method, "best");
  options.smoothing = ossa::tracker::SmoothingPreset(
      c->smoothing != nullptr ? c->smoothing : ossa::tracker::UsualSmoothing(options.method));
  options.physics = c->physics != 0;
  options.near_range = c->near_range != 0;
  if (c->seated != 0) options.mode = ossa::tracker::TrackingMode::kSeated;
  if (c->max_users != 0) options.max_users = c->max_users;
  if (c->threads != 0) options.threads = c->threads;
  return options;
}

void Copy(const Eigen::Vector3d& from, float* to) {
  for (int i = 0; i < 3; ++i) to[i] = static_cast<float>(from[i]);
}

void Copy(const Eigen::Quaterniond& from, float* to) {
  to[0] = static_cast<float>(from.w());
  to[1] = static_cast<float>(from.x());
  to[2] = static_cast<float>(from.y());
  to[3] = static_cast<float>(from.z());
}

ossa_joint JointOf(const Body& body, const ossa::recon::JointOrientations& hierarchical, size_t j) {
  const ossa::tracker::JointEstimate& estimate = body.joints[j];
  ossa_joint joint{};
  Copy(body.raw.posture.position_m[j], joint.raw_m);
  Copy(body.reconstructed.position_m[j], joint.reconstructed_m);
  Copy(estimate.position_m, joint.smoothed_m);
  Copy(estimate.orientation, joint.absolute_wxyz);
  Copy(hierarchical[j], joint.hierarchical_wxyz);
  joint.confidence = static_cast<float>(estimate.confidence);
  joint.reliability = static_cast<float>(estimate.reliability);
  joint.state = static_cast<int32_t>(estimate.state);
  return joint;
}

ossa_body BodyOf(const Body& body) {
  ossa_body c{};
  c.id = body.id;
  c.state =
      body.state == ossa::tracker::BodyState::kTracked ? OSSA_FULLY_TRACKED : OSSA_POSITION_ONLY;
  Copy(body.position_m, c.position_m);
  c.clipped_edges = body.clipped_edges;
  if (c.state == OSSA_FULLY_TRACKED) {
    const auto hierarchical = ossa::tracker::HierarchicalOrientationsOf(body);
    for (size_t j = 0; j < OSSA_JOINTS; ++j) c.joints[j] = JointOf(body, hierarchical, j);
  }
  return c;
}

ossa_frame FrameOf(const ossa::tracker::BodyFrame& bodies) {
  ossa_frame frame{};
  const size_t count = std::min<size_t>(bodies.bodies.size(), OSSA_MOST_BODIES);
  frame.body_count = static_cast<int32_t>(count);
  for (size_t i = 0; i < count; ++i) frame.bodies[i] = BodyOf(bodies.bodies[i]);
  if (bodies.floor) {
    frame.has_floor = 1;
    for (int i = 0; i < 4; ++i) frame.floor[i] = static_cast<float>((*bodies.floor)[i]);
    frame.tilt_down_rad = static_cast<float>(bodies.tilt_down_rad.value_or(0.0));
  }
  frame.users = bodies.users.data.data();
  return frame;
}

}  // namespace

ossa_tracker* ossa_tracker_create(const ossa_options* options) {
  ossa_tracker* tracker = nullptr;
  Guarded([&] { tracker = new ossa_tracker{ossa::tracker::Tracker(OptionsOf(options)), {}}; });
  return tracker;
}

void ossa_tracker_destroy(ossa_tracker* tracker) { delete tracker; }

int ossa_tracker_push(ossa_tracker* tracker, const uint16_t* depth_mm, const ossa_camera* camera,
                      double time_s, ossa_frame* frame) {
  return Guarded([&] {
    if (tracker == nullptr || depth_mm == nullptr || camera == nullptr || frame == nullptr)
      throw std::invalid_argument("ossa_tracker_push: expected no null argument");
    ossa::depth::DepthFrame depth;
    depth.camera = {camera->width, camera->height, camera->fx, camera->fy, camera->cx, camera->cy};
    ossa::depth::CheckCamera(depth.camera, "ossa_tracker_push: camera");  // before depth_mm is read
    depth.time_s = time_s;
    depth.index = tracker->last.index + 1;
    const auto pixels = static_cast<size_t>(camera->width) * static_cast<size_t>(camera->height);
    depth.depth_mm.assign(depth_mm, depth_mm + pixels);
    tracker->last = tracker->tracker.Track(depth);
    *frame = FrameOf(tracker->last);
  });
}

int ossa_tracker_choose_users(ossa_tracker* tracker, const int32_t* ids, int32_t count) {
  return Guarded([&] {
    if (tracker == nullptr || (ids == nullptr && count > 0))
      throw std::invalid_argument("ossa_tracker_choose_users: expected no null argument");
    if (count < 0) {
      tracker->tracker.ChooseAllUsers();
    } else {
      tracker->tracker.ChooseUsers(std::vector<int>(ids, ids + count));
    }
  });
}

int ossa_tracker_set_seated(ossa_tracker* tracker, int32_t seated) {
  using ossa::tracker::TrackingMode;
  return Guarded([&] {
    if (tracker == nullptr)
      throw std::invalid_argument("ossa_tracker_set_seated: expected no null argument");
    tracker->tracker.SetMode(seated != 0 ? TrackingMode::kSeated : TrackingMode::kStanding);
  });
}

int ossa_tracker_set_smoothing(ossa_tracker* tracker, const char* preset) {
  return Guarded([&] {
    if (tracker == nullptr || preset == nullptr)
      throw std::invalid_argument("ossa_tracker_set_smoothing: expected no null argument");
    tracker->tracker.SetSmoothing(ossa::tracker::SmoothingPreset(preset));
  });
}

int ossa_tracker_set_smooth_parameters(ossa_tracker* tracker,
                                       const ossa_smooth_parameters* parameters) {
  return Guarded([&] {
    if (tracker == nullptr || parameters == nullptr)
      throw std::invalid_argument("ossa_tracker_set_smooth_parameters: expected no null argument");
    ossa::tracker::SmoothingOptions options;
    options.kind = ossa::tracker::SmoothingKind::kHolt;
    options.holt.smoothing = static_cast<double>(parameters->smoothing);
    options.holt.correction = static_cast<double>(parameters->correction);
    options.holt.prediction = static_cast<double>(parameters->prediction);
    options.holt.jitter_radius_m = static_cast<double>(parameters->jitter_radius_m);
    options.holt.max_deviation_radius_m = static_cast<double>(parameters->max_deviation_radius_m);
    tracker->tracker.SetSmoothing(options);
  });
}

const char* ossa_last_error(void) { return last_error.c_str(); }
