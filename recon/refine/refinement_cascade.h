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

#include "depth/base/perceptron/perceptron.h"
#include "depth/base/perceptron/pose_regression.h"
#include "depth/base/perceptron/quantised_perceptron.h"
#include "depth/image/depth_frame.h"
#include "recon/posture.h"
#include "recon/refine/surface_samples.h"

namespace ossa::recon {

// Constants: chosen on validation subjects, between time and error; see
// docs/benchmarks/refinement.md.

/// The shipped refinement cascade: learned at the shipped forest's joints.
inline constexpr const char* kShippedRefinement = "body.ossarefine";

/// A person whose joints were proposed, and the image they are seen in.
struct RefinementInput {
  Posture proposed;                          // camera space, metres
  JointArray<double> confidence{};           // of each joint, [0, 1]
  JointArray<bool> seen{};                   // false: inferred from the other joints
  const depth::DepthFrame* depth = nullptr;  // the whole image; borrowed
  std::span<const uint8_t> is_person;  // of each of its pixels, row-major: 1 for this person's
  Posture moved;  // from the forest's proposals to `proposed`, by earlier stages; metres
  std::optional<BoneLengths> bones_m;  // the person's, where earlier frames have shown them
  /// a b c d of ax + by + cz + d = 0, camera space, (a, b, c) up. Read by cascades from above only.
  std::optional<Eigen::Vector4d> floor;

  /// After a stage that put the joints there.
  RefinementInput MovedTo(const Posture& joints_m) const;
};

/// Where a person's joints are proposed, in axes that stand in the person: z along the ray; x
/// level, or, where the input has a floor, from the left side of the body to the right one, for
/// from above people face any way in the image.
struct ProposedPerson : ViewFrame {
  Posture place;  // proposed, from the middle, these axes
  /// What networks are told of the place: the middle, camera space; or, where the input has a
  /// floor, the place on it below the middle, from there, these axes. Metres.
  Eigen::Vector3d where_m = Eigen::Vector3d::Zero();
  JointArray<double> confidence{};
  JointArray<bool> seen{};
  Posture moved;  // by earlier stages, these axes

  /// Nothing where a proposal is not finite or the image has not a pixel for each of `is_person`.
  static std::optional<ProposedPerson> Locate(const RefinementInput& input);
  /// Of the mirror image: left and right exchanged.
  ProposedPerson Mirrored() const;
};

/// Of each joint, whether it is to be refined.
using JointSet = JointArray<bool>;
inline constexpr JointSet kAllJoints = [] {
  JointSet all{};
  all.fill(true);
  return all;
}();

/// A person as a stage sees them: the joints, and the surface around each.
struct SampledPerson : ProposedPerson {
  /// Of each joint; see SurfaceSampler::Around.
  JointArray<std::array<SurfaceSample, kSurfaceSamples>> samples{};

