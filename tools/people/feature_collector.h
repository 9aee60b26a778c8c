#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "depth/image/depth_frame.h"

namespace ossa::recon {
class PoseNetwork;  // recon/refine/pose_network.h
}

namespace ossa::people {

/// The features by which a candidate is classified as a person or another object.
struct CandidateFeatures {
  std::vector<int32_t> pixels;   // v * width + u, ascending
  std::vector<double> features;  // one for each of PersonFeatureNames()
  double score = 0.0;            // by the shipped weights, [0, 1]
};

/// The scores of a candidate by the forest and by a pose network.
struct CandidatePose {
  std::vector<int32_t> pixels;  // v * width + u, ascending
  double forest_score = 0.0;    // [0, 1]
  double certainty = 0.0;       // MeasureCertainty
};

std::span<const std::string_view> PersonFeatureNames();
/// The number of leading features that need no joint proposals.
size_t CountSurfaceFeatures();

/// Features of all candidates of single frames, as the tracker computes them: for fitting and
/// evaluating the weights. `from_above`: for a camera under the ceiling.
class FeatureCollector {
 public:
  /// Throws InputError naming the model where it cannot be read.
  explicit FeatureCollector(const std::filesystem::path& model, bool from_above = false);
  ~FeatureCollector();
  std::vector<CandidateFeatures> Collect(const depth::DepthFrame& frame) const;
  /// Of the candidates to which the tracker would apply `network`, parts of one person merged.
  std::vector<CandidatePose> CollectPoses(const depth::DepthFrame& frame,
                                          const recon::PoseNetwork& network) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace ossa::people
