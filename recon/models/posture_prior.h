#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "recon/models/prior_network.h"
#include "recon/normalise.h"
#include "recon/posture.h"

namespace ossa::recon {

// Constants: chosen on validation subjects (`ossa experiment shum-2013 --seed 11`).

/// File name of the shipped prior.
inline constexpr const char* kShippedPrior = "posture.ossaprior";

/// A motion to learn from: a person of any size, in any y-up frame, facing anywhere.
struct PriorClip {
  std::vector<Posture> postures;
  double frame_s = 1.0 / 30.0;
  double weight = 1.0;  // of one of its frames
};

/// Chosen on CMU subjects left out of learning (table III of Shum 2013; hands alone, hands and
/// feet).
struct PosturePriorOptions {
  int modes = 40;  // in [1, 57]; 25 lose wrists and ankles, 0.9 cm where most is given
  double lag_s =
      1.0 / 3.0;  // over which the modes' correlation is measured; 0.13 to 0.7 do as well
  // Factor of correlation times over what the lag tells: limbs move smoothly, and from one frame to
  // the next they change less than anything does that forgets as fast over the lag. 1 costs 2 %.
  double slowness = 2.0;

  /// Throws std::invalid_argument with name, value and range.
  void Check() const;
};

/// Ours, used by `best`: a prior of postures and of their change over time, as one Gaussian
/// process. A posture's bones are the mean plus independent modes, each an Ornstein-Uhlenbeck
/// process of variance 1 with its own correlation time: principal components, rotated so that they
/// are uncorrelated after a lag, too (slow feature analysis, Wiskott & Sejnowski 2002, of the
/// symmetric part). It holds only a mean, a covariance and a lagged covariance of the training
/// postures, not the postures themselves. It is symmetric: every motion is also learned mirrored.
struct PosturePrior {
  BoneVector mean_m = BoneVector::Zero();
  Eigen::MatrixXd modes_m;                      // kBoneDims x modes: bones = mean + modes * u
  BoneVector residual_m2 = BoneVector::Zero();  // variance of each number that no mode explains
  Eigen::VectorXd correlation_time_s;           // correlation time of each mode, slowest first
  uint64_t frames = 0;                          // number of training frames
  PriorNetwork network;                         // non-Gaussian correction; may be empty

  /// Throws InputError when the clips hold no moving, finite postures.
  static PosturePrior Learn(const std::vector<PriorClip>& clips,
                            const PosturePriorOptions& options = {});

  /// .ossaprior: reads refuse damaged, truncated and hostile files by name and byte.
  static PosturePrior Load(const std::filesystem::path& path);
  /// From a payload; older versions are still read, without what they lack.
  static PosturePrior FromBytes(std::span<const std::byte> bytes, const std::string& name,
                                uint32_t version = kVersion);
  /// Version 2 added the network. Without one, files are of version 1.
  static constexpr uint32_t kVersion = 2;
  void Save(const std::filesystem::path& path) const;
  /// Whether the file has the format's magic number; it may still be damaged.
  static bool IsFile(const std::filesystem::path& path);
};

/// The clip normalised to the standard size, split into runs at frames that are not finite.
std::vector<std::vector<BoneVector>> NormalisedRuns(const PriorClip& clip);

/// The bone vectors of a posture, metres, not normalised.
BoneVector ToBoneVector(const Posture& posture);
/// Inverse of ToBoneVector, with the root at the origin.
Posture PostureFromBones(const BoneVector& bones_m);

}  // namespace ossa::recon
