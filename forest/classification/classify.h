#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "depth/image/depth_frame.h"

namespace ossa::forest {

// Constants: chosen on validation subjects (`ossa evaluate`) where a comparison is stated; seed and
// threads by convention.

class ForestModel;  // forest/forest.h

/// Classes of one object's (person's) pixels. Neighbouring pixels may share a sample: the trees
/// were evaluated at one of them.
struct Classification {
  std::vector<int32_t> pixel;     // v * width + u, ascending
  std::vector<uint8_t> label;     // of each pixel: its most likely class; 0 if unknown
  std::vector<int32_t> sample;    // of each pixel: its row in the following arrays
  std::vector<int32_t> leaf;      // sample × tree: the leaf reached
  std::vector<uint16_t> mass;     // sample × mass_stride; class c in column c - 1
  std::vector<float> mass_scale;  // of each sample: masses to probabilities, which sum to 1
  size_t mass_stride = 0;
  int class_count = 0;         // classes of the model; class 0 is background and never given
  std::vector<float> context;  // posterior over the model's contexts (e.g. facing sectors)

  /// P(class c | the sample of pixel number i).
  float Probability(size_t i, size_t c) const {
    if (c == 0) return 0.0F;
    const auto s = static_cast<size_t>(sample[i]);
    return mass_scale[s] * static_cast<float>(mass[s * mass_stride + c - 1]);
  }
};

enum class InstructionSet { kBest, kScalar };

/// How finely and with how many threads pixels are classified.
struct ClassifyOptions {
  int threads = 1;
  /// Prior of the contexts (e.g. from the last frame), one value each, sum 1; empty: the model's
  /// own.
  std::span<const float> context_prior;
  /// Half the patch over which neighbouring pixels' probabilities are averaged; 0: none. On
  /// validation subjects 2.5 cm raised the mean class accuracy by 10 points and more.
  double smoothing_m = 0.025;
  /// Distance on the surface between samples at which the trees are evaluated; a pixel between four
  /// samples takes the label with the largest sum of their masses. At the default it costs less
  /// than 0.1 points of 72 % accuracy on validation subjects. 0: the trees are evaluated at every
  /// pixel.
  double sample_spacing_m = 0.0125;
  InstructionSet instructions = InstructionSet::kBest;  // kScalar serves tests
};

/// Classifies the given pixels (v * width + u, ascending) of one object. Depth outside these pixels
/// reads as background, so that a neighbour or a wall does not influence the features.
/// The same labels on every instruction set.
Classification Classify(const ForestModel& model, const depth::DepthView& depth,
                        const depth::Camera& camera, std::span<const int32_t> pixels,
                        const ClassifyOptions& options = {});

}  // namespace ossa::forest
