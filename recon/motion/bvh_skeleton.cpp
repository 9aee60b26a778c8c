#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "recon/motion/bone_names_internal.h"
#include "recon/motion/bvh.h"
#include "recon/motion/bvh_source_internal.h"
#include "recon/motion/up_axis_internal.h"
#include "recon/normalise.h"

namespace ossa::recon {
namespace {

using Eigen::Vector3d;

constexpr size_t kJoints = kJointCount;
constexpr double kCentimetres = 100.0;  // per metre; the unit of our own BVH and most others

using Places = std::array<std::optional<Vector3d>, kJoints>;

/// A length unit of BVH files, and the plausible range of leg lengths, hip to ankle, in it.
struct LengthUnit {
  const char* name;
  double metres;
  double shortest, longest;  // units
};

/// The first unit that fits is used. Legs are 0.45 of the height (anthropometry: NASA-STD-3000,
/// 0.43 to 0.48 for adults): in centimetres of bodies from 0.85 m, a two-year-old child, upwards.
/// Shorter legs are more likely inches (adults' legs: 30 to 38), or CMU's units of 1/0.45 inch (13
/// to 17).
constexpr LengthUnit kUnits[] = {{"centimetres", 0.01, 38.5, 150.0},
                                 {"metres", 1.0, 0.15, 1.5},
                                 {"millimetres", 0.001, 150.0, 1500.0},
                                 {"inches", 0.0254, 24.0, 38.5},
                                 {"the CMU's units of 1/0.45 inch", 0.0254 / 0.45, 12.0, 24.0},
                                 {"decimetres", 0.1, 1.5, 12.0}};

/// Converts one person of a BVH to 20 joints.
class Person {
 public:
  Person(BvhFile bvh, const std::string& source, const BoneMapping* mapping)
      : motion_(ToSourceMotion(std::move(bvh), source)), bones_(FindBones(motion_, mapping)) {
    FindUnit();
    FindUp();
  }

  Places At(size_t frame) const {
    SourceFrame source = motion_.frame(frame);
    Places places;
    PutTrunk(source, places);
    for (size_t s = 0; s < 2; ++s) {
      PutArm(source, s, places);
      PutLeg(source, s, places);
    }
    for (auto& place : places) {
      if (place) *place = metres_per_unit_ * (ours_from_file_ * *place);
    }
    return places;
  }

  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  static Vector3d Of(const SourceFrame& frame, int joint) {
    return frame.position[static_cast<size_t>(joint)];
  }
  static std::optional<Vector3d>& In(Places& places, Joint joint) { return places[Index(joint)]; }

  void FindUnit() {
    const double leg = LegLength(motion_.frame(0).position, bones_);
    for (const LengthUnit& unit : kUnits) {
      if (leg < unit.shortest || leg > unit.longest) continue;
      metres_per_unit_ = unit.metres;
      if (&unit == kUnits) return;
      warnings_.push_back(
          fmt::format("{}: legs of {:.3g} units are no person's in centimetres: "
                      "lengths are read as {}",
                      motion_.source, leg, unit.name));
      return;
    }
    warnings_.push_back(
        fmt::format("{}: legs of {:.3g} units are no person's in any usual unit: "
                    "lengths are read as centimetres",
                    motion_.source, leg));
  }

  void FindUp() {
    const auto rest = ZeroPose(motion_.joints);
    std::optional<Vector3d> rest_up;
    if (IsRestPose(rest, bones_)) rest_up = NearestAxis(TrunkDirection(rest, bones_));
    const UpAxis up = FindUpAxis(motion_, bones_, rest_up);
    if (!up.doubt.empty()) warnings_.push_back(up.doubt);
    if (!up.by_motion || up.axis != Vector3d::UnitZ()) return;
    ours_from_file_ << 1, 0, 0, 0, 0, 1, 0, -1, 0;
    warnings_.push_back(motion_.source + ": the body stands along z: z is taken as up");
  }

