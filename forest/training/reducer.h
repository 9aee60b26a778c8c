#pragma once
#include <cstdint>
#include <span>

namespace ossa::forest {

/// Adds integers over the ranks of a shared training run. This one is alone: rank 0 of 1.
class Reducer {
 public:
  virtual ~Reducer() = default;
  virtual int rank() const { return 0; }
  virtual int size() const { return 1; }
  virtual void Sum(std::span<uint32_t>) const {}
  virtual void Sum(std::span<int64_t>) const {}
};

}  // namespace ossa::forest
