#include "tools/tracker/measure_body_internal.h"

#include "recon/body/standard_body.h"

namespace ossa::tracker {
namespace {

using recon::Joint;

// The best proposal for a joint, if the forest is sure enough of it for a measure or a mark.
const Eigen::Vector3d* Seen(const Perception& perception, const recon::JointArray<int>& targets,
                            Joint joint) {
  constexpr double kSure = 0.3;
  const auto target = static_cast<size_t>(targets[joint]);
  const auto& modes = perception.proposals.at(target);
  return modes.empty() || modes.front().confidence < kSure ? nullptr : &modes.front().position_m;
}

// Between two joints of the standard body at rest.
double AverageDistance_m(Joint a, Joint b) {
  static const recon::Posture body = recon::StandardPosture(recon::RigPose{});
  const auto at = [](Joint joint) { return body.position_m[joint]; };
  return (at(a) - at(b)).norm();
}

}  // namespace

depth::MeasuredBody MeasureBody(const Perception& perception, const recon::JointArray<int>& targets,
                                const std::optional<depth::FloorPlane>& floor) {
  // Of the average body: shorter than a child's or longer than anybody's are the limbs of people
  // half hidden.
  constexpr double kLeast = 0.55, kMost = 1.4;
  depth::MeasuredBody body;
  const auto seen = [&](Joint joint) { return Seen(perception, targets, joint); };
  const auto distance_m = [&](Joint a, Joint b) -> std::optional<float> {
    if (seen(a) == nullptr || seen(b) == nullptr) return std::nullopt;
    const double length_m = (*seen(a) - *seen(b)).norm(), average_m = AverageDistance_m(a, b);
    if (length_m < kLeast * average_m || length_m > kMost * average_m) return std::nullopt;
    return static_cast<float>(length_m);
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

depth::Marks SureJoints(const Perception& perception, const recon::JointArray<int>& targets) {
  depth::Marks marks_m(recon::kJointCount);
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    const Eigen::Vector3d* seen_m = Seen(perception, targets, static_cast<Joint>(j));
    if (seen_m != nullptr) marks_m[j] = seen_m->cast<float>();
  }
  return marks_m;
}

}  // namespace ossa::tracker
