#include "recon/motion/reference_pose_internal.h"

#include <string>
#include <vector>

#include "depth/base/error.h"
#include "recon/body/standard_body.h"
#include "recon/motion/up_axis_internal.h"
#include "recon/smallest_turn.h"

namespace ossa::recon {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr size_t kSampledFrames = 400;  // by hand, for speed
/// Mean sine of the bend below which a limb's plane is noise, by hand: 3 degrees.
constexpr double kLeastBend = 0.05;

size_t Bone(const std::string& name) { return static_cast<size_t>(RigBone(name)); }

Vector3d Of(const SourceFrame& frame, int joint) {
  return frame.position[static_cast<size_t>(joint)];
}

const Quaterniond& TurnOf(const SourceFrame& frame, int joint) {
  return frame.rotation[static_cast<size_t>(joint)];
}

/// How far legs and trunk are stretched in opposite directions; 4 at most.
double MeasureStretch(const SourceFrame& frame, const SourceBones& bones) {
  const Vector3d trunk = TrunkDirection(frame.position, bones);
  double stretch = 0.0;
  for (const SideBones& side : bones.side) {
    stretch -= trunk.dot((Of(frame, side.leg) - Of(frame, side.up_leg)).normalized());
    stretch -= trunk.dot((Of(frame, side.foot) - Of(frame, side.leg)).normalized());
  }
  return stretch;
}

void RequireTrunk(const SourceMotion& motion, const SourceBones& bones, const SourceFrame& frame) {
  const SideBones &left = bones.side[0], &right = bones.side[1];
  const double hips = (Of(frame, left.up_leg) - Of(frame, right.up_leg)).norm();
  const double shoulders = (Of(frame, left.arm) - Of(frame, right.arm)).norm();
  if (hips > 1e-9 && shoulders > 1e-9 && TrunkDirection(frame.position, bones).norm() > 0.5) return;
  throw InputError(motion.source + ": hips or shoulders coincide, expected a person");
}

/// Directions in which a limb's second bone deviates from the first, in the axes of each bone's
/// joint: the bending direction. Means over the frames, weighted by the sine of the bend.
struct Bend {
  Vector3d by_upper = Vector3d::Zero();
  Vector3d by_lower = Vector3d::Zero();
};

Bend MeasureBend(const SourceMotion& motion, const std::vector<SourceFrame>& frames, int upper,
                 int lower, int next) {
  Bend bend;
  for (const SourceFrame& frame : frames) {
    const Vector3d u = (Of(frame, lower) - Of(frame, upper)).normalized();
    const Vector3d l = (FindEnd(motion, frame, lower, next) - Of(frame, lower)).normalized();
    if (!u.allFinite() || !l.allFinite()) continue;
    const double share = 1.0 / static_cast<double>(frames.size());
    bend.by_upper += share * (TurnOf(frame, upper).conjugate() * (l - l.dot(u) * u));
    bend.by_lower += share * (TurnOf(frame, lower).conjugate() * (l.dot(u) * l - u));
  }
  return bend;
}

/// Aligns the rig with the reference frame, bone by bone.
class Layer {
 public:
  Layer(const SourceMotion& motion, const SourceBones& bones, const Quaterniond& world_from_file,
        const std::vector<SourceFrame>& frames, const SourceFrame& reference)
      : motion_(motion),
        bones_(bones),
        world_from_file_(world_from_file),
        frames_(frames),
        frame_(reference) {
    laid_.fill(Quaterniond::Identity());
  }

  std::array<Quaterniond, kRigBoneCount> Run() {
    LayTrunk();
    for (size_t s = 0; s < 2; ++s) {
      LayLimb(s, "Arm", "ForeArm", laid_[Bone("Spine1")], 1.0);
      LayLimb(s, "UpLeg", "Leg", laid_[Bone("Hips")], -1.0);  // knees bend backwards
      LayFoot(s);
    }
    return laid_;
  }

 private:
  static std::string SideName(size_t s) { return s == 0 ? "Left" : "Right"; }
  static Vector3d RigHead(const std::string& bone) { return StandardRigRest().head_m[Bone(bone)]; }
  Vector3d Place(int joint) const { return world_from_file_ * Of(frame_, joint); }

  static Matrix3d TrunkFrame(const Vector3d& up, const Vector3d& left) {
    return FrameAlong(up, left);
  }

  void LayTrunk() {
    const auto middle = [](const Vector3d& a, const Vector3d& b) {
      return Vector3d(0.5 * (a + b));
    };
    const Vector3d rig_up = middle(RigHead("LeftArm"), RigHead("RightArm")) -
                            middle(RigHead("LeftUpLeg"), RigHead("RightUpLeg"));
    const Matrix3d rig = TrunkFrame(rig_up, Vector3d::UnitX());
    const SideBones &left = bones_.side[0], &right = bones_.side[1];
    const Vector3d up =
        middle(Place(left.arm), Place(right.arm)) - middle(Place(left.up_leg), Place(right.up_leg));
    const Vector3d hips = Place(left.up_leg) - Place(right.up_leg);
    const Vector3d shoulders = Place(left.arm) - Place(right.arm);
    const Quaterniond pelvis(TrunkFrame(up, hips) * rig.transpose());
    const Quaterniond chest(TrunkFrame(up, shoulders) * rig.transpose());
    for (const char* bone : {"Hips", "LHipJoint", "RHipJoint"}) laid_[Bone(bone)] = pelvis;
    laid_[Bone("LowerBack")] = pelvis.slerp(1.0 / 3.0, chest);
    laid_[Bone("Spine")] = pelvis.slerp(2.0 / 3.0, chest);
    for (const char* bone : {"Spine1", "LeftShoulder", "RightShoulder", "Head"}) {
      laid_[Bone(bone)] = chest;
    }
    laid_[Bone("Neck")] = laid_[Bone("Neck1")] = LayNeck(chest);
  }

