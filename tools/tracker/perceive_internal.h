#pragma once
#include <vector>

#include "depth/scene/scene.h"
#include "forest/classification/classify.h"
#include "forest/forest.h"
#include "forest/proposals/propose.h"
#include "tools/tracker/signs_internal.h"

namespace ossa::tracker {

/// What the forest sees in one candidate.
struct Perception {
  forest::Classification classification;
  int scale = 1;  // classified on every scale-th pixel of the frame both ways
  std::vector<std::vector<forest::Proposal>> proposals;
  std::vector<Eigen::Vector3d> heads_m;  // clusters of head pixels, largest first
  double leg_area_m2 = 0.0;              // of samples that look like legs
  Signs sign{};
  double person_score = 0.0;  // [0, 1]
  double classify_ms = 0.0, propose_ms = 0.0;
};

struct PerceiveOptions {
  double sample_m = 0.012;   // pixels are thinned until one stands for so much of the surface
  size_t max_pixels = 6000;  // and further, to at most so many
  double least_score = 0.1;  // by the surface alone; below, no proposals are made
  std::vector<float> context_prior;
  int threads = 1;
};

Perception Perceive(const forest::ForestModel& model, const recon::JointArray<int>& targets,
                    const depth::DepthFrame& frame, const depth::Candidate& candidate,
                    const PerceiveOptions& options);

/// Labels of the candidate's pixels into an image of the frame's size: looked at once more at full
/// resolution, with what was perceived of the facing and the joints in mind (forest::Relabel).
void PaintParts(const forest::ForestModel& model, const depth::DepthFrame& frame,
                const depth::Candidate& candidate, const Perception& perception,
                depth::Image<uint8_t>& parts);

}  // namespace ossa::tracker
