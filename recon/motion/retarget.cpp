#include "recon/motion/retarget_internal.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "depth/base/angles.h"
#include "depth/base/error.h"
#include "recon/body/standard_body.h"
#include "recon/motion/agreement_check_internal.h"
#include "recon/motion/reference_pose_internal.h"
#include "recon/motion/up_axis_internal.h"
#include "recon/smallest_turn.h"

namespace ossa::recon {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

// Wrists bend less than about 70° in any direction, and hand markers are few and noisy. The angle
// between forearm and hand is smoothly limited to this.
constexpr double kWristLimit_rad = 50.0 * kDegree;  // anthropometry, with a margin; by hand

/// Axes of a bone: its direction, and the front of the body (+z) as far as possible. An elbow bends
/// forwards about these axes in a T-pose, an A-pose and with arms hanging, so the axial rotations
/// of different rest poses are consistent; only an arm stretched forwards is degenerate.
Eigen::Matrix3d BoneFrame(const Vector3d& direction) {
  return FrameAlong(direction, Vector3d::UnitZ());
}

/// Rotates an up axis of the file to y.
Quaterniond Upright(const Vector3d& up) {
  return up == Vector3d::UnitY() ? Quaterniond::Identity() : SmallestTurn(up, Vector3d::UnitY());
}

/// Rotation from the file's axes to ours (y up, facing +z, left +x), from the rest pose. Within 25°
/// of a right angle it is snapped: no rest pose is intentionally that oblique.
Quaterniond WorldFromFile(const std::vector<Vector3d>& rest, const SourceBones& bones,
                          const std::string& source) {
  const auto at = [&](int joint) { return rest[static_cast<size_t>(joint)]; };
  const Vector3d across = at(bones.side[0].up_leg) - at(bones.side[1].up_leg);
  const Vector3d middle = 0.5 * (at(bones.side[0].up_leg) + at(bones.side[1].up_leg));
  const Vector3d upward = 0.5 * (at(bones.side[0].arm) + at(bones.side[1].arm)) - middle;
  const auto snapped = [](const Vector3d& v) {
    Eigen::Index axis = 0;
    v.cwiseAbs().maxCoeff(&axis);
    const Vector3d unit = Vector3d::Unit(axis) * (v[axis] < 0 ? -1.0 : 1.0);
    return v.normalized().dot(unit) > std::cos(25.0 * kDegree) ? unit : v.normalized();
  };
  if (across.norm() < 1e-9 || upward.norm() < 1e-9) {
    throw InputError(source + ": hips or shoulders coincide in the rest pose, expected a person");
  }
  const Vector3d up = snapped(upward);
  const Vector3d flat = across - across.dot(up) * up;
  if (flat.norm() < 0.2 * across.norm()) {
    throw InputError(source + ": the rest pose lies folded, expected a standing person (name a " +
                     "rest frame in a mapping file)");
  }
  const Vector3d left = snapped(flat);
  Eigen::Matrix3d file_axes;  // rows: our axes in file axes
  file_axes << left.transpose(), up.transpose(), left.cross(up).transpose();
  return Quaterniond(file_axes).normalized();
}

struct BoneSource {
  int joint = -1;       // -1: the bone follows its rig parent
  int next_joint = -1;  // with `mix`: the rotation is interpolated between both joints
  double mix = 0.0;
  Quaterniond source_from_rig = Quaterniond::Identity();  // aligns the rest poses
};

class Retargeter {
 public:
  Retargeter(const SourceMotion& motion, const SourceBones& bones)
      : motion_(motion), bones_(bones) {
    SourceFrame& rest = rest_frame_;
    std::optional<ReferencePose> reference;
    if (bones.rest_frame) {
      rest = motion.frame(*bones.rest_frame);
    } else {
      rest.position = ZeroPose(motion.joints);
      rest.rotation.assign(motion.joints.size(), Quaterniond::Identity());
    }
    if (bones.rest_frame || IsRestPose(rest.position, bones)) {
      FindAxes(rest.position);
    } else {
      const UpAxis up = FindUpAxis(motion, bones, std::nullopt);
      doubt_ = up.doubt;
      world_from_file_ = rest_from_file_ = Upright(up.axis);
      reference = FindReferencePose(motion, bones, world_from_file_);
      rest = reference->frame;
    }
    for (const Vector3d& p : rest.position) rest_.push_back(rest_from_file_ * p);
    MapTrunk();
    for (size_t s = 0; s < 2; ++s) MapSide(s);
    for (size_t b = 0; reference && b < kRigBoneCount; ++b) {
      sources_[b].source_from_rig = reference->world_from_rest[b];
    }
    metres_per_unit_ = RigLegLength() / SourceLegLength();
  }

