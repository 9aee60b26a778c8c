// The tracker behind ossa_c.h.
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "depth/base/error.h"
#include "recon/body/parts.h"
#include "tools/tracker/body_mesh_file.h"
#include "tools/tracker/c_interface_internal.h"
#include "tools/tracker/c_tracker_internal.h"

namespace {

using ossa::tracker::Body;
using ossa::tracker::BodyFrame;
using ossa::tracker::FillStruct;
using ossa::tracker::Guarded;
using ossa::tracker::ReadStruct;
using ossa::tracker::RequireNotNull;
using ossa::tracker::RequirePlace;
using ossa::tracker::TextOr;

// Checked before a pixel is read, because the camera determines their number.
ossa::depth::DepthFrame DepthFrom(const ossa_depth_image& given, int64_t index) {
  const ossa_depth_image image = ReadStruct(given);
  RequireNotNull(image.depth_mm, "ossa_tracker_track", "depths");
  ossa::depth::DepthFrame frame;
  frame.camera = ossa::tracker::CameraFrom(image);
  frame.time_s = image.time_s;
  frame.index = index;
  frame.borrowed = {image.depth_mm, image.width, image.height, image.width};
  return frame;
}

/// Returns a frame and keeps it for later calls. Without `bodies`: an empty frame and the status
/// `otherwise`.
ossa_status ReturnFrame(std::optional<BodyFrame> bodies, ossa_status otherwise,
                        ossa_tracker& tracker, ossa_frame* frame) {
  const ossa_status status = bodies ? OSSA_OK : otherwise;
  tracker.last = bodies ? std::move(*bodies) : BodyFrame{};
  FillStruct(FrameFrom(tracker.last, tracker.tracker.mount()), frame);
  return status;
}

/// A body of the last frame. Throws if there is none at this index.
const Body& BodyAt(const ossa_tracker* tracker, int32_t place, const char* call) {
  RequireNotNull(tracker, call, "a tracker");
  RequirePlace(place, tracker->last.bodies.size(), call, "body_count");
  return tracker->last.bodies[static_cast<size_t>(place)];
}

/// The skin of the fitted surface, loaded once. Throws InputError if there is none.
const ossa::recon::BodyMesh& FindMesh(ossa_tracker& tracker) {
  if (tracker.mesh) return *tracker.mesh;
  const bool has_any = tracker.surface != nullptr && tracker.mesh_file != "none";
  if (!has_any) {
    throw ossa::InputError("ossa_tracker_skin: expected a surface and its skin, found 'none'");
  }
  if (!tracker.surface_file.empty() && tracker.mesh_file.empty()) {
    throw ossa::InputError("ossa_tracker_skin: expected ossa_options.mesh, the skin of " +
                           tracker.surface_file + ", found NULL");
  }
  tracker.mesh = ossa::tracker::LoadBodyMesh(tracker.surface_file, tracker.mesh_file);
  return *tracker.mesh;
}

/// The skin in the fitted pose; without vertices if the body was not fitted.
ossa_skin PoseSkin(const Body& body, const ossa::recon::BodyMesh& mesh,
                   std::vector<float>& vertices_m) {
  static_assert(sizeof(ossa::recon::MeshTriangle) == 3 * sizeof(uint32_t));
  ossa_skin skin{};
  skin.body_id = body.id;
  skin.triangle_count = static_cast<int32_t>(mesh.triangles.size());
  if (!mesh.triangles.empty()) skin.triangles = mesh.triangles.front().data();
  if (!body.fit) return skin;
  vertices_m.clear();
  for (const Eigen::Vector3d& place_m : PoseMesh(mesh, body.fit->pose)) {
    for (const double x_m : place_m) vertices_m.push_back(static_cast<float>(x_m));
  }
  skin.vertex_count = static_cast<int32_t>(mesh.vertices.size());
  skin.vertices_m = vertices_m.data();
  return skin;
}

// A call that changes a tracker.
template <typename Change>
ossa_status Changed(ossa_tracker* tracker, const char* call, const Change& change) {
  return Guarded([&] {
    RequireNotNull(tracker, call, "a tracker");
    change(tracker->tracker);
    return OSSA_OK;
  });
}

}  // namespace

namespace ossa::tracker {
namespace {

// A plain array, which is valid until the thread ends, whatever is destroyed before.
constexpr size_t kLongestError = 8192;  // bytes; by hand: two of the longest paths
thread_local char last_error[kLongestError] = "";

}  // namespace

const char* LastError() { return last_error; }

void SetLastError(const char* text) noexcept {
  std::snprintf(last_error, kLongestError, "%s", text);
}

}  // namespace ossa::tracker

ossa_tracker::ossa_tracker(const ossa::tracker::TrackerOptions& options, std::string surface,
                           std::string mesh)
    : tracker(options),
      is_seated(options.mode == ossa::tracker::TrackingMode::kSeated),
      surface_file(std::move(surface)),
      mesh_file(std::move(mesh)) {
  if (!options.models) return;
  this->surface = options.models->surface;
  warnings.assign(options.models->warnings.begin(), options.models->warnings.end());
}

const char* ossa_last_error(void) { return ossa::tracker::LastError(); }

const char* ossa_version(void) { return ossa::tracker::Version(); }

