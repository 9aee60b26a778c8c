#pragma once
#include <array>
#include <filesystem>
#include <functional>
#include <span>

#include "recon/models/linear_filter.h"
#include "recon/models/local_mixture.h"
#include "recon/models/pose_correction.h"
#include "recon/models/window_correction.h"

namespace ossa::recon {

// Constants: bounds of the format, and sizes chosen for speed.

struct LearnOptions {
  // Limits of the file format for mixture.regions and mixture.samples.
  static constexpr int kMostRegions = 1000, kMostSamples = 5000;
  static constexpr int kFewestPairs = 10;  // minimum number of pairs per joint

  bool processes = true;  // false: the correction alone, for `best`
  LocalMixtureOptions mixture;
  PoseCorrectionOptions correction;
  WindowCorrectionOptions window;
  LinearFilterOptions filter;
  size_t most_pairs = 2500;  // used for the mixtures, full processes and exemplars
  int full_samples = 350;    // samples of each joint's full Gaussian process: the variance costs
                             // their square a frame, 0.8 ms for 20 joints
};

/// The result of `ossa learn`, stored in an .ossagp file: for each joint with known truth the local
/// mixture (liu-2016) and the full process (full-gp), the pairs themselves (exemplar), and the
/// whole-posture corrections and the filter (best).
struct LearnedModels {
  JointArray<LocalMixture> mixtures;
  JointArray<GaussianProcess> full;
  std::vector<PosturePair> exemplars;
  PoseCorrection correction;
  WindowCorrection window;
  LinearFilter filter;
  uint64_t pair_count = 0;  // number of training pairs

  /// `progress` (may be empty) gets the number of joints done; returns false to stop.
  static LearnedModels Learn(const std::vector<PosturePair>& pairs, const LearnOptions& options,
                             const std::function<bool(int)>& progress = {});
  void Save(const std::filesystem::path& path) const;
  /// Whether the file has the format's magic number; it may still be damaged.
  static bool IsFile(const std::filesystem::path& path);
  static LearnedModels Load(const std::filesystem::path& path);
  /// Parses a payload. Older versions are still read, without the parts that they lack.
  static LearnedModels FromBytes(std::span<const std::byte> bytes, const std::string& name,
                                 uint32_t version = kVersion);
  /// Version 3 added the filter, 4 its influence weights, 5 the window correction.
  static constexpr uint32_t kVersion = 5;
};

}  // namespace ossa::recon
