#pragma once
#include <Eigen/Core>

#include "depth/base/perceptron/matrix_product.h"

namespace ossa {

/// A square feature map: one row per cell, in row-major order from the top; one column per channel.
struct FeatureMap {
  int side = 0;  // cells
  RowMatrix cells;
};

/// A convolutional layer (LeCun et al. 1989) with zero padding, so that with stride 1 the map keeps
/// its size. QuantisedConvolution runs it.
struct Convolution {
  int size = 3;      // side of the kernel in cells, odd
  int stride = 1;    // cells from output to output
  RowMatrix weight;  // size * size * inputs × outputs; rows of the window, its columns, inputs
  Eigen::RowVectorXf bias;  // one per output

  Eigen::Index inputs() const { return weight.rows() / (size * size); }
};

/// Rectified linear units (Nair and Hinton 2010).
FeatureMap Rectified(FeatureMap map);

/// Nearest-neighbour upsampling by two.
FeatureMap Doubled(const FeatureMap& map);

}  // namespace ossa