  RigPose Pose(const SourceFrame& frame) const {
    RigPose pose;
    for (size_t b = 0; b < kRigBoneCount; ++b) {
      const BoneSource& from = sources_[b];
      if (from.joint < 0) {
        pose.world_from_rest[b] = pose.world_from_rest[static_cast<size_t>(kRigBoneParent[b])];
        continue;
      }
      Quaterniond turn = Turn(frame, from.joint);
      if (from.next_joint >= 0) turn = turn.slerp(from.mix, Turn(frame, from.next_joint));
      pose.world_from_rest[b] = (turn * from.source_from_rig).normalized();
    }
    SoftenWrists(frame, pose);
    FollowArmsWithCollars(pose);
    pose.root_m = ComputeRoot(frame, pose);
    return pose;
  }

  /// Positions of the source's joints in our axes.
  std::vector<Vector3d> ComputePlaces(const SourceFrame& frame) const {
    std::vector<Vector3d> places = frame.position;
    for (Vector3d& p : places) p = world_from_file_ * p;
    return places;
  }
  const std::string& doubt() const { return doubt_; }

 private:
  Vector3d Rest(int joint) const { return rest_[static_cast<size_t>(joint)]; }

  /// World rotation of a source joint relative to its rest, in our axes.
  Quaterniond Turn(const SourceFrame& frame, int joint) const {
    const auto j = static_cast<size_t>(joint);
    return world_from_file_ * frame.rotation[j] * rest_frame_.rotation[j].conjugate() *
           rest_from_file_.conjugate();
  }

  /// Determines the file's axes from the rest pose and from the motion: some exporters write
  /// figures whose rest pose is along z but whose motion is along y.
  void FindAxes(const std::vector<Vector3d>& rest) {
    world_from_file_ = rest_from_file_ = WorldFromFile(rest, bones_, motion_.source);
    const Vector3d rest_up = rest_from_file_.conjugate() * Vector3d::UnitY();
    const UpAxis up = FindUpAxis(motion_, bones_, NearestAxis(rest_up));
    doubt_ = up.doubt;
    constexpr double kSame = 0.999;  // cosine, by hand: 2.5 degrees
    if (up.by_motion && up.axis.dot(rest_up) < kSame) world_from_file_ = Upright(up.axis);
  }

  /// Maps a chain of any number of joints to three rig bones by relative position.
  void MapChain(int base, const std::vector<int>& chain, const std::array<const char*, 3>& names) {
    for (size_t k = 0; k < names.size(); ++k) {
      const double place = static_cast<double>((k + 1) * chain.size()) / 3.0;  // in (0, size]
      const auto below = static_cast<size_t>(std::ceil(place - 1e-9)) - 1;
      BoneSource& bone = sources_[RigBone(names[k])];
      bone.joint = below == 0 ? base : chain[below - 1];
      bone.next_joint = chain[below];
      bone.mix = place - static_cast<double>(below);
    }
  }

  void MapTrunk() {
    sources_[RigBone("Hips")].joint = bones_.hips;
    MapChain(bones_.hips, bones_.spine, {"LowerBack", "Spine", "Spine1"});
    std::vector<int> neck = bones_.neck;
    if (!neck.empty()) MapChain(bones_.spine.back(), neck, {"Neck", "Neck1", "Head"});
  }

