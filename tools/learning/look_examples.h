#pragma once
#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <vector>

#include "forest/forest.h"
#include "forest/network.h"
#include "recon/refine/close_look.h"
#include "tools/learning/learn_close_look.h"

namespace ossa::tools {

/// A person where the forest and the glances known already put the joints; how far from there the
/// joints are, in the description's axes; the person's true bones, and what the glances known
/// already would be told of them.
struct LookExample {
  recon::LookDescription description;
  recon::JointArray<Eigen::Vector3f> offset_m{};
  recon::BoneLengths bones_m{};
  recon::BoneLengths told_m{};  // the true ones where nothing judges them yet
};

struct LookExamples {
  std::vector<LookExample> all;  // of each person as it is, then from shifted places
  size_t people = 0;
};

/// One person of each frame of the data sets of whom enough is seen, in order. Throws InputError
/// where there are too few to learn from.
LookExamples GatherLookExamples(const forest::ForestModel& model,
                                const std::vector<std::filesystem::path>& datasets,
                                const CloseLookOptions& options);

/// How a network is learned from them: two layers, large batches, no dropout.
forest::NetworkOptions LookLearning(const CloseLookOptions& options, Eigen::Index outputs);

}  // namespace ossa::tools
