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

/// File name of the shipped refinement cascade, trained for the shipped forest.
inline constexpr const char* kShippedRefinement = "body.ossarefine";

/// A person's proposed joints, and the image.
struct RefinementInput {
  Posture proposed;
  JointArray<double> confidence{};
  JointArray<bool> seen{};                   // false: inferred from the other joints
  const depth::DepthFrame* depth = nullptr;  // the whole image; borrowed
  std::span<const uint8_t> is_person;        // per pixel, row-major: 1 for this person's
  Posture moved;  // displacement from the forest's proposals, by earlier stages; metres
  std::optional<BoneLengths> bones_m;  // the person's, if known from earlier frames
  /// a b c d of ax + by + cz + d = 0, camera space, (a, b, c) up. Read only by cascades for views
  /// from above.
  std::optional<Eigen::Vector4d> floor;

  /// The input after a stage that moved the joints to `joints_m`.
  RefinementInput MovedTo(const Posture& joints_m) const;
};

/// A person's proposed joints in person-centred axes: z along the ray; x level, or, if the input
/// has a floor, from the left side of the body to the right one, because seen from above people may
/// face in any direction.
struct ProposedPerson : ViewFrame {
  Posture place;  // proposed joints, relative to the middle, these axes
  /// The person's location, as a network input: the middle in camera space; or, if the input has a
  /// floor, the point on it below the middle, relative to the middle, in these axes. Metres.
  Eigen::Vector3d where_m = Eigen::Vector3d::Zero();
  JointArray<double> confidence{};
  JointArray<bool> seen{};
  Posture moved;  // displacement by earlier stages, these axes

  /// None if a proposal is not finite or `is_person` does not match the image size.
  static std::optional<ProposedPerson> Locate(const RefinementInput& input);
  /// The mirror image: left and right exchanged.
  ProposedPerson Mirrored() const;
};

/// Selects the joints to refine.
using JointSet = JointArray<bool>;
inline constexpr JointSet kAllJoints = [] {
  JointSet all{};
  all.fill(true);
  return all;
}();

/// A person as a stage's input: the joints, and the surface around each.
struct SampledPerson : ProposedPerson {
  /// Per joint; see SurfaceSampler::Around.
  JointArray<std::array<SurfaceSample, kSurfaceSamples>> samples{};

  /// None if ProposedPerson has none. No surface is sampled around joints that are not `chosen`.
  static std::optional<SampledPerson> Sample(const RefinementInput& input,
                                             const JointSet& chosen = kAllJoints);
  SampledPerson Mirrored() const;
};

/// Inputs of a joint's network: for each sample the depth of the surface behind the joint, metres,
/// times its share, then the background and occluded shares; for all joints the position relative
/// to this one, the displacement by earlier stages, confidence and visibility;
/// ProposedPerson::where_m.
inline constexpr int kStageFeatures = 3 * kSurfaceSamples + 8 * kJointCount + 3;
Eigen::RowVectorXf ComputeStageFeatures(const SampledPerson& person, Joint joint);

/// Joints with their own networks: the left one of a pair; the right one is refined in the mirror
/// image.
inline constexpr std::array<Joint, 12> kStageJoints = {
    Joint::kHipCenter,    Joint::kSpine,     Joint::kShoulderCenter, Joint::kHead,
    Joint::kShoulderLeft, Joint::kElbowLeft, Joint::kWristLeft,      Joint::kHandLeft,
    Joint::kHipLeft,      Joint::kKneeLeft,  Joint::kAnkleLeft,      Joint::kFootLeft};

/// One network for each of kStageJoints, kStageFeatures -> 3. From the surface around the proposed
/// joint and the positions of all others it predicts the mean displacement to the true joint (in
/// units of RefinementCascade::kOffsets.step_m, ProposedPerson's axes).
using RefinementStage = std::array<Perceptron, kStageJoints.size()>;

/// Cascaded pose regression (Dollar et al. 2010) on the depth image, with features of our own. The
/// forest proposes the most likely position of each joint, which may be far off for hidden joints.
/// Stages correct it, each starting from the result of the one before. Each frame is independent,
/// except for the given bone lengths. Trained on a forest's proposals for rendered people (`ossa
/// refine`).
struct RefinementCascade {
  /// Trained for cameras under the ceiling: needs the floor, and aligns the axes with each body's
  /// heading.
  bool from_above = false;
  /// ReadContainerChecksum() of the forest whose joints the first stage refines; 0 if unknown.
  uint64_t forest_checksum = 0;
  std::vector<RefinementStage> stages;
  Perceptron bones;  // kBoneFeatures -> kEstimatedBones, see bone_estimation.h; or empty
  /// Stages after bone estimation, whose networks also read the bones (kBoneConditionedFeatures);
  /// empty without `bones`.
  std::vector<RefinementStage> bone_conditioned;
  uint64_t people = 0;    // training people of the stage trained last, of either kind
  uint64_t measured = 0;  // training people of `bones`

  /// Scale of the network outputs; part of every cascade.
  static constexpr OffsetScale kOffsets = {.step_m = 0.1, .farthest_m = 0.6};
  /// A joint that a stage moves by less has converged and is skipped by the later stages, to save
  /// time. The first bone-conditioned stage refines all joints again.
  static constexpr double kAtRest_m = 0.008;
  static constexpr size_t kMaxStages = 8;  // of either kind

  /// .ossarefine, formerly .ossalook: reads refuse damaged, truncated and hostile files by name and
  /// byte. Versions 4 to 7 are still read: 7 does not name the forest, 6 does not say whether the
  /// view is from above (it is not), 5 is not compressed, and 4 has no bone-conditioned stages.
  static constexpr uint32_t kVersion = 8, kOldestVersion = 4;
  static RefinementCascade Load(const std::filesystem::path& path);
  /// Parses a decompressed payload.
  static RefinementCascade FromBytes(std::span<const std::byte> bytes, const std::string& name,
                                     uint32_t version = kVersion);
  void Save(const std::filesystem::path& path) const;
  /// Whether the file has the format's magic number; it may still be damaged.
  static bool IsFile(const std::filesystem::path& path);
};

/// A person's joints after all stages.
struct RefinedPerson {
  Posture joints_m;                    // camera space
  std::optional<BoneLengths> bones_m;  // estimated from this frame alone, if `bones` was trained
};

/// A refinement cascade prepared for repeated use.
class JointRefiner {
 public:
  explicit JointRefiner(const RefinementCascade& cascade);
  /// As JointRefiner(RefinementCascade::Load(path)), but one network at a time: before quantisation
  /// a whole cascade takes four times the memory.
  static JointRefiner Load(const std::filesystem::path& path);

  /// None if SampledPerson::Sample has none for the input, and for a cascade from above without a
  /// floor.
  std::optional<RefinedPerson> Refine(const RefinementInput& input) const;
  /// As RefinementCascade::from_above.
  bool from_above() const { return from_above_; }
  /// As RefinementCascade::forest_checksum.
  uint64_t forest_checksum() const { return forest_checksum_; }

 private:
  JointRefiner() = default;
  using Networks = std::span<const QuantisedPerceptron>;  // networks of consecutive stages

  static RefinementInput RunStages(Networks networks, RefinementInput input);
  static Posture RunStage(Networks of_joints, const RefinementInput& input,
                          const SampledPerson& seen, const JointSet& chosen);

  // Networks of the stages; of the bones, if estimated; of the bone-conditioned stages.
  std::vector<QuantisedPerceptron> networks_;
  size_t before_bones_ = 0;
  bool from_above_ = false;
  uint64_t forest_checksum_ = 0;
};

}  // namespace ossa::recon
