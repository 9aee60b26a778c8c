#pragma once
#include <Eigen/Core>

#include "depth/base/perceptron/matrix_product.h"

namespace ossa {

/// A square map of features: a row a cell, from above row by row; a column a channel.
struct FeatureMap {
  int side = 0;  // cells
  RowMatrix cells;
};

/// A layer of a convolutional network (LeCun et al. 1989): what is outside the map counts as
/// nought, so that of a stride of 1 the map keeps its size. QuantisedConvolution runs it.
struct Convolution {
  int size = 3;      // cells a side of what an output reads, odd
  int stride = 1;    // cells from output to output
  RowMatrix weight;  // size * size * inputs × outputs; rows of the window, its columns, inputs
  Eigen::RowVectorXf bias;  // one an output

  Eigen::Index inputs() const { return weight.rows() / (size * size); }
};

/// Outputs below nought become nought (Nair and Hinton 2010).
FeatureMap Rectified(FeatureMap map);

/// Nearest-neighbour upsampling: each cell as four.
FeatureMap Doubled(const FeatureMap& map);

}  // namespace ossa
