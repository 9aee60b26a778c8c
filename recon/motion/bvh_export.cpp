#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "recon/motion/bvh.h"
#include "recon/motion/bvh_layout_internal.h"
#include "recon/motion/bvh_text_internal.h"
#include "recon/motion/held_body_internal.h"
#include "recon/motion/sightings_internal.h"
#include "recon/smallest_turn.h"
#include "recon/t_pose.h"

namespace ossa::recon {

using Eigen::Quaterniond;
using Eigen::Vector3d;

namespace {

ptrdiff_t CountChildren(size_t joint) {
  return std::count(kJointParent.begin(), kJointParent.end(), static_cast<int>(joint));
}

bool Branches(size_t joint) { return CountChildren(joint) > 1; }

BvhLayout SdkLayout(const BoneLengths& lengths) {
  const std::vector<BvhChannel> turns = BvhTurns();
  BvhLayout layout;
  BvhJoint root;
  root.name = NameOf(Joint::kHipCenter);
  root.channels = {BvhChannel::kXposition, BvhChannel::kYposition, BvhChannel::kZposition};
  root.channels.insert(root.channels.end(), turns.begin(), turns.end());
  layout.joints.push_back(root);
  for (size_t j = 1; j < kJointCount; ++j) {
    const auto parent = ParentOf(j);
    layout.turner[j] = layout.place[parent];
    if (Branches(parent)) {
      BvhJoint helper;
      helper.name.append(kJointNames[parent]).append("-").append(kJointNames[j]);
      helper.parent = static_cast<int>(layout.place[parent]);
      helper.channels = turns;
      layout.turner[j] = layout.joints.size();
      layout.joints.push_back(helper);
    }
    BvhJoint joint;
    joint.name = kJointNames[j];
    joint.parent = static_cast<int>(layout.turner[j]);
    joint.offset = kBvhCentimetres * lengths[j] * TPoseDirection(j);
    joint.channels = turns;
    if (CountChildren(j) == 0) joint.end_sites.push_back(kBvhEnd_cm * TPoseDirection(j));
    layout.place[j] = layout.joints.size();
    layout.joints.push_back(joint);
  }
  return layout;
}

/// Pelvis (or whole-body) frame: x from right to left hip, y as close to the spine as possible.
Quaterniond BodyFrame(const JointArray<Vector3d>& direction) {
  Vector3d left = direction[Index(Joint::kHipLeft)] - direction[Index(Joint::kHipRight)];
  const Vector3d up = direction[Index(Joint::kSpine)];
  if (left.cross(up).norm() < 1e-3) left = up.unitOrthogonal();
  left.normalize();
  const Vector3d front = left.cross(up).normalized();
  Eigen::Matrix3d frame;
  frame << left, front.cross(left), front;
  return Quaterniond(frame);
}

/// Offsets of the thighs in the hip frame: the mean over all sightings.
std::array<Vector3d, 2> HipOffsets(const SightingLog& seen) {
  std::array<Vector3d, 2> sum = {Vector3d::Zero(), Vector3d::Zero()};
  int count = 0;
  for (size_t i = 0; i < seen.size(); ++i) {
    const auto& joint = Sighting(seen[i]).joint;
    const auto at = [&](Joint j) { return joint[Index(j)]; };
    if (!at(Joint::kHipCenter) || !at(Joint::kHipLeft) || !at(Joint::kHipRight) ||
        !at(Joint::kSpine))
      continue;
    const Vector3d centre = *at(Joint::kHipCenter);
    JointArray<Vector3d> direction;
    direction[Joint::kHipLeft] = (*at(Joint::kHipLeft) - centre).normalized();
    direction[Joint::kHipRight] = (*at(Joint::kHipRight) - centre).normalized();
    direction[Joint::kSpine] = (*at(Joint::kSpine) - centre).normalized();
    const Quaterniond hips = BodyFrame(direction).conjugate();
    sum[0] += hips * (*at(Joint::kHipLeft) - centre);
    sum[1] += hips * (*at(Joint::kHipRight) - centre);
    ++count;
  }
  for (Vector3d& offset : sum) offset /= std::max(count, 1);
  return sum;
}

BvhLayout MakeLayout(BvhNames names, const BoneLengths& lengths, const SightingLog& seen) {
  return names == BvhNames::kSdk ? SdkLayout(lengths)
                                 : HumanoidLayout(names, lengths, HipOffsets(seen));
}

/// Euler angles of R = Rz Rx Ry, degrees.
Vector3d ZxyDegrees(const Quaterniond& rotation) {
  const Eigen::Matrix3d r = rotation.toRotationMatrix();
  const double x = std::asin(std::clamp(r(2, 1), -1.0, 1.0));
  double z, y;
  if (std::abs(r(2, 1)) > 1.0 - 1e-9) {  // gimbal lock: only their sum or difference is defined
    z = std::atan2(r(1, 0), r(0, 0));
    y = 0.0;
  } else {
    z = std::atan2(-r(0, 1), r(1, 1));
    y = std::atan2(-r(2, 0), r(2, 2));
  }
  return Vector3d(z, x, y) * (180.0 / std::numbers::pi);
}

void AppendFrame(const BvhLayout& layout, const Vector3d& root_m,
                 const JointArray<Vector3d>& direction, std::vector<double>& values) {
  std::vector<Quaterniond> world(layout.joints.size(), Quaterniond::Identity());
  world[0] = BodyFrame(direction);
  for (size_t j = 1; j < kJointCount; ++j) {
    const size_t turner = layout.turner[j];
    if (turner != 0) {
      const Quaterniond& carried = world[static_cast<size_t>(layout.joints[turner].parent)];
      world[turner] = SmallestTurn(carried * TPoseDirection(j), direction[j]) * carried;
    }
    if (layout.place[j] != kNoBvhJoint) world[layout.place[j]] = world[turner];
  }
  for (const double place : root_m) values.push_back(kBvhCentimetres * place);
  for (size_t i = 0; i < layout.joints.size(); ++i) {
    const Quaterniond local =
        i == 0 ? world[0]
               : world[static_cast<size_t>(layout.joints[i].parent)].conjugate() * world[i];
    for (const double angle : ZxyDegrees(local)) values.push_back(angle);
  }
}

/// The time of the first frame.
double FindBegin(const SkeletonSequence& sequence, const SightingLog& seen) {
  return std::min(sequence.frames.front().time_s, seen[0].time_s);
}

/// Converts a body to BVH channels, frame by frame.
class BvhBody {
 public:
  /// `name`: file name for messages.
  BvhBody(EvenSightings sightings, const BvhExportOptions& options, std::string name)
      : name_(std::move(name)),
        options_(options),
        sightings_(std::move(sightings)),
        body_(sightings_.seen()),
        layout_(MakeLayout(options.names, body_.lengths_m(), sightings_.seen())) {
    CheckLength();
  }