  void PutTrunk(const SourceFrame& frame, Places& places) const {
    In(places, Joint::kHipCenter) = Of(frame, bones_.hips);
    const int neck =
        !bones_.neck.empty() && bones_.neck.front() != bones_.head ? bones_.neck.front() : -1;
    const Vector3d base =
        neck >= 0 ? Of(frame, neck)
                  : Vector3d(0.5 * (Of(frame, bones_.side[0].arm) + Of(frame, bones_.side[1].arm)));
    In(places, Joint::kShoulderCenter) = base;
    In(places, Joint::kSpine) = AlongSpine(frame, base);
    if (bones_.head >= 0) {
      In(places, Joint::kHead) = Of(frame, bones_.head);
    } else if (neck >= 0) {
      In(places, Joint::kHead) = EndOf(frame, bones_.neck.back());
    }
  }

  /// The point on the line through hips, spine and neck at the relative position of the standard
  /// body's Spine.
  Vector3d AlongSpine(const SourceFrame& frame, const Vector3d& neck) const {
    const BoneLengths& standard = StandardBoneLengths();
    constexpr auto kSpine = Index(Joint::kSpine);
    constexpr auto kNeck = Index(Joint::kShoulderCenter);
    const double share = standard[kSpine] / (standard[kSpine] + standard[kNeck]);
    std::vector<Vector3d> line = {Of(frame, bones_.hips)};
    for (const int joint : bones_.spine) line.push_back(Of(frame, joint));
    line.push_back(neck);
    double length = 0.0;
    for (size_t i = 1; i < line.size(); ++i) length += (line[i] - line[i - 1]).norm();
    double left = share * length;
    for (size_t i = 1; i < line.size(); ++i) {
      const double piece = (line[i] - line[i - 1]).norm();
      if (left <= piece && piece > 0) return line[i - 1] + left / piece * (line[i] - line[i - 1]);
      left -= piece;
    }
    return neck;
  }

  /// The end of a joint's segment: the mean of its children, or its end site; none if it has
  /// neither.
  std::optional<Vector3d> EndOf(const SourceFrame& frame, int joint) const {
    Vector3d sum = Vector3d::Zero();
    int count = 0;
    for (size_t j = 0; j < motion_.joints.size(); ++j) {
      if (motion_.joints[j].parent != joint) continue;
      sum += frame.position[j];
      ++count;
    }
    if (count > 0) return sum / count;
    const auto& ends = motion_.joints[static_cast<size_t>(joint)].end_sites;
    if (ends.empty()) return std::nullopt;
    return Of(frame, joint) + frame.rotation[static_cast<size_t>(joint)] * ends.front();
  }

  /// A point from `joint` towards `end`, at the standard length of bone `last` scaled by `length`
  /// over the standard length of `before`.
  static Vector3d Towards(const Vector3d& joint, const Vector3d& end, double length, Joint last,
                          Joint before) {
    const BoneLengths& standard = StandardBoneLengths();
    const double share = standard[Index(last)] / standard[Index(before)];
    return joint + share * length * (end - joint).normalized();
  }

  void PutArm(const SourceFrame& frame, size_t s, Places& places) const {
    const SideBones& side = bones_.side[s];
    const bool left = s == 0;
    const Joint wrist_joint = left ? Joint::kWristLeft : Joint::kWristRight;
    const Joint hand_joint = left ? Joint::kHandLeft : Joint::kHandRight;
    const Vector3d elbow = Of(frame, side.fore_arm);
    In(places, left ? Joint::kShoulderLeft : Joint::kShoulderRight) = Of(frame, side.arm);
    In(places, left ? Joint::kElbowLeft : Joint::kElbowRight) = elbow;
    const std::optional<Vector3d> wrist =
        side.hand >= 0 ? Of(frame, side.hand) : EndOf(frame, side.fore_arm);
    In(places, wrist_joint) = wrist;
    if (!wrist) return;
    Vector3d end = *wrist + (*wrist - elbow);
    if (side.hand >= 0) end = EndOf(frame, side.hand).value_or(end);
    if ((end - *wrist).norm() < 1e-9) end = *wrist + (*wrist - elbow);
    const double fore_arm = (*wrist - elbow).norm();
    In(places, hand_joint) = side.palm >= 0
                                 ? Of(frame, side.palm)
                                 : Towards(*wrist, end, fore_arm, hand_joint, wrist_joint);
  }

