#include "forest/dense_internal.h"

#include <algorithm>
#include <cstring>

#include "depth/clones.h"
#include "forest/lanes_internal.h"

namespace ossa::forest {
namespace {

constexpr Eigen::Index kTileColumns = 2 * kLanes;

struct Factors {
  const float* a = nullptr;   // rows × inner
  Eigen::Index a_stride = 0;  // from row to row
  const float* b = nullptr;   // inner × columns
  Eigen::Index b_stride = 0;
  float* out = nullptr;  // rows × columns
  Eigen::Index inner = 0;
  Eigen::Index columns = 0;
};

// kRows rows of the product by kTileColumns columns, held in registers while the inner index runs.
template <int kRows>
[[gnu::always_inline]] inline void Tile(const Factors& f, Eigen::Index row, Eigen::Index column) {
  Lanes sum[kRows][2] = {};
  for (Eigen::Index k = 0; k < f.inner; ++k) {
    Lanes left, right;  // loaded one by one: copied together they would go through memory
    Load(f.b + k * f.b_stride + column, &left);
    Load(f.b + k * f.b_stride + column + kLanes, &right);
    for (int r = 0; r < kRows; ++r) {
      const float a = f.a[(row + r) * f.a_stride + k];
      sum[r][0] += a * left;
      sum[r][1] += a * right;
    }
  }
  for (int r = 0; r < kRows; ++r) {
    std::memcpy(f.out + (row + r) * f.columns + column, sum[r], sizeof(sum[r]));
  }
}

constexpr int kTileRows = 4;

OSSA_CLONES void MultiplyTiles(const Factors& f, Eigen::Index rows) {
  for (Eigen::Index column = 0; column + kTileColumns <= f.columns; column += kTileColumns) {
    Eigen::Index row = 0;
    for (; row + kTileRows <= rows; row += kTileRows) Tile<kTileRows>(f, row, column);
    for (; row < rows; ++row) Tile<1>(f, row, column);
  }
}

// A row's sums over kInner inner indices from `k` on, added to what is there already.
template <int kInner>
[[gnu::always_inline]] inline void AddToRow(const Factors& f, Eigen::Index row, Eigen::Index k) {
  const float* a = f.a + row * f.a_stride + k;
  const float* b = f.b + k * f.b_stride;
  float* out = f.out + row * f.columns;
  const Eigen::Index columns = f.columns - f.columns % kTileColumns;
  for (Eigen::Index column = 0; column < columns; column += kLanes) {
    Lanes sum;
    Load(out + column, &sum);
    for (int i = 0; i < kInner; ++i) {
      Lanes line;
      Load(b + i * f.b_stride + column, &line);
      sum += a[i] * line;
    }
    std::memcpy(out + column, &sum, sizeof(sum));
  }
}

// A few rows by a matrix that the caches nearest to the processor cannot hold: it is read once, in
// the order in which it lies, instead of tile by tile.
OSSA_CLONES void MultiplyFewRows(const Factors& f, Eigen::Index rows) {
  constexpr int kAtOnce = 4;
  std::fill(f.out, f.out + rows * f.columns, 0.0F);
  for (Eigen::Index row = 0; row < rows; ++row) {
    Eigen::Index k = 0;
    for (; k + kAtOnce <= f.inner; k += kAtOnce) AddToRow<kAtOnce>(f, row, k);
    for (; k < f.inner; ++k) AddToRow<1>(f, row, k);
  }
}

// The columns that fill no tile.
void MultiplyRest(const Factors& f, Eigen::Index rows) {
  for (Eigen::Index row = 0; row < rows; ++row) {
    for (Eigen::Index c = f.columns - f.columns % kTileColumns; c < f.columns; ++c) {
      float sum = 0.0F;
      for (Eigen::Index k = 0; k < f.inner; ++k) {
        sum += f.a[row * f.a_stride + k] * f.b[k * f.b_stride + c];
      }
      f.out[row * f.columns + c] = sum;
    }
  }
}

}  // namespace

RowMatrix Product(const Eigen::Ref<const RowMatrix>& a, const Eigen::Ref<const RowMatrix>& b) {
  RowMatrix out(a.rows(), b.cols());
  const Factors factors{a.data(),   a.outerStride(), b.data(), b.outerStride(),
                        out.data(), a.cols(),        b.cols()};
  a.rows() < kTileRows ? MultiplyFewRows(factors, a.rows()) : MultiplyTiles(factors, a.rows());
  MultiplyRest(factors, a.rows());
  return out;
}

}  // namespace ossa::forest