  void MapSide(size_t s) {
    const SideBones& side = bones_.side[s];
    const std::string name = s == 0 ? "Left" : "Right";
    sources_[RigBone(s == 0 ? "LHipJoint" : "RHipJoint")].joint = bones_.hips;
    sources_[RigBone(name + "Shoulder")].joint =
        side.collar >= 0 ? side.collar : bones_.spine.back();
    MapLimb(name + "Arm", side.arm, EndOf(side.arm, side.fore_arm));
    MapLimb(name + "ForeArm", side.fore_arm, EndOf(side.fore_arm, side.hand));
    MapLimb(name + "UpLeg", side.up_leg, EndOf(side.up_leg, side.leg));
    MapLimb(name + "Leg", side.leg, EndOf(side.leg, side.foot));
    // Soles are flat on the floor in every rest pose, so feet need no alignment.
    sources_[RigBone(name + "Foot")].joint = side.foot;
    sources_[RigBone(name + "ToeBase")].joint = side.toe >= 0 ? side.toe : side.foot;
  }

  /// Rest position of the far end of a joint's segment.
  Vector3d EndOf(int joint, int next) const {
    return rest_from_file_ * FindEnd(motion_, rest_frame_, joint, next);
  }

  void MapLimb(const std::string& rig_bone, int joint, const Vector3d& end) {
    const size_t b = RigBone(rig_bone);
    const RigRest& rig = StandardRigRest();
    const Vector3d direction = end - Rest(joint);
    if (direction.norm() < 1e-9) {
      throw InputError(motion_.source + ": joint '" +
                       motion_.joints[static_cast<size_t>(joint)].name +
                       "' has no length, expected that of a " + rig_bone);
    }
    sources_[b].joint = joint;
    sources_[b].source_from_rig =
        Quaterniond(BoneFrame(direction) * BoneFrame(rig.tail_m[b] - rig.head_m[b]).transpose());
  }

  void SoftenWrists(const SourceFrame& frame, RigPose& pose) const {
    for (size_t s = 0; s < 2; ++s) {
      const std::string name = s == 0 ? "Left" : "Right";
      const SideBones& side = bones_.side[s];
      const Quaterniond fore_arm = pose.world_from_rest[RigBone(name + "ForeArm")];
      Quaterniond hand = fore_arm;
      if (side.hand >= 0) {
        const Quaterniond& lay = sources_[RigBone(name + "ForeArm")].source_from_rig;
        Eigen::AngleAxisd bend(fore_arm.conjugate() * Turn(frame, side.hand) * lay);
        double angle = std::remainder(bend.angle(), 2.0 * std::numbers::pi);
        angle = kWristLimit_rad * std::tanh(angle / kWristLimit_rad);
        hand = fore_arm * Quaterniond(Eigen::AngleAxisd(angle, bend.axis()));
      }
      const std::string initial = s == 0 ? "L" : "R";
      for (const std::string& bone :
           {name + "Hand", name + "FingerBase", name + "HandFinger1", initial + "Thumb"}) {
        pose.world_from_rest[RigBone(bone)] = hand;
      }
    }
  }

  double SourceLegLength() const {
    double length = 0.0;
    for (const SideBones& side : bones_.side) {
      length += (Rest(side.up_leg) - Rest(side.leg)).norm();
      length += (Rest(side.leg) - Rest(side.foot)).norm();
    }
    return length;
  }

  static double RigLegLength() {
    const RigRest& rest = StandardRigRest();
    const auto head = [&](const char* name) { return rest.head_m[RigBone(name)]; };
    return 2.0 * ((head("LeftUpLeg") - head("LeftLeg")).norm() +
                  (head("LeftLeg") - head("LeftFoot")).norm());
  }

  /// The root position that puts the midpoint of the hip joints where the source has it, scaled.
  Vector3d ComputeRoot(const SourceFrame& frame, const RigPose& pose) const {
    const auto at = [&](int joint) { return frame.position[static_cast<size_t>(joint)]; };
    const Vector3d hips =
        world_from_file_ * (0.5 * (at(bones_.side[0].up_leg) + at(bones_.side[1].up_leg)));
    const RigRest& rig = StandardRigRest();
    const Vector3d rig_hips =
        0.5 * (rig.head_m[RigBone("LeftUpLeg")] + rig.head_m[RigBone("RightUpLeg")]);
    return metres_per_unit_ * hips - pose.world_from_rest[0] * (rig_hips - rig.head_m[0]);
  }