  /// Nothing where ProposedPerson has nothing. Around joints that are not `chosen` no surface is
  /// sampled.
  static std::optional<SampledPerson> Sample(const RefinementInput& input,
                                             const JointSet& chosen = kAllJoints);
  SampledPerson Mirrored() const;
};

/// What the network of a joint reads: of each sample of the joint how far behind it surface lies,
/// metres, times the share of it, then the shares beside and hidden; where all joints lie from this
/// one, how far earlier stages moved them, how confident they are and which are seen;
/// ProposedPerson::where_m.
inline constexpr int kStageFeatures = 3 * kSurfaceSamples + 8 * kJointCount + 3;
Eigen::RowVectorXf ComputeStageFeatures(const SampledPerson& person, Joint joint);

/// Joints that have networks of their own: of a pair, the left one; the right one is refined in the
/// mirror image.
inline constexpr std::array<Joint, 12> kStageJoints = {
    Joint::kHipCenter,    Joint::kSpine,     Joint::kShoulderCenter, Joint::kHead,
    Joint::kShoulderLeft, Joint::kElbowLeft, Joint::kWristLeft,      Joint::kHandLeft,
    Joint::kHipLeft,      Joint::kKneeLeft,  Joint::kAnkleLeft,      Joint::kFootLeft};

/// A network for each of kStageJoints, kStageFeatures -> 3: from the surface around where the joint
/// is proposed, and from where all others are, how far from there the joint lies in the mean (steps
/// of RefinementCascade::kOffsets.step_m, ProposedPerson's axes).
using RefinementStage = std::array<Perceptron, kStageJoints.size()>;

/// Cascaded pose regression (Dollar et al. 2010) at the depth image, ours in what it reads: a
/// forest proposes the likeliest place of each joint, which of a hidden one may be far off; stages
/// move them, the first from the proposals, each later one from where the one before it put the
/// joints. Frame by frame; of other frames only the bones are given. Learned from a forest's
/// proposals on rendered people (`ossa refine`).
struct RefinementCascade {
  /// Learned on people seen from above, by a camera under the ceiling: needs the floor, and turns
  /// the axes to where each body faces.
  bool from_above = false;
  /// Of the forest at whose joints the first stage begins: ReadContainerChecksum() of its file; 0
  /// where that is not known.
  uint64_t forest_checksum = 0;
  std::vector<RefinementStage> stages;
  Perceptron bones;  // kBoneFeatures -> kEstimatedBones, see bone_estimation.h; or empty
  /// After the bones: stages whose networks also read them (kBoneConditionedFeatures); none
  /// without.
  std::vector<RefinementStage> bone_conditioned;
  uint64_t people = 0;    // that the stage made last, of either kind, was learned from
  uint64_t measured = 0;  // people whose bones were learned from

  /// Of what the stages' networks say; part of every cascade.
  static constexpr OffsetScale kOffsets = {.step_m = 0.1, .farthest_m = 0.6};
  /// A joint that a stage moves by less is where it is: the next one, which would move it by less
  /// still, spares the time. The first bone-conditioned stage
  /// refines all of them again.
  static constexpr double kAtRest_m = 0.008;
  static constexpr size_t kMaxStages = 8;  // of either kind

  /// .ossarefine, formerly .ossalook: reads refuse damaged, truncated and hostile files by name and
  /// byte. Versions 4 to 7 are still read: 7 does not say which forest's joints were refined, 6 not
  /// whether the people are seen from above (they are not), 5 is not compressed, either, and 4 has
  /// no bone-conditioned stages.
  static constexpr uint32_t kVersion = 8, kOldestVersion = 4;
  static RefinementCascade Load(const std::filesystem::path& path);
  /// Of a payload that is not compressed, or no longer.
  static RefinementCascade FromBytes(std::span<const std::byte> bytes, const std::string& name,
                                     uint32_t version = kVersion);
  void Save(const std::filesystem::path& path) const;
  /// True when the file says that it is one; it may still be damaged.
  static bool IsFile(const std::filesystem::path& path);
};

/// A person's joints after all stages.
struct RefinedPerson {
  Posture joints_m;                    // camera space
  std::optional<BoneLengths> bones_m;  // estimated from this frame alone, if that was learned
};

/// A refinement cascade made ready to run often.
class JointRefiner {
 public:
  explicit JointRefiner(const RefinementCascade& cascade);
  /// As JointRefiner(RefinementCascade::Load(path)), network by network: all of a cascade's, before
  /// their weights are bytes again, take four times the memory.
  static JointRefiner Load(const std::filesystem::path& path);

  /// Nothing where SampledPerson::Sample has nothing to say at first, and from above without a
  /// floor.
  std::optional<RefinedPerson> Refine(const RefinementInput& input) const;
  /// As RefinementCascade::from_above.
  bool from_above() const { return from_above_; }
  /// As RefinementCascade::forest_checksum.
  uint64_t forest_checksum() const { return forest_checksum_; }

 private:
  JointRefiner() = default;
  using Networks = std::span<const QuantisedPerceptron>;  // of stages, one after the other

  static RefinementInput RunStages(Networks networks, RefinementInput input);
  static Posture RunStage(Networks of_joints, const RefinementInput& input,
                          const SampledPerson& seen, const JointSet& chosen);

  // Of the stages; of the bones, if they are estimated; of the bone-conditioned stages.
  std::vector<QuantisedPerceptron> networks_;
  size_t before_bones_ = 0;
  bool from_above_ = false;
  uint64_t forest_checksum_ = 0;
};

}  // namespace ossa::recon
