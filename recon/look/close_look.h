#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "depth/image/depth_frame.h"
#include "recon/gp/rectified_network.h"
#include "recon/posture.h"

namespace ossa::recon {

/// The close look at the shipped forest's joints, among the shipped files.
inline constexpr const char* kShippedLook = "body.ossalook";

/// A person whose joints were proposed, and the image they are seen in.
struct LookInput {
  Posture proposed;                              // camera space, metres
  std::array<double, kJointCount> confidence{};  // of each joint, [0, 1]
  std::array<bool, kJointCount> seen{};          // false: inferred from the other joints
  const depth::DepthFrame* depth = nullptr;      // the whole image; borrowed
  std::span<const uint8_t> is_person;  // of each of its pixels, row-major: 1 for this person's
};

/// Around each joint surface is sampled on two square grids across the line of sight.
inline constexpr int kLookGrid = 9;  // samples a side
inline constexpr std::array<double, 2> kLookSteps_m = {0.025, 0.07};
inline constexpr int kLookSamples = static_cast<int>(kLookSteps_m.size()) * kLookGrid * kLookGrid;

/// A person as a close look sees them, in axes of which z runs along the ray to the person and x is
/// level: it does not matter where in the image somebody stands.
struct LookDescription {
  /// Where no surface of the person is: the sensor looks past it, or at something nearer.
  static constexpr int16_t kBeside = 500, kHidden = -500;

  Eigen::Matrix3d frame_from_camera = Eigen::Matrix3d::Identity();
  Eigen::Vector3d middle_m = Eigen::Vector3d::Zero();  // of the person, camera space
  Posture place;                                       // proposed, from the middle, these axes
  std::array<double, kJointCount> confidence{};
  std::array<bool, kJointCount> seen{};
  /// Of each joint, by grid, row and column (x): how much farther than the joint surface lies
  /// there, millimetres, within 300.
  std::array<std::array<int16_t, kLookSamples>, kJointCount> behind_mm{};

  /// Nothing where a proposal is not finite or the image has not a pixel for each of `is_person`.
  static std::optional<LookDescription> Of(const LookInput& input);
  /// Of the mirror image: left and right exchanged.
  LookDescription Mirrored() const;
};

/// What the network of a joint reads: of each sample of the joint the surface, whether it is beside
/// and whether hidden; where all joints lie from this one, how confident they are and which are
/// seen; the middle.
inline constexpr int kLookInputs = 3 * kLookSamples + 5 * kJointCount + 3;
Eigen::VectorXf NumbersOf(const LookDescription& description, Joint joint);

/// Joints that have networks of their own: of a pair, the left one; the right one is looked at in
/// the mirror.
inline constexpr std::array<Joint, 12> kLookJoints = {
    Joint::kHipCenter,    Joint::kSpine,     Joint::kShoulderCenter, Joint::kHead,
    Joint::kShoulderLeft, Joint::kElbowLeft, Joint::kWristLeft,      Joint::kHandLeft,
    Joint::kHipLeft,      Joint::kKneeLeft,  Joint::kAnkleLeft,      Joint::kFootLeft};

/// Ours, of `best`: a forest proposes the likeliest place of each joint, which of a hidden one may
/// be far off; here a network a joint looks at the surface around the proposal and at all other
/// proposals, and says how far from it the joint lies in the mean. Frame by frame, no time in it.
/// Learned of a forest's proposals on rendered people (`ossa look`). The idea of correcting a first
/// pose by what the image shows around it is that of Dollar et al. 2010, "Cascaded pose
/// regression".
struct CloseLook {
  std::array<RectifiedNetwork, kLookJoints.size()> networks;  // kLookInputs -> 3, in kStep_m
  uint64_t people = 0;                                        // learned from

  static constexpr double kStep_m = 0.1;
  /// Whatever a network says, a joint goes no farther from its proposal.
  static constexpr double kFarthest_m = 0.6;

  /// The joints, camera space; nothing where LookDescription::Of has nothing to say.
  std::optional<Posture> Look(const LookInput& input) const;

  /// .ossalook: reads refuse damaged, truncated and hostile files by name and byte.
  static CloseLook Load(const std::filesystem::path& path);
  static CloseLook FromBytes(std::span<const std::byte> bytes, const std::string& name);
  void Save(const std::filesystem::path& path) const;
  /// True when the file says that it is one; it may still be damaged.
  static bool IsOne(const std::filesystem::path& path);
};

}  // namespace ossa::recon