  Quaterniond LayNeck(const Quaterniond& chest) const {
    if (bones_.neck.size() < 2) return chest;
    const Vector3d along = Place(bones_.neck.back()) - Place(bones_.neck.front());
    if (along.norm() < 1e-9) return chest;
    return SmallestTurn(Vector3d(chest * (RigHead("Head") - RigHead("Neck"))), along) * chest;
  }

  void LayLimb(size_t s, const std::string& upper, const std::string& lower,
               const Quaterniond& trunk, double forwards) {
    const SideBones& side = bones_.side[s];
    const bool arm = upper == "Arm";
    const int from = arm ? side.arm : side.up_leg, middle = arm ? side.fore_arm : side.leg;
    const int next = arm ? side.hand : side.foot;
    const Bend bend = MeasureBend(motion_, frames_, from, middle, next);
    const bool bends = bend.by_upper.norm() > kLeastBend && bend.by_lower.norm() > kLeastBend;
    const auto front = [&](int joint, const Vector3d& by_joint) {
      if (!bends) return Vector3d(trunk * Vector3d::UnitZ());
      return Vector3d(forwards * (world_from_file_ * (TurnOf(frame_, joint) * by_joint)));
    };
    const Vector3d end = world_from_file_ * FindEnd(motion_, frame_, middle, next);
    Lay(SideName(s) + upper, Place(middle) - Place(from), front(from, bend.by_upper));
    Lay(SideName(s) + lower, end - Place(middle), front(middle, bend.by_lower));
  }

  void Lay(const std::string& bone, const Vector3d& direction, const Vector3d& front) {
    const RigRest& rig = StandardRigRest();
    const size_t b = Bone(bone);
    const Matrix3d rest = FrameAlong(rig.tail_m[b] - rig.head_m[b], Vector3d::UnitZ());
    laid_[b] = Quaterniond(FrameAlong(direction, front) * rest.transpose());
  }

  void LayFoot(size_t s) {
    const SideBones& side = bones_.side[s];
    const std::string name = SideName(s);
    const Quaterniond& leg = laid_[Bone(name + "Leg")];
    const Vector3d toes = world_from_file_ * FindEnd(motion_, frame_, side.foot, side.toe);
    const Vector3d along = toes - Place(side.foot);
    Quaterniond foot = leg;
    if (along.norm() > 1e-9) {
      const Matrix3d rest =
          FrameAlong(RigHead(name + "ToeBase") - RigHead(name + "Foot"), Vector3d::UnitX());
      foot = FrameAlong(along, leg * Vector3d::UnitX()) * rest.transpose();
    }
    laid_[Bone(name + "Foot")] = laid_[Bone(name + "ToeBase")] = foot;
  }

  const SourceMotion& motion_;
  const SourceBones& bones_;
  const Quaterniond& world_from_file_;
  const std::vector<SourceFrame>& frames_;
  const SourceFrame& frame_;
  std::array<Quaterniond, kRigBoneCount> laid_;
};

}  // namespace

Matrix3d FrameAlong(const Vector3d& direction, const Vector3d& front) {
  const Vector3d d = direction.normalized();
  Vector3d square = front - front.dot(d) * d;
  if (square.norm() < 0.1 * front.norm()) square = Vector3d::UnitY() - d.y() * d;
  if (square.norm() < 0.1) square = d.unitOrthogonal();
  square.normalize();
  Matrix3d frame;
  frame << d, square, d.cross(square);
  return frame;
}

Vector3d FindEnd(const SourceMotion& motion, const SourceFrame& frame, int joint, int next) {
  if (next >= 0) return Of(frame, next);
  const auto& ends = motion.joints[static_cast<size_t>(joint)].end_sites;
  if (!ends.empty()) return Of(frame, joint) + TurnOf(frame, joint) * ends.front();
  for (size_t child = 0; child < motion.joints.size(); ++child) {
    if (motion.joints[child].parent == joint) return frame.position[child];
  }
  return Of(frame, joint);
}

ReferencePose FindReferencePose(const SourceMotion& motion, const SourceBones& bones,
                                const Quaterniond& world_from_file) {
  const std::vector<SourceFrame> frames = SampleFrames(motion, kSampledFrames);
  size_t best = 0;
  for (size_t f = 1; f < frames.size(); ++f) {
    if (MeasureStretch(frames[f], bones) > MeasureStretch(frames[best], bones)) best = f;
  }
  RequireTrunk(motion, bones, frames[best]);
  ReferencePose pose{frames[best], {}};
  pose.world_from_rest = Layer(motion, bones, world_from_file, frames, frames[best]).Run();
  return pose;
}

}  // namespace ossa::recon
