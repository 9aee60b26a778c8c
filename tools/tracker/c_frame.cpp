// Conversion of results to the structs of ossa_c.h.
#include <algorithm>

#include "tools/tracker/c_interface_internal.h"
#include "tools/tracker/c_tracker_internal.h"

namespace ossa::tracker {
namespace {

static_assert(OSSA_JOINT_COUNT == recon::kJointCount);
static_assert(OSSA_FOOT_RIGHT == static_cast<int>(recon::Joint::kFootRight));
static_assert(OSSA_NOT_TRACKED == static_cast<int>(recon::TrackingState::kNotTracked));
static_assert(OSSA_INFERRED == static_cast<int>(recon::TrackingState::kInferred));
static_assert(OSSA_TRACKED == static_cast<int>(recon::TrackingState::kTracked));
static_assert(OSSA_POSITION_ONLY == static_cast<int>(BodyState::kPositionOnly));
static_assert(OSSA_FULLY_TRACKED == static_cast<int>(BodyState::kTracked));

void Copy(const Eigen::Quaterniond& from, float* to) {
  to[0] = static_cast<float>(from.w());
  to[1] = static_cast<float>(from.x());
  to[2] = static_cast<float>(from.y());
  to[3] = static_cast<float>(from.z());
}

ossa_joint JointFrom(const JointEstimate& estimate) {
  ossa_joint joint{};
  CopyVector(estimate.position_m, joint.position_m);
  Copy(estimate.orientation, joint.orientation_wxyz);
  joint.confidence = static_cast<float>(estimate.confidence);
  joint.reliability = static_cast<float>(estimate.reliability);
  joint.state = static_cast<int32_t>(estimate.state);
  return joint;
}

void Copy(const recon::Posture& from, float (*to)[3]) {
  for (size_t j = 0; j < OSSA_JOINT_COUNT; ++j) CopyVector(from.position_m[j], to[j]);
}

// Results of the earlier stages, and bone lengths.
void AddStages(const Body& body, ossa_body& c) {
  Copy(body.raw.posture, c.raw_m);
  Copy(body.refined ? *body.refined : body.raw.posture, c.refined_m);
  Copy(body.reconstructed, c.reconstructed_m);
  if (!body.bones_m) return;
  c.has_bones = 1;
  for (size_t j = 0; j < OSSA_JOINT_COUNT; ++j) {
    c.bones_m[j] = static_cast<float>((*body.bones_m)[j]);
  }
}

void AddFit(const Body& body, const recon::BodySurface* surface, ossa_body& c) {
  if (body.fit) {
    c.has_fit = 1;
    Copy(body.fit->joints_m, c.fitted_m);
    c.explained = static_cast<float>(body.fit->explained);
    c.fit_score = static_cast<float>(body.fit->score);
  }
  if (!body.shape || surface == nullptr) return;
  const recon::Stature stature = recon::MeasureStature(*body.shape, *surface);
  c.has_stature = 1;
  c.stature_m = static_cast<float>(stature.stature_m);
  c.stature_sigma_m = static_cast<float>(stature.sigma_m);
}

}  // namespace

ossa_body BodyFrom(const Body& body, const recon::BodySurface* surface) {
  ossa_body c{};
  c.id = body.id;
  CopyVector(body.position_m, c.position_m);
  c.clipped_edges = body.clipped_edges;
  c.person_score = static_cast<float>(body.person_score);
  if (body.state != BodyState::kTracked) return c;
  c.state = OSSA_FULLY_TRACKED;
  const auto hierarchical = ComputeHierarchicalOrientations(body);
  for (size_t j = 0; j < OSSA_JOINT_COUNT; ++j) {
    c.joints[j] = JointFrom(body.joints[j]);
    Copy(hierarchical[j], c.hierarchical_wxyz[j]);
  }
  AddStages(body, c);
  AddFit(body, surface, c);
  return c;
}

ossa_frame FrameFrom(const BodyFrame& bodies, Mount mount) {
  ossa_frame frame{};
  frame.body_count = static_cast<int32_t>(bodies.bodies.size());
  frame.time_s = bodies.time_s;
  if (bodies.floor) {
    frame.has_floor = 1;
    for (int i = 0; i < 4; ++i) frame.floor[i] = static_cast<float>((*bodies.floor)[i]);
    frame.tilt_down_rad = static_cast<float>(bodies.tilt_down_rad.value_or(0.0));
  }
  frame.users = bodies.users.data.data();
  frame.index = bodies.index;
  if (!bodies.parts.data.empty()) frame.parts = bodies.parts.data.data();
  frame.width = bodies.users.width;
  frame.height = bodies.users.height;
  frame.object_count = static_cast<int32_t>(bodies.objects.size());
  frame.under_ceiling = mount == Mount::kCeiling ? 1 : 0;
  return frame;
}

ossa_object ObjectFrom(const SceneObjectState& object) {
  ossa_object c{};
  c.name = object.name.c_str();
  CopyVector(object.position_m, c.position_m);
  Copy(object.orientation, c.orientation_wxyz);
  CopyVector(object.velocity_m_s, c.velocity_m_s);
  const size_t holders = std::min<size_t>(object.held_by.size(), OSSA_MAX_BODIES);
  std::copy_n(object.held_by.begin(), holders, c.held_by);
  c.held_by_count = static_cast<int32_t>(holders);
  return c;
}

}  // namespace ossa::tracker
