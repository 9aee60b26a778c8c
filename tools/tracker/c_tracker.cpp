// The tracker behind ossa_c.h.
#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "depth/base/error.h"
#include "tools/tracker/c_interface_internal.h"
#include "tools/tracker/tracker.h"

struct ossa_tracker {
  ossa::tracker::Tracker tracker;
  ossa::tracker::BodyFrame last;
};

namespace {

using ossa::tracker::Body;
using ossa::tracker::BodyFrame;
using ossa::tracker::FillStruct;
using ossa::tracker::Guarded;
using ossa::tracker::ReadStruct;
using ossa::tracker::RequireNotNull;

// A member added to a struct must lie behind all that older programs know of it, padding included.
template <typename T, typename Last>
constexpr bool EndsWith(size_t offset) {
  return offset + sizeof(Last) == sizeof(T);
}
static_assert(EndsWith<ossa_options, const char*>(offsetof(ossa_options, mount)));
static_assert(EndsWith<ossa_source_options, double>(offsetof(ossa_source_options, wait_s)));
static_assert(EndsWith<ossa_depth_image, double>(offsetof(ossa_depth_image, time_s)));
static_assert(EndsWith<ossa_body, float[OSSA_JOINT_COUNT][3]>(offsetof(ossa_body,
                                                                       reconstructed_m)));
static_assert(EndsWith<ossa_frame, const uint8_t*>(offsetof(ossa_frame, users)));
static_assert(EndsWith<ossa_smooth_parameters, float>(offsetof(ossa_smooth_parameters,
                                                               max_deviation_radius_m)));

static_assert(OSSA_JOINT_COUNT == ossa::recon::kJointCount);
static_assert(OSSA_FOOT_RIGHT == static_cast<int>(ossa::recon::Joint::kFootRight));

std::string TextOr(const char* text, const char* otherwise) {
  return text == nullptr ? otherwise : text;
}

// Files that a method does not read would be left out in silence; as Python's, the call fails.
void CheckFilesAreRead(const ossa::tracker::ModelFiles& files, const std::string& method) {
  const ossa::recon::MethodInfo& info = ossa::recon::RequireMethod(method);
  const auto check = [&](const std::string& file, bool is_read, const char* member) {
    if (is_read || file.empty() || file == "none") return;
    throw ossa::InputError("ossa_options." + std::string(member) +
                           ": expected a method that reads it, found '" + method + "'");
  };
  check(files.learned, info.learned != ossa::recon::Reads::kNothing, "learned");
  check(files.prior, info.prior, "prior");
  check(files.database, info.database != ossa::recon::Reads::kNothing, "database");
}

/// One of `names`, by its number. Throws InputError for another.
template <typename Choice, size_t N>
Choice ChoiceFrom(const std::array<std::string_view, N>& names, const std::string& given,
                  const char* member) {
  const auto known = std::find(names.begin(), names.end(), given);
  if (known != names.end()) return static_cast<Choice>(known - names.begin());
  std::string expected;
  for (const std::string_view name : names)
    expected.append(expected.empty() ? "" : ", ").append(name);
  throw ossa::InputError("ossa_options." + std::string(member) + ": expected " + expected +
                         ", found '" + given + "'");
}

ossa::tracker::Turn TurnFrom(const std::string& rotate) {
  constexpr std::array<std::string_view, 5> kNames = {"0", "90", "180", "270", "auto"};
  return ChoiceFrom<ossa::tracker::Turn>(kNames, rotate, "rotate");
}

ossa::tracker::Mount MountFrom(const std::string& mount) {
  constexpr std::array<std::string_view, 3> kNames = {"auto", "level", "ceiling"};
  return ChoiceFrom<ossa::tracker::Mount>(kNames, mount, "mount");
}

ossa::tracker::TrackerOptions OptionsFrom(const ossa_options* given) {
  ossa::tracker::TrackerOptions options;
  if (given == nullptr) return options;
  const ossa_options c = ReadStruct(*given, "ossa_options", {offsetof(ossa_options, rotate)});
  if (c.method != nullptr) options.method = c.method;
  ossa::tracker::ModelFiles files;
  files.forest = TextOr(c.model, "");
  files.refinement = TextOr(c.refinement, "");
  files.learned = TextOr(c.learned, "");
  files.prior = TextOr(c.prior, "");
  files.database = TextOr(c.database, "");
  CheckFilesAreRead(files, options.method);
  options.models = ossa::tracker::ModelSet::Load(files, options.method);
  if (c.smoothing != nullptr) options.smoothing = ossa::tracker::SmoothingPreset(c.smoothing);
  options.physics = c.physics != 0;
  options.near_range = c.near_range != 0;
  if (c.seated != 0) options.mode = ossa::tracker::TrackingMode::kSeated;
  if (c.max_users != 0) options.max_users = c.max_users;
  if (c.threads != 0) options.threads = c.threads;
  options.turn = TurnFrom(TextOr(c.rotate, "0"));
  options.mount = MountFrom(TextOr(c.mount, "auto"));
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

ossa_joint JointFrom(const ossa::tracker::JointEstimate& estimate) {
  ossa_joint joint{};
  Copy(estimate.position_m, joint.position_m);
  Copy(estimate.orientation, joint.orientation_wxyz);
  joint.confidence = static_cast<float>(estimate.confidence);
  joint.reliability = static_cast<float>(estimate.reliability);
  joint.state = static_cast<int32_t>(estimate.state);
  return joint;
}

ossa_body BodyFrom(const Body& body) {
  ossa_body c{};
  c.id = body.id;
  Copy(body.position_m, c.position_m);
  c.clipped_edges = body.clipped_edges;
  if (body.state != ossa::tracker::BodyState::kTracked) return c;
  c.state = OSSA_FULLY_TRACKED;
  const auto hierarchical = ossa::tracker::ComputeHierarchicalOrientations(body);
  const ossa::recon::Posture& refined = body.refined ? *body.refined : body.raw.posture;
  for (size_t j = 0; j < OSSA_JOINT_COUNT; ++j) {
    c.joints[j] = JointFrom(body.joints[j]);
    Copy(hierarchical[j], c.hierarchical_wxyz[j]);
    Copy(body.raw.posture.position_m[j], c.raw_m[j]);
    Copy(refined.position_m[j], c.refined_m[j]);
    Copy(body.reconstructed.position_m[j], c.reconstructed_m[j]);
  }
  return c;
}

ossa_frame FrameFrom(const BodyFrame& bodies) {
  ossa_frame frame{};
  frame.body_count = static_cast<int32_t>(bodies.bodies.size());
  frame.time_s = bodies.time_s;
  if (bodies.floor) {
    frame.has_floor = 1;
    for (int i = 0; i < 4; ++i) frame.floor[i] = static_cast<float>((*bodies.floor)[i]);
    frame.tilt_down_rad = static_cast<float>(bodies.tilt_down_rad.value_or(0.0));
  }
  frame.users = bodies.users.data.data();
  return frame;
}

// Checked before a pixel is read: the camera says how many there are.
ossa::depth::DepthFrame DepthFrom(const ossa_depth_image& given, int64_t index) {
  const ossa_depth_image image = ReadStruct(given, "ossa_depth_image");
  RequireNotNull(image.depth_mm, "ossa_tracker_track", "depths");
  ossa::depth::DepthFrame frame;
  frame.camera = {image.width, image.height, image.fx, image.fy, image.cx, image.cy};
  ossa::depth::CheckCamera(frame.camera, "ossa_depth_image");
  frame.time_s = image.time_s;
  frame.index = index;
  frame.borrowed = {image.depth_mm, image.width, image.height, image.width};
  return frame;
}

// A call that changes a tracker and cannot but succeed, once there is one.
template <typename Change>
ossa_status Changed(ossa_tracker* tracker, const char* call, const Change& change) {
  return Guarded([&] {
    RequireNotNull(tracker, call, "a tracker");
    change(tracker->tracker);
    return OSSA_OK;
  });
}

}  // namespace

std::string& ossa::tracker::LastError() {
  thread_local std::string last;
  return last;
}

const char* ossa_last_error(void) { return ossa::tracker::LastError().c_str(); }

const char* ossa_version(void) { return ossa::tracker::Version(); }

const char* ossa_joint_name(int32_t joint) {
  const bool is_one = joint >= 0 && joint < OSSA_JOINT_COUNT;
  return is_one ? ossa::recon::kJointNames[static_cast<size_t>(joint)].data() : nullptr;
}

int32_t ossa_joint_parent(int32_t joint) {
  const bool is_one = joint >= 0 && joint < OSSA_JOINT_COUNT;
  return is_one ? ossa::recon::kJointParent[static_cast<size_t>(joint)] : -1;
}

ossa_tracker* ossa_tracker_create(const ossa_options* options) {
  ossa_tracker* tracker = nullptr;
  Guarded([&] {
    tracker = new ossa_tracker{ossa::tracker::Tracker(OptionsFrom(options)), {}};
    return OSSA_OK;
  });
  return tracker;
}

void ossa_tracker_destroy(ossa_tracker* tracker) { delete tracker; }

ossa_status ossa_tracker_track(ossa_tracker* tracker, const ossa_depth_image* image,
                               ossa_frame* frame) {
  return Guarded([&] {
    RequireNotNull(tracker, "ossa_tracker_track", "a tracker");
    RequireNotNull(image, "ossa_tracker_track", "an image");
    RequireNotNull(frame, "ossa_tracker_track", "a frame");
    ossa::tracker::CheckSize(*frame, "ossa_frame");  // before anything moves on in time
    tracker->last = tracker->tracker.Track(DepthFrom(*image, tracker->last.index + 1));
    FillStruct(FrameFrom(tracker->last), "ossa_frame", frame);
    return OSSA_OK;
  });
}

ossa_status ossa_tracker_body(const ossa_tracker* tracker, int32_t place, ossa_body* body) {
  return Guarded([&] {
    RequireNotNull(tracker, "ossa_tracker_body", "a tracker");
    RequireNotNull(body, "ossa_tracker_body", "a body");
    const auto count = static_cast<int32_t>(tracker->last.bodies.size());
    if (place < 0 || place >= count) {
      throw std::invalid_argument(
          "ossa_tracker_body: expected a place below the frame's body_count, " +
          std::to_string(count) + ", found " + std::to_string(place));
    }
    FillStruct(BodyFrom(tracker->last.bodies[static_cast<size_t>(place)]), "ossa_body", body);
    return OSSA_OK;
  });
}

int32_t ossa_tracker_rotation(const ossa_tracker* tracker) {
  constexpr int32_t kQuarter_deg = 90;  // by definition
  return tracker == nullptr ? 0 : kQuarter_deg * tracker->tracker.quarter_turns();
}

ossa_status ossa_tracker_reset(ossa_tracker* tracker) {
  return Guarded([&] {
    RequireNotNull(tracker, "ossa_tracker_reset", "a tracker");
    tracker->tracker.Reset();
    tracker->last = {};
    return OSSA_OK;
  });
}

ossa_status ossa_tracker_choose_users(ossa_tracker* tracker, const int32_t* ids, int32_t count) {
  return Changed(tracker, "ossa_tracker_choose_users", [&](ossa::tracker::Tracker& changed) {
    if (count < 0) {
      changed.ChooseAllUsers();
      return;
    }
    if (count > 0) RequireNotNull(ids, "ossa_tracker_choose_users", "ids");
    changed.ChooseUsers(std::vector<int>(ids, ids + count));
  });
}

ossa_status ossa_tracker_set_seated(ossa_tracker* tracker, int32_t seated) {
  using ossa::tracker::TrackingMode;
  return Changed(tracker, "ossa_tracker_set_seated", [&](ossa::tracker::Tracker& changed) {
    changed.SetMode(seated != 0 ? TrackingMode::kSeated : TrackingMode::kStanding);
  });
}

ossa_status ossa_tracker_set_smoothing(ossa_tracker* tracker, const char* preset) {
  return Changed(tracker, "ossa_tracker_set_smoothing", [&](ossa::tracker::Tracker& changed) {
    RequireNotNull(preset, "ossa_tracker_set_smoothing", "a preset");
    changed.SetSmoothing(ossa::tracker::SmoothingPreset(preset));
  });
}

ossa_status ossa_tracker_set_smooth_parameters(ossa_tracker* tracker,
                                               const ossa_smooth_parameters* parameters) {
  const char* call = "ossa_tracker_set_smooth_parameters";
  return Changed(tracker, call, [&](ossa::tracker::Tracker& changed) {
    RequireNotNull(parameters, call, "parameters");
    const auto given = ReadStruct(*parameters, "ossa_smooth_parameters");
    ossa::tracker::SmoothingOptions options;
    options.kind = ossa::tracker::SmoothingKind::kHolt;
    options.holt.smoothing = static_cast<double>(given.smoothing);
    options.holt.correction = static_cast<double>(given.correction);
    options.holt.prediction = static_cast<double>(given.prediction);
    options.holt.jitter_radius_m = static_cast<double>(given.jitter_radius_m);
    options.holt.max_deviation_radius_m = static_cast<double>(given.max_deviation_radius_m);
    changed.SetSmoothing(options);
  });
}