  void PutLeg(const SourceFrame& frame, size_t s, Places& places) const {
    const SideBones& side = bones_.side[s];
    const bool left = s == 0;
    const Joint ankle_joint = left ? Joint::kAnkleLeft : Joint::kAnkleRight;
    const Joint foot_joint = left ? Joint::kFootLeft : Joint::kFootRight;
    const Vector3d knee = Of(frame, side.leg), ankle = Of(frame, side.foot);
    In(places, left ? Joint::kHipLeft : Joint::kHipRight) = Of(frame, side.up_leg);
    In(places, left ? Joint::kKneeLeft : Joint::kKneeRight) = knee;
    In(places, ankle_joint) = ankle;
    if (side.toe >= 0) {
      In(places, foot_joint) = Of(frame, side.toe);
    } else if (const auto end = EndOf(frame, side.foot); end && (*end - ankle).norm() > 1e-9) {
      In(places, foot_joint) = Towards(ankle, *end, (ankle - knee).norm(), foot_joint, ankle_joint);
    }
  }

  SourceMotion motion_;
  SourceBones bones_;
  double metres_per_unit_ = 1.0 / kCentimetres;
  Eigen::Matrix3d ours_from_file_ = Eigen::Matrix3d::Identity();
  std::vector<std::string> warnings_;
};

bool HasSdkJoints(const BvhFile& bvh) {
  return std::all_of(kJointNames.begin(), kJointNames.end(), [&](std::string_view name) {
    return std::any_of(bvh.joints.begin(), bvh.joints.end(),
                       [&](const BvhJoint& joint) { return joint.name == name; });
  });
}

void AddBody(SkeletonFrame& frame, int id, const Places& places) {
  BodyRecord body;
  body.id = id;
  for (size_t j = 0; j < kJoints; ++j) {
    if (places[j]) body.joints[j].emplace().position_m = *places[j];
  }
  frame.bodies.push_back(std::move(body));
}

void AddSdkBody(const BvhFile& bvh, int id, SkeletonSequence& sequence) {
  std::array<size_t, kJoints> at{};
  for (size_t j = 0; j < kJoints; ++j) {
    while (bvh.joints[at[j]].name != kJointNames[j]) ++at[j];
  }
  for (size_t f = 0; f < sequence.frames.size(); ++f) {
    const BvhFramePose pose = ComputePose(bvh, f);
    Places places;
    for (size_t j = 0; j < kJoints; ++j) places[j] = pose.position[at[j]] / kCentimetres;
    AddBody(sequence.frames[f], id, places);
  }
}

void AddPerson(const Person& person, int id, SkeletonSequence& sequence) {
  for (size_t f = 0; f < sequence.frames.size(); ++f) {
    AddBody(sequence.frames[f], id, person.At(f));
  }
  sequence.warnings.insert(sequence.warnings.end(), person.warnings().begin(),
                           person.warnings().end());
}

}  // namespace

SkeletonSequence BvhToSkeleton(BvhFile bvh, const std::string& source, const BoneMapping* mapping) {
  SkeletonSequence sequence;
  sequence.source = source;
  sequence.warnings = bvh.warnings;
  sequence.frames.resize(bvh.FrameCount());
  for (size_t f = 0; f < sequence.frames.size(); ++f) {
    sequence.frames[f].frame = static_cast<int64_t>(f);
    sequence.frames[f].time_s = static_cast<double>(f) * bvh.frame_s;
  }
  int bodies = 0;
  ForEachPerson(std::move(bvh), source, sequence.warnings, [&](BvhFile root) {
    if (HasSdkJoints(root)) {
      AddSdkBody(root, bodies + 1, sequence);
    } else {
      AddPerson(Person(std::move(root), source, mapping), bodies + 1, sequence);
    }
    ++bodies;
  });
  return sequence;
}

}  // namespace ossa::recon
