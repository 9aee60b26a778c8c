#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "depth/base/perceptron/perceptron.h"

namespace ossa {

/// The weights of a pair of inputs for as many units as fill a line of the cache: of each unit that
/// of the first input and that of the second.
struct alignas(64) WeightLine {
  static constexpr size_t kUnits = 32;  // of 2 bytes: derived, a cache line
  std::array<std::array<int8_t, 2>, kUnits> weights{};
};

/// A perceptron made ready to run often. Its weights are bytes: memory is what takes time, and
/// bytes are a quarter of it. Activations are rounded to some 15 bits, and sums are of whole
/// numbers: the same bits on any processor. Two examples run side by side: a weight is fetched once
/// for both.
class QuantisedPerceptron {
 public:
  QuantisedPerceptron() = default;
  /// Precondition: the perceptron has layers, and these have inputs.
  explicit QuantisedPerceptron(const Perceptron& perceptron);
  /// As Perceptron::Run of one whose weights are bytes (RoundToBytes), but for rounding.
  RowMatrix Run(const Eigen::Ref<const RowMatrix>& inputs) const;

 private:
  friend class PerceptronPacker;
  struct Layer {
    size_t first_line = 0;    // those of all pairs for the first units, then for the next ones
    size_t blocks = 0;        // of units, a line each
    Eigen::RowVectorXf step;  // of each input: what a byte's 1 is worth
    Eigen::RowVectorXf bias;
  };
  template <size_t kExamples>
  void RunSideBySide(const RowMatrix& normalised, Eigen::Index first, RowMatrix* outputs) const;
  void Add(const Perceptron& perceptron, std::vector<WeightLine>* lines);

  std::shared_ptr<const std::vector<WeightLine>> lines_;  // of all that were packed together
  Perceptron normaliser_;                                 // has no layers
  std::vector<Layer> layers_;
};

/// Packs perceptrons that run one after the other, as they come: their weights lie together, in
/// large pages.
class PerceptronPacker {
 public:
  /// About so many weights in all.
  explicit PerceptronPacker(size_t weights);
  /// Precondition: as QuantisedPerceptron's.
  void Add(const Perceptron& perceptron);
  /// All that were added, in order. Nothing is added afterwards.
  std::vector<QuantisedPerceptron> Take();

 private:
  std::shared_ptr<std::vector<WeightLine>> lines_;
  std::vector<QuantisedPerceptron> packed_;
};

}  // namespace ossa
