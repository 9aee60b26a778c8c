#include "recon/fuse/fuse_joints_internal.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace ossa::recon {
namespace {

// Constants: chosen on twelve rendered clips by `ossa render --sequence --cameras 2 --split test`
// with the seeds 1 to 6 and 101 to 106; docs/several_cameras.md reports measurements on others.

constexpr double kLeastTrust = 0.05;   // share; lower bound of confidence and of reliability
constexpr double kInferred = 0.3;      // trust factor of an inferred joint
constexpr double kPlacedUnseen = 0.1;  // trust factor of a joint that is not tracked
constexpr double kNewShare = 0.05;     // weight of the latest frame in a camera's trust: 0.7 s
constexpr double kSupport = 1.5;     // logarithm of likelihood, added by another camera that agrees
constexpr double kJump_m = 0.1;      // standard deviation of a joint's motion per frame
constexpr double kStretch_m = 0.05;  // ... and of a bone between joints of different cameras
constexpr double kMostSurprise = 2.0;  // logarithm; upper bound of a surprise

/// One joint as seen by one camera.
struct SeenJoint {
  const BodySighting* sighting = nullptr;
  const JointRecord* joint = nullptr;
  const Eigen::Matrix3d* covariance_m2 = nullptr;
};

TrackingState StateOf(const JointRecord& joint) {
  return joint.state.value_or(TrackingState::kTracked);
}

std::vector<SeenJoint> AllSeen(std::span<const BodySighting* const> sightings, size_t j) {
  std::vector<SeenJoint> seen;
  for (const BodySighting* sighting : sightings) {
    const auto& joint = sighting->body.joints[j];
    if (joint && HasPlace(*joint)) seen.push_back({sighting, &*joint, &sighting->covariance_m2[j]});
  }
  return seen;
}

double TrustIn(const JointRecord& joint) {
  const double by_state = StateOf(joint) == TrackingState::kTracked    ? 1.0
                          : StateOf(joint) == TrackingState::kInferred ? kInferred
                                                                       : kPlacedUnseen;
  return by_state * std::max(kLeastTrust, joint.confidence.value_or(1.0)) *
         std::max(kLeastTrust, joint.reliability.value_or(1.0));
}

void RememberTrust(const std::vector<SeenJoint>& seen, size_t j, JointHistory& history) {
  for (const SeenJoint& s : seen) {
    double& trust = history.trust[s.sighting->camera][j];
    const double latest = TrustIn(*s.joint);
    trust = trust == 0.0 ? latest : trust + kNewShare * (latest - trust);
  }
}

bool Agree(const SeenJoint& a, const SeenJoint& b, double disagreement_m) {
  return (a.joint->position_m - b.joint->position_m).norm() <= disagreement_m;
}

/// Negative log-likelihood of a normal distribution, bounded.
double Surprise(double deviations) {
  return std::min(kMostSurprise, 0.5 * deviations * deviations);
}

/// Surprise of the distance from the fused parent, given the bone length of the joint's camera.
double BoneSurprise(const SeenJoint& seen, size_t j, const BodyRecord& fused) {
  const size_t parent = ParentOf(j);
  const auto& own = seen.sighting->body.joints[parent];
  const auto& common = fused.joints[parent];
  if (j == parent || !own || !common) return 0.0;
  const double own_m = (seen.joint->position_m - own->position_m).norm();
  const double common_m = (seen.joint->position_m - common->position_m).norm();
  return Surprise((own_m - common_m) / kStretch_m);
}

/// Log-likelihood of this camera's joint position, up to a constant.
double Likelihood(const SeenJoint& seen, size_t j, const BodyRecord& fused,
                  const JointHistory& history) {
  double sum = std::log(history.trust.at(seen.sighting->camera)[j]);
  if (const auto& last_m = history.position_m[j]) {
    sum -= Surprise((seen.joint->position_m - *last_m).norm() / kJump_m);
  }
  return sum - BoneSurprise(seen, j, fused);
}

/// Keeps the joints that agree with the likeliest.
void KeepAgreeing(std::vector<SeenJoint>& seen, double disagreement_m, size_t j,
                  const BodyRecord& fused, const JointHistory& history) {
  const auto score = [&](const SeenJoint& one) {
    const auto supporters = std::count_if(seen.begin(), seen.end(), [&](const SeenJoint& s) {
      return Agree(one, s, disagreement_m);
    });
    return Likelihood(one, j, fused, history) + kSupport * static_cast<double>(supporters);
  };
  const SeenJoint likeliest = *std::max_element(
      seen.begin(), seen.end(),
      [&](const SeenJoint& a, const SeenJoint& b) { return score(a) < score(b); });
  std::erase_if(seen, [&](const SeenJoint& s) { return !Agree(s, likeliest, disagreement_m); });
}

void LeaveBestState(std::vector<SeenJoint>& seen) {
  TrackingState best = TrackingState::kNotTracked;
  for (const SeenJoint& s : seen) best = std::max(best, StateOf(*s.joint));
  std::erase_if(seen, [best](const SeenJoint& s) { return StateOf(*s.joint) != best; });
}

template <typename T>
void KeepGreater(std::optional<T>& kept, const std::optional<T>& other) {
  if (other) kept = kept ? std::max(*kept, *other) : *other;
}

JointRecord MeanJoint(const std::vector<SeenJoint>& seen) {
  JointRecord mean = *seen.front().joint;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  bool has_sigma = false;
  for (const SeenJoint& s : seen) {
    const Eigen::Matrix3d weight = s.covariance_m2->inverse();
    information += weight;
    sum += weight * s.joint->position_m;
    KeepGreater(mean.confidence, s.joint->confidence);
    KeepGreater(mean.reliability, s.joint->reliability);
    KeepGreater(mean.visible, s.joint->visible);
    has_sigma = has_sigma || s.joint->sigma_m.has_value();
  }
  const Eigen::Matrix3d covariance_m2 = information.inverse();
  if (seen.size() > 1) mean.position_m = covariance_m2 * sum;
  if (has_sigma) mean.sigma_m = covariance_m2.diagonal().cwiseSqrt();
  return mean;
}

/// The mean of the cameras' bone length estimates.
std::optional<BoneLengths> MeanBones(std::span<const BodySighting* const> sightings) {
  BoneLengths mean_m{};
  double count = 0.0;
  for (const BodySighting* sighting : sightings) {
    if (!sighting->body.bones_m) continue;
    count += 1.0;
    for (size_t j = 0; j < kJointCount; ++j) {
      mean_m[j] += ((*sighting->body.bones_m)[j] - mean_m[j]) / count;
    }
  }
  if (count == 0.0) return std::nullopt;
  return mean_m;
}

}  // namespace

BodyRecord FuseBody(std::span<const BodySighting* const> sightings, double disagreement_m,
                    JointHistory& history) {
  BodyRecord fused;
  fused.bones_m = MeanBones(sightings);
  for (size_t j = 0; j < kJointCount; ++j) {
    std::vector<SeenJoint> seen = AllSeen(sightings, j);
    RememberTrust(seen, j, history);
    if (!seen.empty()) {
      KeepAgreeing(seen, disagreement_m, j, fused, history);
      LeaveBestState(seen);
      fused.joints[j] = MeanJoint(seen);
    }
    history.position_m[j].reset();
    if (fused.joints[j]) history.position_m[j] = fused.joints[j]->position_m;
  }
  return sightings.size() == 1 ? sightings.front()->body : fused;
}

}  // namespace ossa::recon
