#include "tools/tracker/person_internal.h"

#include <algorithm>
#include <chrono>

#include "recon/orientation.h"

namespace ossa::tracker {
namespace {

using Clock = std::chrono::steady_clock;
using recon::kJointCount;
using recon::TrackingState;

double MillisecondsSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// Neither reconstruction nor mechanics may drag a joint away from where it is seen: tracked joints
// keep within 2 cm of the image, 6 cm when their reliability is nil. Inferred ones are off by 3 to
// 12 cm where the forest trusts them by 0.9 to 0 (rendered rooms), and may move by twice that.
// Joints below them on the limb that are not seen move along, so that the limb keeps its shape.
recon::Posture HeldToImage(const recon::Posture& posture, const Body& body) {
  recon::Posture held = posture;
  for (size_t j = 0; j < kJointCount; ++j) {
    const int parent = recon::kJointParent[j];
    if (body.raw.state[j] != TrackingState::kNotTracked) {
      const Eigen::Vector3d& seen = body.raw.posture.position_m[j];
      const bool tracked = body.raw.state[j] == TrackingState::kTracked;
      const double radius_m =
          tracked ? 0.02 + 0.04 * (1.0 - std::clamp(body.reliability[j], 0.0, 1.0))
                  : 0.06 + 0.18 * (1.0 - std::clamp(body.raw.confidence[j], 0.0, 1.0));
      const Eigen::Vector3d off = posture.position_m[j] - seen;
      const double share = off.norm() > radius_m ? radius_m / off.norm() : 1.0;
      held.position_m[j] = seen + off * share;
    } else if (parent >= 0) {
      const auto p = static_cast<size_t>(parent);
      held.position_m[j] = held.position_m[p] + (posture.position_m[j] - posture.position_m[p]);
    }
  }
  return held;
}

bool AllFinite(const recon::Posture& posture) {
  return std::all_of(posture.position_m.begin(), posture.position_m.end(),
                     [](const Eigen::Vector3d& p) { return p.allFinite(); });
}

recon::Posture WithMechanics(const recon::Posture& target, const Body& body,
                             const std::optional<Eigen::Vector4d>& floor, double time_s,
                             bool motors, Person& person) {
  if (!person.character) {
    const recon::BoneLengths lengths_m = recon::BoneLengthsOf(target);
    const bool sane = std::all_of(lengths_m.begin() + 1, lengths_m.end(),
                                  [](double l) { return l > 0.01 && l < 2.0; });
    if (!sane) return target;
    physics::CharacterFilterOptions filter;
    if (motors) filter.control = physics::Control::kMotor;
    person.character = std::make_unique<physics::CharacterFilter>(lengths_m, filter);
    person.character_s = time_s - 1.0 / 30.0;
  }
  const double dt_s = time_s - person.character_s;
  person.character_s = time_s;
  if (dt_s <= 0) return target;
  const auto filtered = person.character->Step(target, body.reliability, floor, dt_s);
  return AllFinite(filtered.posture) ? filtered.posture : target;
}

}  // namespace

bool IsSeatedJoint(recon::Joint joint) {
  return recon::Index(joint) >= recon::Index(recon::Joint::kShoulderCenter) &&
         recon::Index(joint) <= recon::Index(recon::Joint::kHandRight);
}

void CompleteBody(const depth::DepthFrame& frame, const std::optional<Eigen::Vector4d>& floor,
                  const CompleteOptions& options, Person& person, Body& body, StageTimes& ms) {
  const auto start = Clock::now();
  if (!person.reconstructor) person.reconstructor = recon::MakeReconstructor(options.reconstructor);
  const auto result = person.reconstructor->Step({body.raw, frame.time_s, &frame});
  body.reconstructed = result.posture;
  body.reliability = result.reliability;
  ms.reconstruct += MillisecondsSince(start);
  recon::Posture posture = body.reconstructed;
  if (options.physics) {
    const auto physics_start = Clock::now();
    posture = WithMechanics(posture, body, floor, frame.time_s, options.physics_motors, person);
    ms.physics += MillisecondsSince(physics_start);
  }
  body.smoothed =
      Smooth(HeldToImage(posture, body), frame.time_s, options.smoothing, person.smoothing);
  body.absolute_orientation = recon::OrientationsOf(body.smoothed);
  body.hierarchical_orientation = recon::HierarchicalOf(body.absolute_orientation);
}

}  // namespace ossa::tracker
