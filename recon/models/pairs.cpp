#include "recon/models/pairs.h"

#include <algorithm>
#include <map>

namespace ossa::recon {
namespace {

// Constants: chosen by hand unless stated otherwise.

std::vector<int> SplitIntoBlocks(size_t count, int most) {
  // Few and long: half a minute each in a recording of two minutes, in which another person may
  // appear.
  constexpr int kBlocks = 4;
  constexpr double kGap = 0.05;  // share of a block, at either end: amounts to seconds
  const auto blocks = static_cast<size_t>(std::min(kBlocks, most));
  std::vector<int> fold;
  for (size_t i = 0; i < count; ++i) {
    const size_t block = i * blocks / count;
    const double at = static_cast<double>(i * blocks % count) / static_cast<double>(count);
    const bool gap = (at < kGap && block > 0) || (at > 1.0 - kGap && block + 1 < blocks);
    fold.push_back(gap ? kNoFold : static_cast<int>(block));
  }
  return fold;
}

}  // namespace

std::vector<PosturePair> Thinned(const std::vector<PosturePair>& pairs, size_t most) {
  if (pairs.size() <= most) return pairs;
  std::vector<PosturePair> out;
  for (size_t i = 0; i < most; ++i) out.push_back(pairs[i * pairs.size() / most]);
  return out;
}

bool OfOnePerson(const std::vector<PosturePair>& pairs) {
  return std::all_of(pairs.begin(), pairs.end(),
                     [&](const PosturePair& pair) { return pair.group == pairs[0].group; });
}

std::vector<int> AssignFolds(const std::vector<PosturePair>& pairs, int most) {
  if (OfOnePerson(pairs)) return SplitIntoBlocks(pairs.size(), most);
  std::map<int, int> people;
  for (const PosturePair& pair : pairs) {
    people.try_emplace(pair.group, static_cast<int>(people.size()));
  }
  std::vector<int> fold;
  for (const PosturePair& pair : pairs) fold.push_back(people[pair.group] % most);
  return fold;
}

PosturePair Mirrored(const PosturePair& pair) {
  PosturePair out;
  out.group = pair.group;
  out.worst_m = pair.worst_m;
  out.observed = Mirrored(pair.observed);
  out.residual = Mirrored(pair.residual);
  for (size_t i = 0; i < kJointCount; ++i) {
    out.known[i] = pair.known[kMirroredJoint[i]];
  }
  return out;
}

Eigen::VectorXd JointFeature(const Posture& scaled, size_t joint) {
  std::vector<size_t> joints = {joint};
  if (joint > 0) joints.push_back(ParentOf(joint));
  for (size_t i = 0; i < kJointCount; ++i) {
    if (i > 0 && ParentOf(i) == joint) joints.push_back(i);
  }
  Eigen::VectorXd feature(3 * static_cast<Eigen::Index>(joints.size()));
  for (size_t k = 0; k < joints.size(); ++k) {
    feature.segment<3>(FirstCoordinate(k)) = scaled.position_m[joints[k]];
  }
  return feature;
}

}  // namespace ossa::recon
