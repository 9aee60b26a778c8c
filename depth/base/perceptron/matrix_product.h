#pragma once
#include <Eigen/Core>

namespace ossa {

/// One row per example, one column per feature.
using RowMatrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// a · b. Every sum runs over the inner index from its start to its end, one product after another:
/// the same bits on every machine, which Eigen's own products do not promise.
RowMatrix Multiply(const Eigen::Ref<const RowMatrix>& a, const Eigen::Ref<const RowMatrix>& b);

}  // namespace ossa
