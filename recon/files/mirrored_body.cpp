#include "recon/files/mirrored_body_internal.h"

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "depth/base/statistics.h"

namespace ossa::recon {
namespace {

// Constants: chosen on 170 recordings of sensors, laboratories and mocap, whose medians are above
// 0.4 for feet, and below it if they have no toes.

constexpr double kShortest_m = 0.03;  // of a foot, or of a knee's bend: less has no direction

using Places = JointArray<std::optional<Eigen::Vector3d>>;

Places FindPlaces(const BodyRecord& body) {
  Places places;
  for (size_t j = 0; j < kJointCount; ++j) {
    const auto& joint = body.joints[j];
    if (joint && joint->state != TrackingState::kNotTracked) places[j] = joint->position_m;
  }
  return places;
}

struct Leg {
  Joint hip, knee, ankle, foot;
};
constexpr std::array<Leg, 2> kLegs = {
    {{Joint::kHipLeft, Joint::kKneeLeft, Joint::kAnkleLeft, Joint::kFootLeft},
     {Joint::kHipRight, Joint::kKneeRight, Joint::kAnkleRight, Joint::kFootRight}}};

// Where the trunk faces, unit length: what is left of it, times up.
std::optional<Eigen::Vector3d> FindFront(const Places& at) {
  for (const Joint joint :
       {Joint::kHipLeft, Joint::kHipRight, Joint::kShoulderLeft, Joint::kShoulderRight}) {
    if (!at[joint]) return std::nullopt;
  }
  const Eigen::Vector3d hips = *at[Joint::kHipLeft] + *at[Joint::kHipRight];
  const Eigen::Vector3d shoulders = *at[Joint::kShoulderLeft] + *at[Joint::kShoulderRight];
  const Eigen::Vector3d left = *at[Joint::kHipLeft] - *at[Joint::kHipRight];
  const Eigen::Vector3d front = left.cross(shoulders - hips);
  return front.norm() > 0 ? std::optional(front.normalized()) : std::nullopt;
}

// Cosines between the front and what points there: [-1, 1].
struct Cosines {
  std::vector<double> feet, knees;
};

void AddCosine(const Eigen::Vector3d& front, const Eigen::Vector3d& direction_m,
               std::vector<double>& cosines) {
  if (direction_m.norm() > kShortest_m) cosines.push_back(front.dot(direction_m.normalized()));
}

void AddBody(const BodyRecord& body, Cosines& cosines) {
  const Places at = FindPlaces(body);
  const auto front = FindFront(at);
  if (!front) return;
  for (const auto& [hip, knee, ankle, foot] : kLegs) {
    if (!at[ankle]) continue;
    if (at[foot]) AddCosine(*front, *at[foot] - *at[ankle], cosines.feet);
    if (!at[hip] || !at[knee]) continue;
    AddCosine(*front, *at[knee] - 0.5 * (*at[hip] + *at[ankle]), cosines.knees);
  }
}

bool PointBack(std::vector<double> cosines, double least) {
  constexpr size_t kEnough = 30;  // directions, by hand: a second of a leg
  return cosines.size() >= kEnough && Median(std::move(cosines)) < least;
}

}  // namespace

std::string DescribeMirrored(const SkeletonSequence& sequence) {
  constexpr double kFoot = -0.4, kKnee = -0.2;  // cosines: no unit
  Cosines cosines;
  for (const SkeletonFrame& frame : sequence.frames) {
    for (const BodyRecord& body : frame.bodies) AddBody(body, cosines);
  }
  if (!PointBack(std::move(cosines.feet), kFoot) || !PointBack(std::move(cosines.knees), kKnee)) {
    return {};
  }
  return "feet point and knees bend backwards: are left and right exchanged, in mirrored images or "
         "left-handed axes such as Unity's?";
}

}  // namespace ossa::recon
