#include <fmt/format.h>

#include <map>
#include <utility>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "recon/files/gltf_scene_internal.h"
#include "recon/files/people_log_internal.h"
#include "recon/files/skeleton_writer_internal.h"
#include "recon/motion/bvh_layout_internal.h"
#include "recon/motion/held_body_internal.h"
#include "recon/orientation.h"
#include "recon/smallest_turn.h"
#include "recon/t_pose.h"

namespace ossa::recon {
namespace {

namespace fs = std::filesystem;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr std::array<HumanBone, 2> kHands = {HumanBone::kLeftHand, HumanBone::kRightHand};
constexpr std::array<Joint, 2> kHandEnds = {Joint::kHandLeft, Joint::kHandRight};

/// The joint at a node's position.
Joint JointOf(size_t node) {
  return node < kHumanBoneCount ? kHumanBones[node].place : kHandEnds[node - kHumanBoneCount];
}

int ParentOfNode(size_t node) {
  return node < kHumanBoneCount ? kHumanBones[node].parent
                                : static_cast<int>(Index(kHands[node - kHumanBoneCount]));
}

/// Whether the orientation of one of our bones drives the node; other nodes follow their parent.
bool IsTurned(size_t node) {
  if (node >= kHumanBoneCount) return false;
  return kHumanBones[node].parent < 0 || kHumanBones[node].place != kHumanBones[node].turner;
}

/// A T-pose of the skeleton, standing on y = 0.
Posture BuildStandingTPose(const BoneLengths& lengths_m) {
  Posture rest = BuildTPose(lengths_m);
  const Vector3d up_m = -rest[Joint::kFootLeft].y() * Vector3d::UnitY();
  for (Vector3d& joint : rest.position_m) joint += up_m;
  return rest;
}

std::vector<RestNode> BuildRestNodes(const Posture& rest, BvhNames names) {
  std::vector<RestNode> nodes(kPersonNodes);
  for (size_t i = 0; i < kPersonNodes; ++i) {
    nodes[i].parent = ParentOfNode(i);
    nodes[i].place_m = rest[JointOf(i)];
    nodes[i].name = i < kHumanBoneCount ? HumanBoneName(kHumanBones[i], names)
                                        : nodes[static_cast<size_t>(nodes[i].parent)].name + "_end";
  }
  return nodes;
}

/// Converts postures to the rotations and translations of a person's nodes.
class NodeMotion {
 public:
  explicit NodeMotion(const Posture& rest) {
    for (size_t b = 0; b < kHumanBoneCount; ++b) {
      const size_t j = Index(kHumanBones[b].turner);
      rest_from_joint_[b] = RestOrientations()[j].conjugate();
      if (j == 0) continue;
      // Our bones point along their y axis at rest; a node's bone points as in the T-pose.
      const Vector3d along = rest.position_m[j] - rest.position_m[ParentOf(j)];
      rest_from_joint_[b] =
          rest_from_joint_[b] * SmallestTurn(TPoseDirection(j), along).conjugate();
    }
    tracks_.translation_m.resize(kPersonNodes);
    tracks_.rotation.resize(kPersonNodes);
  }

  void Add(double time_s, const Posture& posture) {
    tracks_.time_s.push_back(static_cast<float>(time_s));
    const JointOrientations now = ComputeOrientations(posture);
    std::array<Quaterniond, kPersonNodes> world;
    for (size_t i = 0; i < kPersonNodes; ++i) {
      const int parent = ParentOfNode(i);
      const Quaterniond carried =
          parent < 0 ? Quaterniond::Identity() : world[static_cast<size_t>(parent)];
      world[i] =
          IsTurned(i) ? (now[kHumanBones[i].turner] * rest_from_joint_[i]).normalized() : carried;
      const Vector3d from_m =
          parent < 0 ? Vector3d(Vector3d::Zero()) : posture[JointOf(static_cast<size_t>(parent))];
      AddPlace(i, carried.conjugate() * (posture[JointOf(i)] - from_m));
      if (IsTurned(i)) AddTurn(i, carried.conjugate() * world[i]);
    }
  }

  PersonTracks& tracks() { return tracks_; }

 private:
  void AddPlace(size_t node, const Vector3d& place_m) {
    for (const double x : place_m) {
      tracks_.translation_m[node].push_back(static_cast<float>(x));
    }
  }
  // Of the two quaternions of a rotation, takes the one nearer to the last: readers interpolate
  // between keyframes.
  void AddTurn(size_t node, const Quaterniond& turn) {
    std::vector<float>& keys = tracks_.rotation[node];
    Eigen::Vector4f key = turn.normalized().coeffs().cast<float>();
    if (!keys.empty() && key.dot(Eigen::Map<const Eigen::Vector4f>(&*keys.end() - 4)) < 0.0F) {
      key = -key;
    }
    keys.insert(keys.end(), key.begin(), key.end());
  }

