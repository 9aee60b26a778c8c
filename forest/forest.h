#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "depth/base/perceptron/perceptron.h"
#include "forest/trees/tree.h"

namespace ossa {
class RoundedPerceptron;
}

namespace ossa::forest {

/// A probability as a logistic function of features, fitted on held-out frames:
/// 1 / (1 + exp(-(bias + Σ weight_i · feature_i))).
template <size_t N>
struct Logistic {
  static constexpr size_t kFeatures = N;
  std::array<float, N> weight{};
  float bias = 0.0F;
};
using ModeConfidence = Logistic<5>;   // of a mode, from what mean shift saw there
using PlaceConfidence = Logistic<8>;  // of a place, from how it fits those of the other targets

/// How one 3D target (a joint) is found in classified pixels. Learned on held-out frames.
struct ProposalTarget {
  std::string name;                     // e.g. an SDK joint
  std::vector<uint8_t> classes;         // classes of the surface around it; may be empty
  float bandwidth_m = 0.06F;            // of the density estimate, > 0 (Shotton 2011, sec. 3.3)
  float probability_threshold = 0.15F;  // pixels below do not vote by class
  float push_back_m = 0.04F;            // from the surface into the body, along the ray
  float class_weight = 1.0F;            // share of class votes against position votes, >= 0
  float vote_radius_m = 1.3F;           // longest position vote that counts
  float vote_sharpness_m = 0.06F;       // votes with a larger spread count less
  float tracked_confidence = 0.5F;      // tracked from this confidence on
  float inferred_confidence = 0.15F;    // inferred from this one on; below: not tracked
  ModeConfidence correct;               // P(within 10 cm of the truth)
  ModeConfidence visible;               // P(its surface is seen)
  float mode_noise_m = 0.03F;           // of modes against what the other targets predict
  PlaceConfidence fused;                // P(within 10 cm), where modes and other targets meet
  PlaceConfidence apart;                // the same, of a mode that does not fit the others
};

/// The pose prior of objects in one context: factor analysis of the targets' relative positions,
/// x = origin + mean + loading · z + noise, z ~ N(0, I), with a free common origin.
struct PosePrior {
  std::vector<float> mean_m;     // target × 3, camera axes
  std::vector<float> loading_m;  // target × 3 × factor, row-major
  std::vector<float> noise_m;    // one a target: residual standard deviation, each axis
};

/// Joint-conditioned relabelling (forest/proposals/relabel.cpp): multinomial logistic regression of
/// a pixel's class on radial basis functions of its distances from the proposed targets.
struct Relabelling {
  std::vector<float> weight;  // 2 × scale × target × class from 1 on; the second half is
                              // multiplied by the targets' confidences
  std::vector<float> bias;    // of each class from 1 on; empty: labels stay as the trees give them
};
inline constexpr size_t kRadialBasisScales = 3;  // of the format

/// Everything a model file holds.
struct ForestData {
  std::vector<std::string> class_names;    // class 0 is background and never given
  std::vector<std::string> context_names;  // e.g. facing sectors; at least one
  std::vector<float> context_prior;        // sums to 1
  float evidence_scale = 20.0F;  // effective number of independent pixels of an object, for context
  uint16_t background_mm = 10000;
  std::vector<Tree> trees;
  std::vector<ProposalTarget> targets;
  std::vector<PosePrior> pose_priors;  // one a context; or empty: targets are found singly
  /// The second stage of joints, cascaded pose regression
  /// (depth/base/perceptron/pose_regression.h): moves the positions of all targets at once. Inputs
  /// are defined in forest/joint_features_internal.h, outputs in forest/proposals/refinement.cpp;
  /// empty: no refinement. Learned on images that the trees have not seen.
  Perceptron refinement;
  Relabelling relabelling;  // of the labels; or without biases
  std::string manifest;     // JSON text: the model's card
};

struct RuntimeTables;  // forest/runtime_tables_internal.h

/// The use of a model. With kRunOnly the trees' nodes and the entries of their leaves
/// (Tree::entries) are released as soon as the run-time tables are made from them; those of the
/// leaves are made while it runs (forest/deferred_leaves_internal.h). It cannot be written.
enum class ModelUse { kAny, kRunOnly };

/// A checked forest, ready to run. Immutable; copies share.
class ForestModel {
 public:
  /// Throws InputError (naming `name`) when the data are inconsistent.
  explicit ForestModel(ForestData data, const std::string& name = "model",
                       ModelUse use = ModelUse::kAny);

  /// From parts of a model that was checked before (forest/kept_tables.h).
  ForestModel(std::shared_ptr<const ForestData> data, std::shared_ptr<const RuntimeTables> tables);

  const ForestData& data() const { return *data_; }
  int class_count() const { return static_cast<int>(data_->class_names.size()); }
  int context_count() const { return static_cast<int>(data_->context_names.size()); }
  std::span<const ProposalTarget> targets() const { return data_->targets; }
  const std::string& manifest() const { return data_->manifest; }
  const RuntimeTables& tables() const { return *tables_; }
  /// ForestData::refinement, ready to run.
  const RoundedPerceptron& refinement() const { return *refinement_; }

 private:
  friend void KeepTables(const std::filesystem::path& model_file, const ForestModel& model);

  std::shared_ptr<const ForestData> data_;
  std::shared_ptr<const RuntimeTables> tables_;
  std::shared_ptr<const RoundedPerceptron> refinement_;
};

/// Throws InputError that names the file, the byte and the field.
ForestModel ReadForestModel(const std::filesystem::path& path, ModelUse use = ModelUse::kAny);
ForestModel ReadForestModel(std::span<const std::byte> bytes, const std::string& name);
/// True when the file starts as a forest model does.
bool IsForestModel(const std::filesystem::path& path);
/// Precondition: the model is not for running only.
void WriteForestModel(const std::filesystem::path& path, const ForestModel& model);

}  // namespace ossa::forest
