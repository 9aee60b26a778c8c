#include "tools/tracker/skeleton_record.h"

#include <algorithm>
#include <array>
#include <string>

#include "depth/base/error.h"

namespace ossa::tracker {
namespace {

// Whether joints are single-frame observations.
bool IsSingleFrame(PostureKind kind) {
  return kind == PostureKind::kRaw || kind == PostureKind::kRefined;
}

recon::Posture ToPosture(const Body& body, PostureKind kind) {
  if (kind == PostureKind::kFitted && body.fit) return body.fit->joints_m;
  if (kind == PostureKind::kRefined && body.refined) return *body.refined;
  if (IsSingleFrame(kind)) return body.raw.posture;
  return kind == PostureKind::kReconstructed ? body.reconstructed : ToPosture(body);
}

recon::BodyRecord ToRecord(const Body& body, PostureKind kind) {
  recon::BodyRecord record;
  record.id = body.id;
  if (kind == PostureKind::kFitted && !body.fit) return record;
  const recon::Posture posture = ToPosture(body, kind);
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    const bool absent =
        IsSingleFrame(kind) && body.joints[j].state == recon::TrackingState::kNotTracked;
    if (absent || !posture.position_m[j].allFinite()) continue;
    recon::JointRecord joint;
    joint.position_m = posture.position_m[j];
    joint.state = body.joints[j].state;
    joint.confidence = body.joints[j].confidence;
    joint.reliability = body.joints[j].reliability;
    if (kind == PostureKind::kFinal) joint.orientation = body.joints[j].orientation;
    if (kind == PostureKind::kFitted) {
      joint.sigma_m = body.fit->covariance_m2[j].diagonal().cwiseSqrt();
    }
    record.joints[j] = joint;
  }
  if (kind == PostureKind::kRefined && body.refined) record.bones_m = body.refined_bones_m;
  return record;
}

}  // namespace

PostureKind ParsePostureKind(std::string_view name) {
  constexpr std::array<std::string_view, 5> kNames = {"final", "reconstructed", "fitted", "refined",
                                                      "raw"};
  const auto known = std::find(kNames.begin(), kNames.end(), name);
  if (known != kNames.end()) return static_cast<PostureKind>(known - kNames.begin());
  throw InputError("posture: expected final, reconstructed, fitted, refined or raw, found '" +
                   std::string(name) + "'");
}

void KeepSeatedJoints(recon::SkeletonFrame& record) {
  for (recon::BodyRecord& body : record.bodies) {
    for (size_t j = 0; j < recon::kJointCount; ++j) {
      if (!IsSeatedJoint(static_cast<recon::Joint>(j))) body.joints[j].reset();
    }
  }
}

recon::SkeletonFrame ToRecord(const BodyFrame& frame, PostureKind kind) {
  recon::SkeletonFrame record;
  record.frame = frame.index;
  record.time_s = frame.time_s;
  record.floor = frame.floor;
  for (const Body& body : frame.bodies) {
    if (body.state == BodyState::kTracked) record.bodies.push_back(ToRecord(body, kind));
  }
  if (kind == PostureKind::kFinal) record.objects = ToRecords(frame.objects);
  return record;
}

}  // namespace ossa::tracker