  std::array<Quaterniond, kHumanBoneCount> rest_from_joint_;
  PersonTracks tracks_;
};

/// Adds a person's visibility from `begin_s` on; nothing for a person who is always visible.
void AddPresence(const std::vector<PresenceInterval>& stays, double begin_s, PersonTracks& tracks) {
  const auto add = [&](double time_s, float here) {
    const auto key_s = static_cast<float>(time_s - begin_s);
    if (!tracks.presence_s.empty() && !(key_s > tracks.presence_s.back())) {
      tracks.presence.back() = here;  // interval shorter than the resolution of times
      return;
    }
    tracks.presence_s.push_back(key_s);
    tracks.presence.push_back(here);
  };
  if (stays.front().from_s > begin_s) add(begin_s, 0.0F);
  for (const PresenceInterval& stay : stays) {
    add(stay.from_s, 1.0F);
    if (stay.end_s) add(*stay.end_s, 0.0F);
  }
  if (tracks.presence.size() > 1) return;
  tracks.presence_s.clear();
  tracks.presence.clear();
}

class GltfWriter final : public SkeletonWriter::Format {
 public:
  GltfWriter(fs::path path, const SkeletonWriteOptions& options)
      : path_(std::move(path)), options_(options), people_(FolderOf(path_)) {
    AtomicFile::CheckWritable(path_);
  }

  void Write(const SkeletonFrame& frame) override { people_.Append(frame); }
  void SetShape(int id, const ShapeVector& shape) override { shapes_[id] = shape; }

  void Finish() override {
    RequirePeople(people_, path_);
    WriteScene(people_);
  }

  int64_t FinishWithWhatFits() override {
    const auto write = [this](const PeopleLog& people) { WriteScene(people); };
    const int64_t frames = WriteWhatFits(people_, write);
    if (frames > 0 || !options_.body) return frames;
    options_.body = nullptr;  // without skin, which takes as much space as minutes of motion and
                              // can be made again
    return WriteWhatFits(people_, write);
  }

 private:
  void WriteScene(const PeopleLog& people) {
    GltfScene scene;
    for (const int id : people.ids()) AddPerson(people, id, scene);
    AtomicFile file(path_);
    scene.Write(file.stream());
    file.Commit();
  }

  void AddPerson(const PeopleLog& people, int id, GltfScene& scene) {
    const double begin_s = people.begin_s();
    const SightingLog& seen = people.SightingsOf(id);
    CheckLength(scene.Bytes(), seen.size());
    HeldBody held(seen);
    std::optional<SkinnedBody> body;
    if (options_.body) body = BuildTPosedBody(*options_.body, ShapeOf(id), held.lengths_m());
    const Posture rest = body ? body->joints_m : BuildStandingTPose(held.lengths_m());
    NodeMotion motion(rest);
    for (size_t i = 0; i < seen.size(); ++i) {
      const Sighting now = seen[i];
      held.Update(now);
      motion.Add(now.time_s - begin_s, held.WholePosture(now));
    }
    AddPresence(people.StaysOf(id), begin_s, motion.tracks());
    scene.AddPerson(fmt::format("person {}", id), BuildRestNodes(rest, options_.names),
                    body ? &*body : nullptr, options_.body.get(), motion.tracks());
  }

  /// The mean body's shape if none is known: a map's new fixed-size Eigen value would be
  /// uninitialised.
  ShapeVector ShapeOf(int id) const {
    const auto known = shapes_.find(id);
    return known == shapes_.end() ? ShapeVector(ShapeVector::Zero()) : known->second;
  }

  /// Refuses a file that readers could not hold, before it is built.
  void CheckLength(size_t bytes, size_t keys) const {
    // Bytes, by hand; a quarter of the format's own limit.
    constexpr size_t kMost = size_t{1} << 30;
    // Derived, bytes per keyframe: a time, and the translations and rotations of all nodes.
    constexpr size_t kKeyBytes = sizeof(float) * (1 + kPersonNodes * (3 + 4));
    if (bytes + keys * kKeyBytes <= kMost) return;
    throw InputError(path_.string() + ": expected a .glb of at most 1 GiB, found " +
                     std::to_string(keys) + " frames of one person: .jsonl has no such limit");
  }

  fs::path path_;
  SkeletonWriteOptions options_;
  PeopleLog people_;
  std::map<int, ShapeVector> shapes_;
};

}  // namespace

std::unique_ptr<SkeletonWriter::Format> NewGltfWriter(const fs::path& path,
                                                      const SkeletonWriteOptions& options) {
  return std::make_unique<GltfWriter>(path, options);
}

}  // namespace ossa::recon