  const std::vector<BvhJoint>& joints() const { return layout_.joints; }
  size_t FrameCount() const { return static_cast<size_t>(sightings_.Count()); }

  /// Appends the channels' values of the next frame.
  void Next(std::vector<double>& values) {
    body_.Update(sightings_.Next());
    AppendFrame(layout_, body_.root_m(), body_.direction(), values);
  }

  [[noreturn]] void FailTooLong() const {
    constexpr double kMebi = 1 << 20;  // bytes, by definition
    const SightingGap gap = sightings_.LongestGap();
    throw InputError(fmt::format(
        "{}: expected a BVH of at most {:.4g} MiB, as ossa reads them, found {:.0f} frames of "
        "{:.4g} s, the longest gap without the body being of {:.7g} s after time_s {:.3f}: "
        ".jsonl has no such limit",
        name_, static_cast<double>(options_.most_bytes) / kMebi, sightings_.Count(),
        options_.frame_s, gap.length_s, gap.begin_s));
  }

 private:
  /// Refuses recordings that are certainly too long before any conversion.
  void CheckLength() const {
    constexpr double kLeastBytes = 2.0;  // bytes, by the format: a digit and a separator
    size_t channels = 0;
    for (const BvhJoint& joint : layout_.joints) channels += joint.channels.size();
    const double least_bytes = sightings_.Count() * kLeastBytes * static_cast<double>(channels);
    if (!(least_bytes <= static_cast<double>(options_.most_bytes))) FailTooLong();
  }

  std::string name_;
  BvhExportOptions options_;
  EvenSightings sightings_;
  HeldBody body_;
  BvhLayout layout_;
};

}  // namespace

BvhFile SkeletonToBvh(const SkeletonSequence& sequence, const BvhExportOptions& options) {
  const SightingLog seen =
      CollectSightings(sequence, options.body_id, std::filesystem::temp_directory_path());
  const double begin_s = FindBegin(sequence, seen);
  BvhBody body(EvenSightings(seen, begin_s, options.frame_s), options, sequence.source);
  BvhFile bvh;
  bvh.joints = body.joints();
  bvh.frame_s = options.frame_s;
  for (size_t f = 0; f < body.FrameCount(); ++f) body.Next(bvh.values);
  return bvh;
}

void WriteSightingsAsBvh(const SightingLog& seen, double begin_s, const std::filesystem::path& path,
                         const BvhExportOptions& options) {
  BvhBody body(EvenSightings(seen, begin_s, options.frame_s), options, path.string());
  AtomicFile file(path);
  std::string text = BvhHead(body.joints(), options.frame_s, body.FrameCount());
  size_t bytes = 0;
  std::vector<double> values;
  for (size_t f = 0; f < body.FrameCount(); ++f) {
    values.clear();
    body.Next(values);
    AppendBvhFrame(text, values);
    bytes += text.size();
    if (bytes > options.most_bytes) body.FailTooLong();
    file.stream() << text;
    text.clear();
  }
  file.Commit();
}

void WriteSkeletonAsBvh(const SkeletonSequence& sequence, const std::filesystem::path& path,
                        const BvhExportOptions& options) {
  const SightingLog seen = CollectSightings(sequence, options.body_id, FolderOf(path));
  WriteSightingsAsBvh(seen, FindBegin(sequence, seen), path, options);
}

}  // namespace ossa::recon
