// Linear algebra of a factor model x_t = mean_t + L_t · z + noise, z ~ N(0, I), with measurements
// y_t of variance v_t: the posterior precision of z is P = I + Σ L_tᵀ L_t / v_t = Uᵀ U. Solving Uᵀ
// [X, q] = [Lᵀ, Σ L_tᵀ (y_t - mean_t) / v_t] once gives every target's posterior: covariance X_tᵀ
// X_t and offset X_tᵀ q. With a few dozen factors a library's matrix products are not faster, and
// these sums have the same order on every machine.
#include "forest/factor_model_internal.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstring>

#include "depth/base/cpu_dispatch.h"

namespace ossa::forest {
namespace {

// Constants: sizes of vector registers; the spread by hand.

constexpr size_t kWide = 4;  // values per vector; never summed across lanes
using Wide = double __attribute__((vector_size(kWide * sizeof(double))));
constexpr double kPlaceSpread_m = 2;  // standard deviation of the common position: nearly free

size_t FilledUp(size_t count) { return (count + kWide - 1) / kWide * kWide; }

[[gnu::always_inline]] inline void Load(const double* from, Wide* to) {
  std::memcpy(to, from, sizeof(Wide));
}
[[gnu::always_inline]] inline void Store(const Wide& from, double* to) {
  std::memcpy(to, &from, sizeof(Wide));
}

// precision += weight · LᵀL for the three rows of L, from the diagonal on.
OSSA_CPU_DISPATCH void AddTarget(const double* rows, double weight, size_t factors, size_t stride,
                                 double* precision) {
  for (size_t i = 0; i < factors; ++i) {
    const double a = weight * rows[i];
    const double b = weight * rows[stride + i];
    const double c = weight * rows[2 * stride + i];
    for (size_t j = i / kWide * kWide; j < stride; j += kWide) {
      Wide x, y, z, sum;
      Load(rows + j, &x);
      Load(rows + stride + j, &y);
      Load(rows + 2 * stride + j, &z);
      Load(precision + i * stride + j, &sum);
      sum += a * x + b * y + c * z;
      Store(sum, precision + i * stride + j);
    }
  }
}

// Cholesky factorisation: the upper half of P becomes U, with 1 / u on the diagonal.
OSSA_CPU_DISPATCH void Factorise(size_t factors, size_t stride, double* p) {
  for (size_t k = 0; k < factors; ++k) {
    double* row = p + k * stride;
    const double inverse = 1.0 / std::sqrt(row[k]);
    for (size_t j = k + 1; j < factors; ++j) row[j] *= inverse;
    row[k] = inverse;
    for (size_t i = k + 1; i < factors; ++i) {
      const double factor = row[i];
      for (size_t j = i / kWide * kWide; j < stride; j += kWide) {
        Wide from, by;
        Load(p + i * stride + j, &from);
        Load(row + j, &by);
        from -= factor * by;
        Store(from, p + i * stride + j);
      }
    }
  }
}

// Replaces kColumns · kWide right-hand sides b by the solution of Uᵀ x = b.
template <size_t kColumns>
[[gnu::always_inline]] inline void SolveColumns(const double* u, size_t factors, size_t stride,
                                                double* b, size_t b_stride) {
  for (size_t i = 0; i < factors; ++i) {
    Wide sum[kColumns];
    for (size_t c = 0; c < kColumns; ++c) Load(b + i * b_stride + c * kWide, &sum[c]);
    for (size_t k = 0; k < i; ++k) {
      for (size_t c = 0; c < kColumns; ++c) {
        Wide x;
        Load(b + k * b_stride + c * kWide, &x);
        sum[c] -= u[k * stride + i] * x;
      }
    }
    for (size_t c = 0; c < kColumns; ++c) {
      sum[c] *= u[i * stride + i];
      Store(sum[c], b + i * b_stride + c * kWide);
    }
  }
}

OSSA_CPU_DISPATCH void Solve(const double* u, size_t factors, size_t stride, double* b,
                             size_t b_stride) {
  constexpr size_t kAtOnce = 4;
  size_t column = 0;
  for (; column + kAtOnce * kWide <= b_stride; column += kAtOnce * kWide) {
    SolveColumns<kAtOnce>(u, factors, stride, b + column, b_stride);
  }
  for (; column < b_stride; column += kWide) {
    SolveColumns<1>(u, factors, stride, b + column, b_stride);
  }
}

// For kWide targets: the six distinct elements of XᵀX, then the three of Xᵀq.
constexpr size_t kMoments = 9;
struct Moments {
  double value[kMoments][kWide];
};

OSSA_CPU_DISPATCH void SumMoments(const double* x, const double* q, size_t factors,
                                  size_t axis_stride, size_t stride, Moments* out) {
  Wide sum[kMoments] = {};
  for (size_t i = 0; i < factors; ++i) {
    Wide axis[3];
    for (size_t a = 0; a < 3; ++a) Load(x + i * stride + a * axis_stride, &axis[a]);
    sum[0] += axis[0] * axis[0];
    sum[1] += axis[0] * axis[1];
    sum[2] += axis[0] * axis[2];
    sum[3] += axis[1] * axis[1];
    sum[4] += axis[1] * axis[2];
    sum[5] += axis[2] * axis[2];
    for (size_t a = 0; a < 3; ++a) sum[6 + a] += axis[a] * q[i * stride];
  }
  std::memcpy(out->value, sum, sizeof(sum));
}

// Removes a target's own measurement from its posterior.
void RemoveOwnSite(const Site& site, const Eigen::Vector3d& mean_m, Eigen::Matrix3d* covariance,
                   Eigen::Vector3d* offset_m) {
  const double weight = 1.0 / site.variance_m2;
  const Eigen::Matrix3d inverse = covariance->inverse();
  *covariance = (inverse - weight * Eigen::Matrix3d::Identity()).inverse();
  *offset_m = *covariance * (inverse * *offset_m - weight * (site.mean_m - mean_m));
}

}  // namespace

FactorModel::FactorModel(const PosePrior& prior)
    : targets_(prior.noise_m.size()),
      factors_(prior.loading_m.size() / std::max<size_t>(1, 3 * targets_) + 3),
      row_stride_(FilledUp(factors_)),
      axis_stride_(FilledUp(targets_)),
      rows_(3 * targets_ * row_stride_),
      columns_(factors_ * 3 * axis_stride_) {
  for (size_t t = 0; t < targets_; ++t) {
    for (size_t axis = 0; axis < 3; ++axis) {
      const float* loading_m = prior.loading_m.data() + (3 * t + axis) * (factors_ - 3);
      for (size_t f = 0; f < factors_; ++f) {
        const bool is_place = f >= factors_ - 3;
        const double place_m = f - (factors_ - 3) == axis ? kPlaceSpread_m : 0.0;
        const double value = is_place ? place_m : static_cast<double>(loading_m[f]);
        rows_[(3 * t + axis) * row_stride_ + f] = value;
        columns_[(3 * f + axis) * axis_stride_ + t] = value;
      }
    }
    const float* mean_m = prior.mean_m.data() + 3 * t;
    mean_m_.emplace_back(mean_m[0], mean_m[1], mean_m[2]);
    const double noise_m = prior.noise_m[t];
    variance_m2_.push_back(noise_m * noise_m);
  }
}

std::vector<double> FactorModel::Precision(const std::vector<Site>& sites) const {
  std::vector<double> precision(factors_ * row_stride_, 0.0);
  for (size_t i = 0; i < factors_; ++i) precision[i * row_stride_ + i] = 1.0;
  for (size_t t = 0; t < targets_; ++t) {
    if (sites[t].variance_m2 <= 0) continue;
    AddTarget(rows_.data() + 3 * t * row_stride_, 1.0 / sites[t].variance_m2, factors_, row_stride_,
              precision.data());
  }
  return precision;
}

std::vector<double> FactorModel::RightSides(const std::vector<Site>& sites) const {
  const size_t own = 3 * axis_stride_;
  const size_t stride = own + kWide;
  std::vector<double> sides(factors_ * stride, 0.0);
  for (size_t f = 0; f < factors_; ++f) {
    std::memcpy(sides.data() + f * stride, columns_.data() + f * own, own * sizeof(double));
  }
  for (size_t t = 0; t < targets_; ++t) {
    if (sites[t].variance_m2 <= 0) continue;
    const Eigen::Vector3d pull = (sites[t].mean_m - mean_m_[t]) / sites[t].variance_m2;
    for (size_t axis = 0; axis < 3; ++axis) {
      const double* row = rows_.data() + (3 * t + axis) * row_stride_;
      for (size_t f = 0; f < factors_; ++f) {
        sides[f * stride + own] += row[f] * pull[static_cast<Eigen::Index>(axis)];
      }
    }
  }
  return sides;
}

std::vector<Prediction> FactorModel::Predict(const std::vector<Site>& sites) const {
  std::vector<double> root = Precision(sites);
  Factorise(factors_, row_stride_, root.data());
  std::vector<double> solved = RightSides(sites);
  const size_t stride = 3 * axis_stride_ + kWide;
  Solve(root.data(), factors_, row_stride_, solved.data(), stride);
  std::vector<Prediction> predictions(targets_);
  Moments moments;
  for (size_t t = 0; t < targets_; ++t) {
    if (t % kWide == 0) {
      SumMoments(solved.data() + t, solved.data() + 3 * axis_stride_, factors_, axis_stride_,
                 stride, &moments);
    }
    const auto of = [&](size_t m) { return moments.value[m][t % kWide]; };
    Eigen::Matrix3d covariance;
    covariance << of(0), of(1), of(2), of(1), of(3), of(4), of(2), of(4), of(5);
    Eigen::Vector3d offset_m(of(6), of(7), of(8));
    if (sites[t].variance_m2 > 0) RemoveOwnSite(sites[t], mean_m_[t], &covariance, &offset_m);
    predictions[t].predicted_m = mean_m_[t] + offset_m;
    predictions[t].covariance_m2 =
        0.5 * (covariance + covariance.transpose()) + variance_m2_[t] * Eigen::Matrix3d::Identity();
  }
  return predictions;
}

}  // namespace ossa::forest