  const SourceMotion& motion_;
  const SourceBones& bones_;
  Quaterniond world_from_file_;  // for the motion
  Quaterniond rest_from_file_;   // for the rest pose
  std::string doubt_;            // warning about the up axis
  SourceFrame rest_frame_;       // file axes
  std::vector<Vector3d> rest_;   // our axes, file units
  std::array<BoneSource, kRigBoneCount> sources_;
  double metres_per_unit_ = 1.0;
};

constexpr size_t kCheckedFrames = 200;  // by hand, for speed

double SmoothStep(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

}  // namespace

void FollowArmsWithCollars(RigPose& pose) {
  const RigRest& rest = StandardRigRest();
  const Quaterniond chest = pose.world_from_rest[RigBone("Spine1")];
  for (const double side : {1.0, -1.0}) {
    const std::string name = side > 0 ? "Left" : "Right";
    const size_t arm = RigBone(name + "Arm");
    const Vector3d arm_rest = (rest.tail_m[arm] - rest.head_m[arm]).normalized();
    const Vector3d direction = chest.conjugate() * (pose.world_from_rest[arm] * arm_rest);
    // The clavicle rises by 30° for an upright arm, and rotates forwards by 20° for an arm
    // stretched in front or across the chest; backwards by 10°.
    const double elevation = std::asin(std::clamp(direction.y(), -1.0, 1.0));
    const double lift = 30.0 * kDegree * SmoothStep(-50.0 * kDegree, 90.0 * kDegree, elevation);
    const double level = std::cos(elevation);
    const double front = std::clamp(direction.z() - 0.5 * side * direction.x() + 0.3, -1.0, 1.0);
    const double pull = level * kDegree * (front > 0 ? 20.0 * front : 10.0 * front);
    const Quaterniond wanted = Quaterniond(Eigen::AngleAxisd(-side * pull, Vector3d::UnitY())) *
                               Eigen::AngleAxisd(side * lift, Vector3d::UnitZ());
    Quaterniond& collar = pose.world_from_rest[RigBone(name + "Shoulder")];
    const Quaterniond own = chest.conjugate() * collar;
    if (own.angularDistance(Quaterniond::Identity()) <
        wanted.angularDistance(Quaterniond::Identity())) {
      collar = chest * wanted;
    }
  }
}

void SetOnFloor(MotionClip& clip, double limit_m) {
  // Soles are below ankle and toe joints by their heights in the rest pose.
  const Posture rest = StandardPosture(RigPose());
  const double rest_root = StandardRigRest().head_m[0].y();
  std::vector<double> lowest;
  for (const RigPose& pose : clip.frames) {
    const Posture posture = StandardPosture(pose);
    double sole = 1e9;
    for (const Joint joint :
         {Joint::kAnkleLeft, Joint::kAnkleRight, Joint::kFootLeft, Joint::kFootRight}) {
      sole = std::min(sole, posture[joint].y() - (rest[joint].y() + rest_root));
    }
    lowest.push_back(sole);
  }
  if (lowest.empty()) return;
  const auto fifth = lowest.begin() + static_cast<std::ptrdiff_t>(lowest.size() / 20);
  std::nth_element(lowest.begin(), fifth, lowest.end());
  if (std::abs(*fifth) > limit_m) return;
  for (RigPose& pose : clip.frames) pose.root_m.y() -= *fifth;
}

MotionClip Retarget(const SourceMotion& motion, const SourceBones& bones, double frame_s) {
  const Retargeter retargeter(motion, bones);
  MotionClip clip;
  clip.frame_s = frame_s;
  if (!retargeter.doubt().empty()) clip.warnings.push_back(retargeter.doubt());
  const size_t count = ResampledFrameCount(motion, frame_s);
  const bool same_step = HasStep(motion, frame_s);
  clip.frames.reserve(count);
  AgreementCheck check(bones);
  for (size_t f = 0; f < count; ++f) {
    const SourceFrame frame =
        same_step ? motion.frame(f) : FrameAt(motion, static_cast<double>(f) * frame_s);
    clip.frames.push_back(retargeter.Pose(frame));
    if (f % (1 + count / kCheckedFrames) == 0) {
      check.Add(retargeter.ComputePlaces(frame), StandardPosture(clip.frames.back()));
    }
  }
  check.Require(motion.source);
  SetOnFloor(clip);
  return clip;
}

}  // namespace ossa::recon
