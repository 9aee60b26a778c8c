#pragma once
#include <Eigen/Core>

#include "forest/network.h"

namespace ossa::forest {

/// a · b. Every sum runs over the inner index from its start to its end, one product after another:
/// the same bits on every machine, which Eigen's own products do not promise.
RowMatrix Product(const Eigen::Ref<const RowMatrix>& a, const Eigen::Ref<const RowMatrix>& b);

}  // namespace ossa::forest
