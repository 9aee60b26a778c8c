#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "depth/image/depth_frame.h"
#include "recon/models/network_runner.h"
#include "recon/models/rectified_network.h"
#include "recon/posture.h"
#include "recon/refine/surface_samples.h"

namespace ossa::recon {

/// The close look at the shipped forest's joints, among the shipped files.
inline constexpr const char* kShippedLook = "body.ossalook";

/// A person whose joints were proposed, and the image they are seen in.
struct LookInput {
  Posture proposed;                          // camera space, metres
  JointArray<double> confidence{};           // of each joint, [0, 1]
  JointArray<bool> seen{};                   // false: inferred from the other joints
  const depth::DepthFrame* depth = nullptr;  // the whole image; borrowed
  std::span<const uint8_t> is_person;  // of each of its pixels, row-major: 1 for this person's
  Posture moved;  // from the forest's proposals to `proposed`, by earlier glances; metres
  std::optional<BoneLengths> bones_m;  // the person's, where earlier frames have told them

  /// After a glance that put the joints there.
  LookInput MovedTo(const Posture& joints_m) const;
};

/// Where a person's joints are said to be, in axes of which z runs along the ray to the person and
/// x is level: it does not matter where in the image somebody stands.
struct ProposedPerson {
  Eigen::Matrix3d frame_from_camera = Eigen::Matrix3d::Identity();
  Eigen::Vector3d middle_m = Eigen::Vector3d::Zero();  // of the person, camera space
  Posture place;                                       // proposed, from the middle, these axes
  JointArray<double> confidence{};
  JointArray<bool> seen{};
  Posture moved;  // by earlier glances, these axes

  /// Nothing where a proposal is not finite or the image has not a pixel for each of `is_person`.
  static std::optional<ProposedPerson> Of(const LookInput& input);
  /// Of the mirror image: left and right exchanged.
  ProposedPerson Mirrored() const;
};

/// Of each joint, whether it is looked at.
using JointSet = JointArray<bool>;
inline constexpr JointSet kAllJoints = [] {
  JointSet all{};
  all.fill(true);
  return all;
}();

/// A person as a close look sees them.
struct LookDescription : ProposedPerson {
  /// Of each joint; see SurfaceSampler::Around.
  JointArray<std::array<LookSample, kLookSamples>> samples{};

  /// Nothing where ProposedPerson has nothing. Of joints that are not looked at no surface is
  /// sampled.
  static std::optional<LookDescription> Of(const LookInput& input,
                                           const JointSet& looked_at = kAllJoints);
  LookDescription Mirrored() const;
};

/// What the network of a joint reads: of each sample of the joint how far behind it surface lies,
/// metres, times the share of it, then the shares beside and hidden; where all joints lie from this
/// one, how far earlier glances moved them, how confident they are and which are seen; the middle.
inline constexpr int kLookInputs = 3 * kLookSamples + 8 * kJointCount + 3;
Eigen::VectorXf NumbersOf(const LookDescription& description, Joint joint);

/// Joints that have networks of their own: of a pair, the left one; the right one is looked at in
/// the mirror.
inline constexpr std::array<Joint, 12> kLookJoints = {
    Joint::kHipCenter,    Joint::kSpine,     Joint::kShoulderCenter, Joint::kHead,
    Joint::kShoulderLeft, Joint::kElbowLeft, Joint::kWristLeft,      Joint::kHandLeft,
    Joint::kHipLeft,      Joint::kKneeLeft,  Joint::kAnkleLeft,      Joint::kFootLeft};

/// A network a joint looks at the surface around where the joint is said to be and at where all
/// others are, and says how far from there the joint lies in the mean.
using Glance = std::array<RectifiedNetwork, kLookJoints.size()>;  // kLookInputs -> 3, in kStep_m

/// Ours, of `best`: a forest proposes the likeliest place of each joint, which of a hidden one may
/// be far off; glances, the first at the proposals, each later one at where the one before it put
/// the joints, move them. Frame by frame; of other frames it is told the bones alone. Learned of a
/// forest's proposals on rendered people (`ossa look`). The idea of correcting a pose again and
/// again by what the image shows around it is that of Dollar et al. 2010, "Cascaded pose
/// regression".
struct CloseLook {
  std::vector<Glance> glances;
  RectifiedNetwork bones;  // kBoneInputs -> kMeasuredBones, see bone_measure.h; or empty
  /// After the bones: glances whose networks are told them (kToldInputs), none without.
  std::vector<Glance> told;
  uint64_t people = 0;    // that the glance made last, of either kind, was learned from
  uint64_t measured = 0;  // people whose bones were learned from

  static constexpr double kStep_m = 0.1;
  /// Whatever a network says, at one glance a joint goes no farther.
  static constexpr double kFarthest_m = 0.6;
  /// A joint that a glance moves by less is where it is: the next one, which would move it by less
  /// still, spares the time. The first that is told of the bones looks at all of them again.
  static constexpr double kAtRest_m = 0.008;
  static constexpr size_t kMostGlances = 8;  // of either kind

  /// .ossalook: reads refuse damaged, truncated and hostile files by name and byte. Version 5,
  /// which is still read, is not compressed; version 4 has no glances that are told of the bones,
  /// either.
  static constexpr uint32_t kVersion = 6, kOldestVersion = 4;
  static CloseLook Load(const std::filesystem::path& path);
  /// Of a payload that is not compressed, or no longer.
  static CloseLook FromBytes(std::span<const std::byte> bytes, const std::string& name,
                             uint32_t version = kVersion);
  void Save(const std::filesystem::path& path) const;
  /// True when the file says that it is one; it may still be damaged.
  static bool IsOne(const std::filesystem::path& path);
};

/// What a close look makes of a person.
struct Looked {
  Posture joints_m;                    // camera space
  std::optional<BoneLengths> bones_m;  // judged from this frame alone, if that was learned
};

/// A close look made ready to be had often.
class Looker {
 public:
  explicit Looker(const CloseLook& look);

  /// Nothing where LookDescription::Of has nothing to say at first.
  std::optional<Looked> Look(const LookInput& input) const;

 private:
  using Networks = std::span<const NetworkRunner>;  // of glances, one after the other

  static LookInput Glanced(Networks networks, LookInput input);
  static Posture Moved(Networks of_joints, const LookInput& input, const LookDescription& seen,
                       const JointSet& looked_at);

  // Of the glances; of the bones, if they are measured; of the glances that are told them.
  std::vector<NetworkRunner> networks_;
  size_t before_bones_ = 0;
};

}  // namespace ossa::recon
