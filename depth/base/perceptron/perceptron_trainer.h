#pragma once
#include <cstdint>
#include <vector>

#include "depth/base/perceptron/perceptron.h"
#include "depth/base/random.h"

namespace ossa {

/// Layers of a perceptron while they are learned: stochastic gradient descent with momentum and a
/// step of its own for every weight (Kingma and Ba 2015, "Adam"; decay apart from the gradient as
/// Loshchilov and Hutter 2019), with dropout (Srivastava et al. 2014). The same bytes on every
/// machine and for any number of threads: it runs in one, by products in a fixed order.
class PerceptronTrainer {
 public:
  /// What keeps a perceptron from overfitting.
  struct Regularisation {
    float decay = 0.0F;    // of weights, a unit of the rate
    float dropped = 0.0F;  // share of hidden units at each step, [0, 1)
  };

  /// `widths`: inputs, hidden layers, outputs.
  PerceptronTrainer(const std::vector<Eigen::Index>& widths, Regularisation regularisation,
                    uint64_t seed);

  /// Outputs of a batch of inputs, hidden units dropped at random. Kept for Step.
  const RowMatrix& Forward(RowMatrix batch);
  /// One step down the gradient (of the loss by the outputs of the last Forward).
  void Step(RowMatrix gradient, float rate);

  std::vector<PerceptronLayer> Layers() const;

 private:
  /// Numbers that are learned, with Adam's running means of their gradient and of its square.
  struct Learned {
    RowMatrix value, mean, square;

    explicit Learned(RowMatrix start);
    void Descend(const RowMatrix& gradient, float rate, int step);
  };
  void DropUnits(RowMatrix* activation);

  std::vector<Learned> weight_, bias_;
  Regularisation regularisation_;
  std::vector<RowMatrix> activation_;  // the batch, then each layer's outputs
  Random random_;
  int step_ = 0;
};

}  // namespace ossa
