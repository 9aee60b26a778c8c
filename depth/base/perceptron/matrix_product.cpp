#include "depth/base/perceptron/matrix_product.h"

#include <algorithm>
#include <cstring>
#include <vector>

#include "depth/base/cpu_dispatch.h"
#include "depth/base/lanes.h"

namespace ossa {
namespace {

constexpr Eigen::Index kTileColumns = 2 * kLanes;

struct Factors {
  const float* a = nullptr;   // rows × inner
  Eigen::Index a_stride = 0;  // stride between rows
  const float* b = nullptr;   // inner × columns
  Eigen::Index b_stride = 0;
  float* out = nullptr;  // rows × columns
  Eigen::Index inner = 0;
  Eigen::Index columns = 0;
};

// Inner indices per block: the part of b that a tile reads stays in the L1 cache. Partial sums are
// stored in `out` in between, without loss of precision.
constexpr Eigen::Index kInnerBlock = 256;
constexpr int kTileRows = 6;  // with two columns of lanes: uses all AVX2 registers for sums

// A block of inner indices, with the packed columns of b for a tile.
struct Block {
  Eigen::Index begin = 0, end = 0;
  alignas(64) float b[kInnerBlock * kTileColumns];
};

// Missing columns of b are padded with zeros.
[[gnu::always_inline]] inline void Pack(const Factors& f, Eigen::Index column, Eigen::Index columns,
                                        Block* block) {
  for (Eigen::Index k = block->begin; k < block->end; ++k) {
    float* line = block->b + (k - block->begin) * kTileColumns;
    std::copy_n(f.b + k * f.b_stride + column, columns, line);
    std::fill(line + columns, line + kTileColumns, 0.0F);
  }
}

// kRows x kTileColumns elements of the product, held in registers over the inner index.
template <int kRows>
[[gnu::always_inline]] inline void Tile(const Factors& f, const Block& block, Eigen::Index row,
                                        Eigen::Index column) {
  Lanes sum[kRows][2] = {};
  for (int r = 0; r < kRows && block.begin > 0; ++r) {
    std::memcpy(sum[r], f.out + (row + r) * f.columns + column, sizeof(sum[r]));
  }
  const float* a = f.a + row * f.a_stride + block.begin;
  const float* b = block.b;
  for (Eigen::Index k = block.begin; k < block.end; ++k, ++a, b += kTileColumns) {
    Lanes left, right;  // loaded separately: copying both would go through memory
    LoadLanes(b, &left);
    LoadLanes(b + kLanes, &right);
    for (int r = 0; r < kRows; ++r) {
      const float factor = a[r * f.a_stride];
      sum[r][0] += factor * left;
      sum[r][1] += factor * right;
    }
  }
  for (int r = 0; r < kRows; ++r) {
    std::memcpy(f.out + (row + r) * f.columns + column, sum[r], sizeof(sum[r]));
  }
}

[[gnu::always_inline]] inline void MultiplyBlock(const Factors& f, const Block& block,
                                                 Eigen::Index rows, Eigen::Index column) {
  Eigen::Index row = 0;
  for (; row + kTileRows <= rows; row += kTileRows) Tile<kTileRows>(f, block, row, column);
  for (; row < rows; ++row) Tile<1>(f, block, row, column);
}

OSSA_CPU_DISPATCH void MultiplyTiles(const Factors& f, Eigen::Index rows) {
  Block block;
  for (Eigen::Index begin = 0; begin < f.inner; begin += kInnerBlock) {
    block.begin = begin;
    block.end = std::min(f.inner, begin + kInnerBlock);
    for (Eigen::Index column = 0; column + kTileColumns <= f.columns; column += kTileColumns) {
      Pack(f, column, kTileColumns, &block);
      MultiplyBlock(f, block, rows, column);
    }
  }
}

// Adds the products of kInner inner indices from `k` on to a row's sums.
template <int kInner>
[[gnu::always_inline]] inline void AddToRow(const Factors& f, Eigen::Index row, Eigen::Index k) {
  const float* a = f.a + row * f.a_stride + k;
  const float* b = f.b + k * f.b_stride;
  float* out = f.out + row * f.columns;
  const Eigen::Index columns = f.columns - f.columns % kTileColumns;
  for (Eigen::Index column = 0; column < columns; column += kLanes) {
    Lanes sum;
    LoadLanes(out + column, &sum);
    for (int i = 0; i < kInner; ++i) {
      Lanes line;
      LoadLanes(b + i * f.b_stride + column, &line);
      sum += a[i] * line;
    }
    std::memcpy(out + column, &sum, sizeof(sum));
  }
}

// A few rows times a matrix larger than the L1 and L2 caches: it is read once, in memory order,
// instead of tile by tile.
OSSA_CPU_DISPATCH void MultiplyFewRows(const Factors& f, Eigen::Index rows) {
  constexpr int kAtOnce = 4;  // rows of b; measured: more are no faster
  std::fill(f.out, f.out + rows * f.columns, 0.0F);
  for (Eigen::Index row = 0; row < rows; ++row) {
    Eigen::Index k = 0;
    for (; k + kAtOnce <= f.inner; k += kAtOnce) AddToRow<kAtOnce>(f, row, k);
    for (; k < f.inner; ++k) AddToRow<1>(f, row, k);
  }
}

// The remaining columns, as one zero-padded tile.
OSSA_CPU_DISPATCH void MultiplyRest(const Factors& f, Eigen::Index rows) {
  const Eigen::Index rest = f.columns % kTileColumns;
  if (rest == 0) return;
  std::vector<float> sums(static_cast<size_t>(rows * kTileColumns));
  Factors padded = f;
  padded.out = sums.data();
  padded.columns = kTileColumns;
  Block block;
  for (Eigen::Index begin = 0; begin < f.inner; begin += kInnerBlock) {
    block.begin = begin;
    block.end = std::min(f.inner, begin + kInnerBlock);
    Pack(f, f.columns - rest, rest, &block);
    MultiplyBlock(padded, block, rows, 0);
  }
  for (Eigen::Index row = 0; row < rows; ++row) {
    std::copy_n(sums.data() + row * kTileColumns, rest, f.out + (row + 1) * f.columns - rest);
  }
}

}  // namespace

RowMatrix Multiply(const Eigen::Ref<const RowMatrix>& a, const Eigen::Ref<const RowMatrix>& b) {
  RowMatrix out(a.rows(), b.cols());
  const Factors factors{a.data(),   a.outerStride(), b.data(), b.outerStride(),
                        out.data(), a.cols(),        b.cols()};
  if (factors.inner == 0) return RowMatrix::Zero(a.rows(), b.cols());
  a.rows() < kTileRows ? MultiplyFewRows(factors, a.rows()) : MultiplyTiles(factors, a.rows());
  MultiplyRest(factors, a.rows());
  return out;
}

}  // namespace ossa
