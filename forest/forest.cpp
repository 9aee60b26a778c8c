#include "forest/forest.h"

#include <algorithm>
#include <cmath>

#include "depth/base/error.h"
#include "depth/base/perceptron/rounded_perceptron.h"
#include "forest/each_tree_internal.h"
#include "forest/joint_features_internal.h"
#include "forest/runtime_tables_internal.h"

namespace ossa::forest {
namespace {

// Constants: bounds of the format, against damaged files.

constexpr size_t kMaxCells = 512;
constexpr size_t kMaxFactors = 64;
constexpr size_t kMaxLayers = 4;
constexpr Eigen::Index kMaxLayerWidth = 4096;

[[noreturn]] void Refuse(const std::string& name, const std::string& reason) {
  throw InputError(name + ": forest model: " + reason);
}

void CheckNames(const ForestData& data, const std::string& name) {
  const size_t classes = data.class_names.size();
  const size_t contexts = data.context_names.size();
  if (classes < 2 || contexts < 1 || classes > 255 || classes * contexts > kMaxCells) {
    Refuse(name, "classes: expected 2 or more, and at most 512 pairs with contexts, found " +
                     std::to_string(classes) + " classes and " + std::to_string(contexts) +
                     " contexts");
  }
  if (data.context_prior.size() != contexts) Refuse(name, "context prior: wrong length");
  for (const float p : data.context_prior) {
    if (!(p >= 0.0F && p <= 1.0F)) Refuse(name, "context prior: expected values in [0, 1]");
  }
  if (!(data.evidence_scale >= 0.0F && data.evidence_scale < 1e4F)) {
    Refuse(name, "evidence scale: expected a value in [0, 10000)");
  }
  if (data.background_mm > 32767) Refuse(name, "background depth: expected at most 32767 mm");
}

// Checks that children are in pairs after their parent, each node has one parent, and leaves are
// numbered in order: then every walk from the root terminates.
void CheckTopology(const Tree& tree, const std::string& where) {
  if (tree.nodes.empty()) Refuse(where, "no nodes");
  size_t next_leaf = 0;
  size_t next_child = 1;
  for (size_t i = 0; i < tree.nodes.size(); ++i) {
    const Node& node = tree.nodes[i];
    if (node.is_leaf()) {
      if (static_cast<size_t>(node.leaf()) != next_leaf || next_leaf >= tree.leaf_count()) {
        Refuse(where, "node " + std::to_string(i) + ": leaf " + std::to_string(node.leaf()) +
                          " is not in breadth-first order (expected " + std::to_string(next_leaf) +
                          " of " + std::to_string(tree.leaf_count()) + ")");
      }
      ++next_leaf;
    } else if (static_cast<size_t>(node.left) != next_child || next_child + 2 > tree.nodes.size()) {
      Refuse(where, "node " + std::to_string(i) + ": child " + std::to_string(node.left) +
                        " is not in breadth-first order (expected " + std::to_string(next_child) +
                        " of " + std::to_string(tree.nodes.size()) + ")");
    } else {
      next_child += 2;
    }
  }
  if (next_child != tree.nodes.size()) Refuse(where, "nodes without a parent");
}

void CheckLeaves(const Tree& tree, const ForestData& data, const std::string& where) {
  const size_t cells = data.class_names.size() * data.context_names.size();
  if (tree.entry_begin.front() != 0 || tree.entry_begin.back() != tree.entries.size()) {
    Refuse(where, "leaf entries: bounds do not match their number");
  }
  for (size_t i = 0; i < tree.leaf_count(); ++i) {
    if (tree.entry_begin[i] > tree.entry_begin[i + 1]) {
      Refuse(where, "leaf " + std::to_string(i) + ": entries run backwards");
    }
  }
  for (const uint16_t entry : tree.entries) {
    const size_t code = entry & 511U;
    if (code >= cells || entry >> 9U == 0) Refuse(where, "leaf entry: class or weight unknown");
    if (code % data.class_names.size() == 0) Refuse(where, "leaf entry: background in a leaf");
  }
}

void CheckTree(const ForestData& data, size_t t, const std::string& name) {
  const Tree& tree = data.trees[t];
  const std::string where = name + ": tree " + std::to_string(t);
  if (tree.entry_begin.empty()) Refuse(where, "no leaves");
  if (tree.leaf_count() > LinedTree::kMostLeaves) {
    Refuse(where, "leaves: expected at most " + std::to_string(LinedTree::kMostLeaves) +
                      ", found " + std::to_string(tree.leaf_count()));
  }
  CheckTopology(tree, where);
  CheckLeaves(tree, data, where);
  size_t rows = 0;
  VoteRows(tree, &rows);
  const size_t wanted = rows * data.context_names.size() * data.targets.size();
  if (!tree.votes.empty() && tree.votes.size() != wanted) {
    Refuse(where, "votes: expected " + std::to_string(wanted) + ", found " +
                      std::to_string(tree.votes.size()));
  }
}

template <size_t N>
void CheckLogistic(const Logistic<N>& logistic, const std::string& where) {
  bool finite = std::isfinite(logistic.bias);
  for (const float weight : logistic.weight) finite = finite && std::isfinite(weight);
  if (!finite) Refuse(where, "a confidence weight is not a number");
}

void CheckTarget(const ForestData& data, const ProposalTarget& target, const std::string& name) {
  const std::string where = name + ": target '" + target.name + "'";
  for (const uint8_t c : target.classes) {
    if (c == 0 || c >= data.class_names.size()) Refuse(where, "class " + std::to_string(c));
  }
  for (const float value : {target.bandwidth_m, target.vote_sharpness_m}) {
    if (!(value > 0.0F && value < 10.0F)) Refuse(where, "expected lengths in (0, 10) m");
  }
  for (const float value :
       {target.probability_threshold, target.push_back_m, target.class_weight, target.vote_radius_m,
        target.tracked_confidence, target.inferred_confidence}) {
    if (!std::isfinite(value)) Refuse(where, "a parameter is not a number");
  }
  if (!(target.mode_noise_m > 0.0F && target.mode_noise_m < 10.0F)) {
    Refuse(where, "noise of modes: expected a length in (0, 10) m");
  }
  CheckLogistic(target.correct, where);
  CheckLogistic(target.visible, where);
  CheckLogistic(target.fused, where);
  CheckLogistic(target.apart, where);
}

// For vectors and matrices.
template <typename Numbers>
bool AllWithin(const Numbers& values, float low, float high) {
  return std::all_of(values.data(), values.data() + values.size(),
                     [&](float value) { return value >= low && value <= high; });
}

void CheckPosePriors(const ForestData& data, const std::string& name) {
  if (data.pose_priors.empty()) return;
  if (data.pose_priors.size() != data.context_names.size()) {
    Refuse(name, "pose priors: expected " + std::to_string(data.context_names.size()) +
                     ", one a context, found " + std::to_string(data.pose_priors.size()));
  }
  constexpr float kFar_m = 100.0F;
  const size_t rows = 3 * data.targets.size();
  const size_t size = data.pose_priors.front().loading_m.size();
  for (const PosePrior& a : data.pose_priors) {
    if (a.mean_m.size() != rows || a.noise_m.size() != data.targets.size() ||
        a.loading_m.size() != size || size % std::max<size_t>(rows, 1) != 0 ||
        size > kMaxFactors * rows) {
      Refuse(name, "pose priors: sizes do not match the number of targets");
    }
    if (!AllWithin(a.mean_m, -kFar_m, kFar_m) || !AllWithin(a.loading_m, -kFar_m, kFar_m) ||
        !AllWithin(a.noise_m, 1e-3F, kFar_m)) {
      Refuse(name, "pose priors: expected lengths within 100 m, noise of at least 1 mm");
    }
  }
}

void CheckRefinement(const ForestData& data, const std::string& name) {
  const Perceptron& refinement = data.refinement;
  if (refinement.empty()) return;
  if (data.pose_priors.empty()) Refuse(name, "refinement: expected pose priors beside it");
  if (refinement.layers.size() > kMaxLayers) Refuse(name, "refinement: more than 4 layers");
  auto inputs = static_cast<Eigen::Index>(
      JointFeatureCount(data.targets.size(), data.class_names.size(), data.context_names.size()));
  if (refinement.input_mean.size() != inputs || refinement.input_scale.size() != inputs) {
    Refuse(name, "refinement: expected " + std::to_string(inputs) + " inputs, found " +
                     std::to_string(refinement.input_mean.size()) + " and " +
                     std::to_string(refinement.input_scale.size()));
  }
  constexpr float kMost = 1e6F;  // no unit
  bool sane = AllWithin(refinement.input_mean, -kMost, kMost) &&
              AllWithin(refinement.input_scale, 0.0F, kMost);
  for (const PerceptronLayer& layer : refinement.layers) {
    const Eigen::Index outputs = layer.bias.size();
    if (outputs > kMaxLayerWidth || layer.weight.rows() != inputs ||
        layer.weight.cols() != outputs) {
      Refuse(name, "refinement: a layer's weights do not match its inputs and outputs");
    }
    sane = sane && AllWithin(layer.weight, -kMost, kMost) && AllWithin(layer.bias, -kMost, kMost);
    inputs = outputs;
  }
  if (inputs != 4 * static_cast<Eigen::Index>(data.targets.size()))
    Refuse(name, "refinement: expected 4 outputs a target");
  if (!sane) Refuse(name, "refinement: expected numbers of at most a million");
}

void CheckRelabelling(const ForestData& data, const std::string& name) {
  const Relabelling& prior = data.relabelling;
  if (prior.bias.empty() && prior.weight.empty()) return;
  const size_t classes = data.class_names.size() - 1;
  const size_t weights = 2 * kRadialBasisScales * data.targets.size() * classes;
  if (prior.bias.size() != classes || prior.weight.size() != weights) {
    Refuse(name, "relabelling: expected " + std::to_string(weights) + " weights and " +
                     std::to_string(classes) + " biases, found " +
                     std::to_string(prior.weight.size()) + " and " +
                     std::to_string(prior.bias.size()));
  }
  constexpr float kMost = 1e4F;  // no unit
  if (!AllWithin(prior.weight, -kMost, kMost) || !AllWithin(prior.bias, -kMost, kMost)) {
    Refuse(name, "relabelling: expected numbers of at most ten thousand");
  }
}

}  // namespace

ForestModel::ForestModel(std::shared_ptr<const ForestData> data,
                         std::shared_ptr<const RuntimeTables> tables)
    : data_(std::move(data)),
      tables_(std::move(tables)),
      refinement_(std::make_shared<const RoundedPerceptron>(data_->refinement)) {}

ForestModel::ForestModel(ForestData data, const std::string& name, ModelUse use) {
  CheckNames(data, name);
  if (data.trees.empty() || data.trees.size() > 64) Refuse(name, "expected 1 to 64 trees");
  ForEachTree(data.trees.size(), [&](size_t t) { CheckTree(data, t, name); });
  for (const ProposalTarget& target : data.targets) CheckTarget(data, target, name);
  CheckPosePriors(data, name);
  CheckRefinement(data, name);
  CheckRelabelling(data, name);
  auto tables = std::make_shared<const RuntimeTables>(MakeRuntimeTables(&data, use));
  *this = ForestModel(std::make_shared<const ForestData>(std::move(data)), std::move(tables));
}

}  // namespace ossa::forest