const char* ossa_joint_name(int32_t joint) {
  const bool is_one = joint >= 0 && joint < OSSA_JOINT_COUNT;
  return is_one ? ossa::recon::kJointNames[static_cast<size_t>(joint)].data() : nullptr;
}

int32_t ossa_joint_parent(int32_t joint) {
  const bool is_one = joint >= 0 && joint < OSSA_JOINT_COUNT;
  return is_one ? ossa::recon::kJointParent[static_cast<size_t>(joint)] : -1;
}

const char* ossa_part_name(int32_t label) {
  const bool is_one = label >= 0 && label < ossa::recon::kLabelCount;
  return is_one ? ossa::recon::kPartNames[static_cast<size_t>(label)].data() : nullptr;
}

ossa_tracker* ossa_tracker_create(const ossa_options* options) {
  ossa_tracker* tracker = nullptr;
  Guarded([&] {
    ossa_options given{};
    if (options != nullptr) given = ReadStruct(*options);
    auto made = std::make_unique<ossa_tracker>(ossa::tracker::OptionsFrom(given),
                                               TextOr(given.surface, ""), TextOr(given.mesh, ""));
    const bool is_named = !made->mesh_file.empty() && made->mesh_file != "none";
    if (is_named) FindMesh(*made);  // reports a bad file now
    tracker = made.release();
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
    ossa::tracker::CheckSize(*frame);  // before the tracker's state changes
    auto bodies = tracker->tracker.TrackWithLag(DepthFrom(*image, tracker->images));
    ++tracker->images;
    return ReturnFrame(std::move(bodies), OSSA_HELD, *tracker, frame);
  });
}

ossa_status ossa_tracker_drain_lag(ossa_tracker* tracker, ossa_frame* frame) {
  return Guarded([&] {
    RequireNotNull(tracker, "ossa_tracker_drain_lag", "a tracker");
    RequireNotNull(frame, "ossa_tracker_drain_lag", "a frame");
    ossa::tracker::CheckSize(*frame);
    return ReturnFrame(tracker->tracker.DrainLag(), OSSA_END, *tracker, frame);
  });
}

ossa_status ossa_tracker_find_upright(ossa_tracker* tracker, ossa_source* source) {
  return Guarded([&] {
    RequireNotNull(tracker, "ossa_tracker_find_upright", "a tracker");
    RequireNotNull(source, "ossa_tracker_find_upright", "a source");
    tracker->tracker.FindUpright(ossa::tracker::FramesOf(*source),
                                 ossa::tracker::KeepWaitingFor(*source));
    return OSSA_OK;
  });
}

ossa_status ossa_tracker_body(const ossa_tracker* tracker, int32_t place, ossa_body* body) {
  return Guarded([&] {
    const Body& of_frame = BodyAt(tracker, place, "ossa_tracker_body");
    RequireNotNull(body, "ossa_tracker_body", "a body");
    FillStruct(BodyFrom(of_frame, tracker->surface.get()), body);
    return OSSA_OK;
  });
}

ossa_status ossa_tracker_skin(ossa_tracker* tracker, int32_t place, ossa_skin* skin) {
  return Guarded([&] {
    const Body& body = BodyAt(tracker, place, "ossa_tracker_skin");
    RequireNotNull(skin, "ossa_tracker_skin", "a skin");
    FillStruct(PoseSkin(body, FindMesh(*tracker), tracker->skin_m), skin);
    return OSSA_OK;
  });
}

ossa_status ossa_tracker_save_person(const ossa_tracker* tracker, int32_t place, const char* path) {
  return Guarded([&] {
    const Body& body = BodyAt(tracker, place, "ossa_tracker_save_person");
    RequireNotNull(path, "ossa_tracker_save_person", "a path");
    if (!body.shape || tracker->surface == nullptr) {
      throw ossa::InputError(std::string(path) +
                             ": expected a person to whom a body was fitted, found none; not "
                             "written");
    }
    body.shape->Save(path, *tracker->surface);
    return OSSA_OK;
  });
}

ossa_status ossa_tracker_object(const ossa_tracker* tracker, int32_t place, ossa_object* object) {
  return Guarded([&] {
    RequireNotNull(tracker, "ossa_tracker_object", "a tracker");
    RequireNotNull(object, "ossa_tracker_object", "an object");
    RequirePlace(place, tracker->last.objects.size(), "ossa_tracker_object", "object_count");
    FillStruct(ossa::tracker::ObjectFrom(tracker->last.objects[static_cast<size_t>(place)]),
               object);
    return OSSA_OK;
  });
}

const char* ossa_tracker_take_note(ossa_tracker* tracker, int32_t* kind) {
  if (tracker == nullptr) return nullptr;
  if (auto warning = tracker->tracker.TakeWarning()) tracker->warnings.push_back(*warning);
  if (tracker->warnings.empty()) return nullptr;
  tracker->taken_note = std::move(tracker->warnings.front());
  tracker->warnings.pop_front();
  if (kind != nullptr) *kind = OSSA_NOTE_WARNING;
  return tracker->taken_note.c_str();
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
    tracker->images = 0;
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
    tracker->is_seated = seated != 0;
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
    const auto given = ReadStruct(*parameters);
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
