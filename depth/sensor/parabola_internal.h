#pragma once
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace ossa::depth {

/// Least-squares fit of a parabola a + b t + c t^2 to values at equal steps of t from -1 to 1.
class Parabola {
 public:
  struct Fit {
    double middle = 0.0, slope = 0.0, bend = 0.0;  // a, b, c
    double rest = 0.0;                             // root mean square residual
    double bend_error = 0.0;                       // standard deviation of c
  };

  /// For `size` values, at least 4.
  explicit Parabola(int size) : t_(static_cast<size_t>(size)) {
    for (int i = 0; i < size; ++i) t_[static_cast<size_t>(i)] = 2.0 * i / (size - 1) - 1.0;
    for (const double t : t_) squares_ += t * t;
    mean_square_ = squares_ / size;
    for (const double t : t_) fourths_ += Even(t) * Even(t);
  }

  Fit Through(std::span<const double> z) const {
    double sum = 0.0, odd = 0.0, even = 0.0, all = 0.0;
    for (size_t i = 0; i < t_.size(); ++i) {
      sum += z[i];
      odd += z[i] * t_[i];
      even += z[i] * Even(t_[i]);
      all += z[i] * z[i];
    }
    const auto size = static_cast<double>(t_.size());
    Fit fit;
    fit.slope = odd / squares_;
    fit.bend = even / fourths_;
    fit.middle = sum / size - fit.bend * mean_square_;
    const double left = all - sum * sum / size - odd * fit.slope - even * fit.bend;
    fit.rest = std::sqrt(std::max(left, 0.0) / (size - 3.0));
    fit.bend_error = fit.rest / std::sqrt(fourths_);
    return fit;
  }

 private:
  double Even(double t) const { return t * t - mean_square_; }

  std::vector<double> t_;
  double squares_ = 0.0, mean_square_ = 0.0, fourths_ = 0.0;
};

}  // namespace ossa::depth
