#include "tools/tracker/measure_body_internal.h"

namespace ossa::tracker {
namespace {

using recon::Joint;

// The best proposal for a joint, if the forest is sure enough of it for a measure.
const Eigen::Vector3d* Seen(const Perception& perception,
                            const std::array<int, recon::kJointCount>& targets, Joint joint) {
  constexpr double kSure = 0.3;
  const auto target = static_cast<size_t>(targets[static_cast<size_t>(recon::Index(joint))]);
  const auto& modes = perception.proposals.at(target);
  return modes.empty() || modes.front().confidence < kSure ? nullptr : &modes.front().position_m;
}

}  // namespace

depth::MeasuredBody MeasureBody(const Perception& perception,
                                const std::array<int, recon::kJointCount>& targets,
                                const std::optional<depth::FloorPlane>& floor) {
  depth::MeasuredBody body;
  const auto seen = [&](Joint joint) { return Seen(perception, targets, joint); };
  const auto distance_m = [&](Joint a, Joint b) -> std::optional<float> {
    if (seen(a) == nullptr || seen(b) == nullptr) return std::nullopt;
    return static_cast<float>((*seen(a) - *seen(b)).norm());
  };
  // Of two limbs whichever is seen.
  const auto either_m = [&](Joint a, Joint b, Joint other_a, Joint other_b) {
    const auto first_m = distance_m(a, b);
    return first_m ? first_m : distance_m(other_a, other_b);
  };
  using depth::Measure;
  const auto set = [&](Measure measure, std::optional<float> metres) {
    body[static_cast<size_t>(measure)] = metres;
  };
  if (floor && seen(Joint::kHead) != nullptr)
    set(Measure::kHeadHeight, static_cast<float>(floor->HeightOf(*seen(Joint::kHead))));
  set(Measure::kShoulders, distance_m(Joint::kShoulderLeft, Joint::kShoulderRight));
  set(Measure::kTrunk, distance_m(Joint::kSpine, Joint::kShoulderCenter));
  set(Measure::kUpperArm,
      either_m(Joint::kShoulderLeft, Joint::kElbowLeft, Joint::kShoulderRight, Joint::kElbowRight));
  set(Measure::kThigh,
      either_m(Joint::kHipLeft, Joint::kKneeLeft, Joint::kHipRight, Joint::kKneeRight));
  set(Measure::kShin,
      either_m(Joint::kKneeLeft, Joint::kAnkleLeft, Joint::kKneeRight, Joint::kAnkleRight));
  return body;
}

}  // namespace ossa::tracker
