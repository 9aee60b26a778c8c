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

/// File name of the shipped pose network.
inline constexpr const char* kShippedPoseNetwork = "body.ossanet";

/// Joints predicted by a pose network, with their expected errors.
struct NetworkPose {
  Posture joints_m;              // camera space
  JointArray<double> error_m{};  // expected distance from the true position
};

/// A convolutional network that predicts all joints from the depth image of the whole person, while
/// a refinement cascade sees only the surroundings of each joint: the trunk may help to identify a
/// forearm. Every cell of a coarse map votes for each joint, and a joint is the mean of their
/// positions, weighted by votes (Xiong et al. 2019, "A2J: anchor-to-joint regression"). Departure:
/// votes, offsets and depth come from one head; each joint has an error scale (Kendall and Gal
/// 2017), so that it can be fused with other estimates. Trained on rendered people
/// (tools/train_pose_network).
class PoseNetwork {
 public:
  /// In execution order: three downsampling layers, a residual block (He et al. 2016), another
  /// downsampling layer, two blocks, upsampling, the layer that merges both maps, the votes.
  static constexpr size_t kLayers = 13;
  using Layers = std::array<Convolution, kLayers>;

  /// `people`: number of training people. Throws InputError if the layers do not fit together.
  PoseNetwork(Layers layers, uint64_t people, const std::string& name);

  NetworkPose Run(const PersonCrop& crop) const;
  uint64_t people() const { return people_; }
  const Layers& layers() const { return layers_; }

  /// .ossanet: reads refuse damaged, truncated and hostile files by name and byte.
  static constexpr uint32_t kVersion = 1;
  static PoseNetwork Load(const std::filesystem::path& path);
  static PoseNetwork FromBytes(std::span<const std::byte> bytes, const std::string& name);
  void Save(const std::filesystem::path& path) const;
  /// Whether the file has the format's magic number; it may still be damaged.
  static bool IsFile(const std::filesystem::path& path);
  /// From the numbers that tools/learning/train_pose_network.py writes: for each layer its inputs,
  /// outputs, size and stride, weights and bias. Throws InputError that names `name`.
  static PoseNetwork FromNumbers(std::span<const float> numbers, uint64_t people,
                                 const std::string& name);

 private:
  Layers layers_;
  std::array<QuantisedConvolution, kLayers> quantised_;  // the layers, quantised
  uint64_t people_ = 0;
};

}  // namespace ossa::recon
