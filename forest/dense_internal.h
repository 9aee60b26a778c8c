#pragma once
#include <Eigen/Core>

namespace ossa::forest {

using RowMatrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// a · b. Every sum runs over the inner index from its start to its end, one product after another:
/// the same bits on every machine, which Eigen's own products do not promise.
RowMatrix Product(const Eigen::Ref<const RowMatrix>& a, const Eigen::Ref<const RowMatrix>& b);

}  // namespace ossa::forest
