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

/// What a candidate looks like to the forest: what people are told from furniture by.
struct CandidateFeatures {
  std::vector<int32_t> pixels;   // v * width + u, ascending
  std::vector<double> features;  // one for each of PersonFeatureNames()
  double score = 0.0;            // what the shipped weights make of them
};

/// What a candidate looks like to the forest and to a pose network.
struct CandidatePose {
  std::vector<int32_t> pixels;  // v * width + u, ascending
  double forest_score = 0.0;    // [0, 1]
  double certainty = 0.0;       // MeasureCertainty
};

std::span<const std::string_view> PersonFeatureNames();
/// So many of the first features are known before joints are proposed.
size_t CountSurfaceFeatures();

/// Features of every candidate of single frames, as the tracker sees them: for fitting and judging
/// the weights. `from_above`: by a tracker under the ceiling.
class FeatureCollector {
 public:
  /// Throws InputError naming the model where it cannot be read.
  explicit FeatureCollector(const std::filesystem::path& model, bool from_above = false);
  ~FeatureCollector();
  std::vector<CandidateFeatures> Collect(const depth::DepthFrame& frame) const;
  /// Of the candidates that `network` would be asked about, pieces of a person merged.
  std::vector<CandidatePose> CollectPoses(const depth::DepthFrame& frame,
                                          const recon::PoseNetwork& network) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace ossa::people
