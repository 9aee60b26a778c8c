#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

#include "depth/scene/scene.h"
#include "forest/classify.h"
#include "forest/forest.h"
#include "forest/propose.h"
#include "recon/skeleton.h"

namespace ossa::tracker {

/// What the forest sees in one candidate.
struct Perception {
  forest::Classification classification;
  int scale = 1;  // classified on every scale-th pixel of the frame both ways
  std::vector<std::vector<forest::Proposal>> proposals;
  std::vector<Eigen::Vector3d> heads_m;  // clusters of head pixels, strongest first
  double person_score = 0.0;             // [0, 1]
  double classify_ms = 0.0, propose_ms = 0.0;
};

struct PerceiveOptions {
  size_t max_pixels = 16000;  // more are thinned: a near person is as well seen at half resolution
  std::vector<float> context_prior;
  int threads = 1;
};

Perception Perceive(const forest::ForestModel& model,
                    const std::array<int, recon::kJointCount>& targets,
                    const depth::DepthFrame& frame, const depth::Candidate& candidate,
                    const PerceiveOptions& options);

}  // namespace ossa::tracker
