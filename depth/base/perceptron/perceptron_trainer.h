#pragma once
#include <cstdint>
#include <vector>

#include "depth/base/perceptron/perceptron.h"
#include "depth/base/random.h"

namespace ossa {

/// Trains the layers of a perceptron by Adam (Kingma and Ba 2015), with decoupled weight decay
/// (Loshchilov and Hutter 2019) and dropout (Srivastava et al. 2014). Single-threaded with a fixed
/// order of products, so the bytes are the same on every machine.
class PerceptronTrainer {
 public:
  /// Regularisation parameters.
  struct Regularisation {
    float decay = 0.0F;    // weight decay per unit of the learning rate
    float dropped = 0.0F;  // dropout, share of hidden units, [0, 1)
  };

  /// `widths`: inputs, hidden layers, outputs.
  PerceptronTrainer(const std::vector<Eigen::Index>& widths, Regularisation regularisation,
                    uint64_t seed);

  /// Forward pass of a batch with dropout; activations are kept for Step.
  const RowMatrix& Forward(RowMatrix batch);
  /// Backward pass and update, given the gradient of the loss with respect to the outputs of the
  /// last Forward.
  void Step(RowMatrix gradient, float rate);

  std::vector<PerceptronLayer> Layers() const;

 private:
  /// Parameters, with Adam's running means of their gradient and squared gradient.
  struct Learned {
    RowMatrix value, mean, square;

    explicit Learned(RowMatrix start);
    void Descend(const RowMatrix& gradient, float rate, int step);
  };
  void DropUnits(RowMatrix* activation);

  std::vector<Learned> weight_, bias_;
  Regularisation regularisation_;
  std::vector<RowMatrix> activation_;  // the batch, then the outputs of each layer
  Random random_;
  int step_ = 0;
};

}  // namespace ossa
