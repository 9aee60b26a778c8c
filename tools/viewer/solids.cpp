#include "tools/viewer/solids.h"

#include <fmt/format.h>

#include "physics/anthropometry.h"
#include "recon/bone_lengths.h"
#include "recon/smallest_turn.h"

namespace ossa::viewer {
namespace {

const char* NameOf(physics::Shape shape) {
  if (shape == physics::Shape::kBall) return "ball";
  return shape == physics::Shape::kCapsule ? "capsule" : "box";
}

std::string JsonOf(const Eigen::Vector3d& v) {
  return fmt::format("[{:.4f},{:.4f},{:.4f}]", v.x(), v.y(), v.z());
}

std::string JsonOf(const Solid& solid) {
  const Eigen::Quaterniond& turn = solid.orientation;
  return fmt::format(
      R"({{"shape":"{}","size":{},"at":{},"turn":[{:.5f},{:.5f},{:.5f},{:.5f}],"person":{}}})",
      NameOf(solid.shape), JsonOf(solid.size_m), JsonOf(solid.position_m), turn.x(), turn.y(),
      turn.z(), turn.w(), solid.person);
}

}  // namespace

std::vector<Solid> CapsulesOf(const recon::Posture& posture, int person) {
  std::vector<Solid> capsules;
  for (const Eigen::Vector3d& joint : posture.position_m) {
    if (!joint.allFinite()) return capsules;
  }
  const physics::Segments segments = physics::ComputeSegments(recon::MeasureBoneLengths(posture));
  for (size_t j = 1; j < recon::kJointCount; ++j) {
    const physics::Segment& segment = segments[j];
    const Eigen::Vector3d& from_m = posture.position_m[recon::ParentOf(j)];
    const Eigen::Vector3d way_m = posture.position_m[j] - from_m;
    if (way_m.norm() <= 0.0) continue;  // a bone without length has no direction
    Solid& capsule = capsules.emplace_back();
    capsule.shape = physics::Shape::kCapsule;
    const double share = segment.capsule_to - segment.capsule_from;
    capsule.size_m = {2.0 * segment.radius_m, share * way_m.norm(), 0.0};
    capsule.position_m = from_m + (segment.capsule_from + share / 2.0) * way_m;
    capsule.orientation = recon::SmallestTurn(Eigen::Vector3d::UnitY(), way_m.normalized());
    capsule.person = person;
  }
  return capsules;
}

std::vector<Solid> CapsulesOf(const tracker::BodyFrame& bodies) {
  std::vector<Solid> all;
  for (const tracker::Body& body : bodies.bodies) {
    if (body.state != tracker::BodyState::kTracked) continue;
    const std::vector<Solid> own = CapsulesOf(tracker::ToPosture(body), body.id);
    all.insert(all.end(), own.begin(), own.end());
  }
  return all;
}

std::vector<Solid> SolidsOf(const std::vector<tracker::SceneObjectState>& objects) {
  std::vector<Solid> all;
  for (const tracker::SceneObjectState& object : objects) {
    const physics::ObjectOptions& body = object.body;
    all.push_back({body.shape, body.size_m, object.position_m, object.orientation});
    for (const physics::ObjectPart& part : body.parts) {
      all.push_back({part.shape, part.size_m,
                     object.position_m + object.orientation * part.position_m,
                     object.orientation * part.orientation});
    }
  }
  return all;
}

std::vector<Solid> SolidsOf(const tracker::BodyFrame& frame, bool characters) {
  std::vector<Solid> all = characters ? CapsulesOf(frame) : std::vector<Solid>{};
  const std::vector<Solid> things = SolidsOf(frame.objects);
  all.insert(all.end(), things.begin(), things.end());
  return all;
}

std::string SolidsJson(const std::vector<Solid>& solids) {
  std::string text = "[";
  for (const Solid& solid : solids) {
    if (text.size() > 1) text += ",";
    text += JsonOf(solid);
  }
  return text + "]";
}

}  // namespace ossa::viewer
