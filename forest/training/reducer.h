#pragma once
#include <cstdint>
#include <span>

namespace ossa::forest {

/// Sums integers over the ranks of a distributed training run. This base class is for a single
/// rank.
class Reducer {
 public:
  virtual ~Reducer() = default;
  virtual int rank() const { return 0; }
  virtual int size() const { return 1; }
  virtual void Sum(std::span<uint32_t>) const {}
  virtual void Sum(std::span<int64_t>) const {}
};

}  // namespace ossa::forest
