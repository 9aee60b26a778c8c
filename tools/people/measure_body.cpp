#include "tools/people/measure_body.h"

#include "recon/body/standard_body.h"

namespace ossa::people {
namespace {

using recon::Joint;

// The best proposal for a joint, if its confidence is at least `min_confidence`; else null.
const Eigen::Vector3d* FindConfidentJoint(const ForestEvidence& evidence,
                                          const JointTargets& targets, Joint joint,
                                          double min_confidence) {
  const auto target = static_cast<size_t>(targets[recon::Index(joint)]);
  const auto& modes = evidence.proposals.at(target);
  return modes.empty() || modes.front().confidence < min_confidence ? nullptr
                                                                    : &modes.front().position_m;
}

// Distance of two joints of the standard body at rest.
double ComputeAverageDistance_m(Joint a, Joint b) {
  static const recon::Posture body = recon::StandardPosture(recon::RigPose{});
  const auto at = [](Joint joint) { return body.position_m[recon::Index(joint)]; };
  return (at(a) - at(b)).norm();
}

}  // namespace

FrameMeasures MeasureBody(const ForestEvidence& evidence, const JointTargets& targets,
                          const std::optional<FloorPlane>& floor, const MeasureOptions& options) {
  FrameMeasures body;
  const auto seen = [&](Joint joint) {
    return FindConfidentJoint(evidence, targets, joint, options.min_confidence);
  };
  const auto distance_m = [&](Joint a, Joint b) -> std::optional<float> {
    if (seen(a) == nullptr || seen(b) == nullptr) return std::nullopt;
    const double length_m = (*seen(a) - *seen(b)).norm(),
                 average_m = ComputeAverageDistance_m(a, b);
    if (length_m < options.min_length * average_m || length_m > options.max_length * average_m)
      return std::nullopt;
    return static_cast<float>(length_m);
  };
  // The left limb, or the right one if that is not seen.
  const auto either_m = [&](Joint a, Joint b, Joint other_a, Joint other_b) {
    const auto first_m = distance_m(a, b);
    return first_m ? first_m : distance_m(other_a, other_b);
  };
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

Keypoints SelectKeypoints(const ForestEvidence& evidence, const JointTargets& targets,
                          const MeasureOptions& options) {
  Keypoints keypoints_m(recon::kJointCount);
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    const Eigen::Vector3d* seen_m =
        FindConfidentJoint(evidence, targets, static_cast<Joint>(j), options.min_confidence);
    if (seen_m != nullptr) keypoints_m[j] = seen_m->cast<float>();
  }
  return keypoints_m;
}

}  // namespace ossa::people
