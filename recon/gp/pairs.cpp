#include "recon/gp/pairs.h"

namespace ossa::recon {
namespace {

Eigen::Vector3d MirroredPoint(const Eigen::Vector3d& p) { return {-p.x(), p.y(), p.z()}; }

}  // namespace

std::vector<PosturePair> Thinned(const std::vector<PosturePair>& pairs, size_t most) {
  if (pairs.size() <= most) return pairs;
  std::vector<PosturePair> out;
  for (size_t i = 0; i < most; ++i) out.push_back(pairs[i * pairs.size() / most]);
  return out;
}

PosturePair Mirrored(const PosturePair& pair) {
  PosturePair out;
  out.group = pair.group;
  out.worst_m = pair.worst_m;
  for (size_t i = 0; i < kJointCount; ++i) {
    const auto m = static_cast<size_t>(kMirroredJoint[i]);
    out.observed.position_m[i] = MirroredPoint(pair.observed.position_m[m]);
    out.residual.position_m[i] = MirroredPoint(pair.residual.position_m[m]);
    out.known[i] = pair.known[m];
  }
  return out;
}

Eigen::VectorXd JointFeature(const Posture& scaled, size_t joint) {
  std::vector<size_t> joints = {joint};
  if (kJointParent[joint] >= 0) joints.push_back(static_cast<size_t>(kJointParent[joint]));
  for (size_t i = 0; i < kJointCount; ++i) {
    if (kJointParent[i] == static_cast<int>(joint)) joints.push_back(i);
  }
  Eigen::VectorXd feature(3 * static_cast<Eigen::Index>(joints.size()));
  for (size_t k = 0; k < joints.size(); ++k) {
    feature.segment<3>(3 * static_cast<Eigen::Index>(k)) = scaled.position_m[joints[k]];
  }
  return feature;
}

}  // namespace ossa::recon
