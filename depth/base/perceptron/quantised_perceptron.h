#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "depth/base/perceptron/perceptron.h"

namespace ossa {

/// The weights of a pair of inputs for the units of a cache line: for each unit that of the first
/// input and that of the second.
struct alignas(64) WeightLine {
  static constexpr size_t kUnits = 32;  // of 2 bytes: derived, a cache line
  std::array<std::array<int8_t, 2>, kUnits> weights{};
};

/// A perceptron prepared for repeated use. Its weights are bytes, a quarter of the memory, because
/// memory bandwidth is the bottleneck. Activations are quantised to about 15 bits; sums are
/// integers: the same bits on any processor. Two examples are evaluated together, so that each
/// weight is loaded once for both.
class QuantisedPerceptron {
 public:
  QuantisedPerceptron() = default;
  /// Precondition: the perceptron has layers, and these have inputs.
  explicit QuantisedPerceptron(const Perceptron& perceptron);
  /// As Perceptron::Run for byte weights (RoundToBytes), except for rounding.
  RowMatrix Run(const Eigen::Ref<const RowMatrix>& inputs) const;

 private:
  friend class PerceptronPacker;
  struct Layer {
    size_t first_line = 0;    // lines of all pairs for the first units, then for the next ones
    size_t blocks = 0;        // blocks of units, one line each
    Eigen::RowVectorXf step;  // weight scale of each input
    Eigen::RowVectorXf bias;
  };
  template <size_t kExamples>
  void RunSideBySide(const RowMatrix& normalised, Eigen::Index first, RowMatrix* outputs) const;
  void Add(const Perceptron& perceptron, std::vector<WeightLine>* lines);

  std::shared_ptr<const std::vector<WeightLine>> lines_;  // shared by all that were packed together
  Perceptron normaliser_;                                 // normalisation only, without layers
  std::vector<Layer> layers_;
};

/// Packs perceptrons that run one after another into contiguous memory, in large pages.
class PerceptronPacker {
 public:
  /// `weights`: approximate total number of weights.
  explicit PerceptronPacker(size_t weights);
  /// Precondition: as QuantisedPerceptron's.
  void Add(const Perceptron& perceptron);
  /// The added perceptrons, in order. Add must not be called afterwards.
  std::vector<QuantisedPerceptron> Take();

 private:
  std::shared_ptr<std::vector<WeightLine>> lines_;
  std::vector<QuantisedPerceptron> packed_;
};

}  // namespace ossa
