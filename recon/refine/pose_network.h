#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "depth/base/perceptron/convolution.h"
#include "depth/base/perceptron/quantised_convolution.h"
#include "recon/posture.h"
#include "recon/refine/person_crop.h"

namespace ossa::recon {

/// The pose network among the shipped files.
inline constexpr const char* kShippedPoseNetwork = "body.ossanet";

/// Where a pose network puts a person's joints, and how far off it expects each to be.
struct NetworkPose {
  Posture joints_m;              // camera space
  JointArray<double> error_m{};  // the mean distance from the true place, as it expects it
};

/// A convolutional network that reads the joints off the depth image of the whole person at once,
/// where a refinement cascade looks around each joint alone: what a forearm is, the trunk may tell.
/// Every cell of a coarse map votes for each joint, and the mean of their places, by their votes,
/// is the joint (Xiong et al. 2019, "A2J: anchor-to-joint regression"). Departure: votes, offsets
/// and depth come from one head; each joint comes with the scale of its error (Kendall and Gal
/// 2017), so that it can be fused with others. Learned from rendered people
/// (tools/train_pose_network).
class PoseNetwork {
 public:
  /// In the order in which they run: three steps down, a residual block (He et al. 2016), one step
  /// down, two blocks, the way up, what joins both maps, the votes.
  static constexpr size_t kLayers = 13;
  using Layers = std::array<Convolution, kLayers>;

  /// `people`: that it was learned from. Throws InputError where the layers do not fit together.
  PoseNetwork(Layers layers, uint64_t people, const std::string& name);

  NetworkPose Run(const PersonCrop& crop) const;
  uint64_t people() const { return people_; }
  const Layers& layers() const { return layers_; }

  /// .ossanet: reads refuse damaged, truncated and hostile files by name and byte.
  static constexpr uint32_t kVersion = 1;
  static PoseNetwork Load(const std::filesystem::path& path);
  static PoseNetwork FromBytes(std::span<const std::byte> bytes, const std::string& name);
  void Save(const std::filesystem::path& path) const;
  /// True when the file says that it is one; it may still be damaged.
  static bool IsFile(const std::filesystem::path& path);
  /// The numbers that tools/learning/train_pose_network.py writes: of each layer its inputs,
  /// outputs, size and stride, weights and bias. Throws InputError that names `name`.
  static PoseNetwork FromNumbers(std::span<const float> numbers, uint64_t people,
                                 const std::string& name);

 private:
  Layers layers_;
  std::array<QuantisedConvolution, kLayers> quantised_;  // the layers, ready to run
  uint64_t people_ = 0;
};

}  // namespace ossa::recon
