#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "depth/image/depth_frame.h"

namespace ossa::forest {

class ForestModel;  // forest/forest.h

/// Class probabilities of one object's (person's) pixels.
struct Classification {
  std::vector<int32_t> pixel;      // v * width + u, ascending
  int class_count = 0;             // classes of the model; class 0 is background and never given
  std::vector<float> probability;  // pixel.size() × class_count, row-major, rows sum to 1
  std::vector<uint8_t> label;      // argmax of each row
  std::vector<float> context;      // posterior over the model's contexts (e.g. facing sectors)
  std::vector<int32_t> leaf;       // pixel.size() × trees: where each pixel ended
};

enum class InstructionSet { kBest, kScalar };

struct ClassifyOptions {
  int threads = 1;
  /// What is known of the contexts beforehand (e.g. from the last frame), one value each, sum 1;
  /// empty: the model's prior.
  std::span<const float> context_prior;
  /// Half the patch over which neighbouring pixels' probabilities are averaged; 0: none. On
  /// validation subjects 2.5 cm raised the mean class accuracy by 10 points and more.
  double smoothing_m = 0.025;
  /// Pixels of a surface that lie closer together than this need not each walk the trees: of every
  /// step × step of them one does, and the others take its leaves: two by two at 640 × 480 pixels
  /// nearer than 2.9 m. Two fifths of the patch above; it costs 0.2 points of mean class accuracy
  /// (of 72). 0: every pixel walks.
  double fine_m = 0.010;
  InstructionSet instructions = InstructionSet::kBest;  // kScalar serves tests
};

/// Classifies the given pixels (v * width + u, ascending) of one object. Depth outside of these
/// pixels reads as background, so that a neighbour or a wall does not disturb the features.
/// The same labels on every instruction set.
Classification Classify(const ForestModel& model, const depth::DepthView& depth,
                        const depth::Camera& camera, std::span<const int32_t> pixels,
                        const ClassifyOptions& options = {});

}  // namespace ossa::forest
