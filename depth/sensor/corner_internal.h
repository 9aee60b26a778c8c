#pragma once
#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

namespace ossa::depth {

/// Least-squares fit of two joined line segments to values at equal steps of t from -1 to 1; the
/// joint is searched over a few positions.
class Corner {
 public:
  /// For `size` values, at least 5.
  explicit Corner(int size) : t_(static_cast<size_t>(size)) {
    constexpr int kPlaces = 7;           // for speed
    constexpr double kOutermost = 0.75;  // no unit, of t: few values are left beyond; by hand
    for (int i = 0; i < size; ++i) t_[static_cast<size_t>(i)] = 2.0 * i / (size - 1) - 1.0;
    for (const double t : t_) squares_ += t * t;
    for (int k = 0; k < kPlaces; ++k) {
      AddHinge(kOutermost * (2.0 * k / (kPlaces - 1) - 1.0));
    }
  }

  /// Root mean square residual of the best fit.
  double Rest(std::span<const double> z) const {
    double sum = 0.0, odd = 0.0, all = 0.0, most = 0.0;
    for (size_t i = 0; i < t_.size(); ++i) {
      sum += z[i];
      odd += z[i] * t_[i];
      all += z[i] * z[i];
    }
    for (const std::vector<double>& hinge : hinges_) {
      double along = 0.0;
      for (size_t i = 0; i < t_.size(); ++i) along += z[i] * hinge[i];
      most = std::max(most, along * along);
    }
    const auto size = static_cast<double>(t_.size());
    const double left = all - sum * sum / size - odd * odd / squares_ - most;
    return std::sqrt(std::max(left, 0.0) / (size - 4.0));
  }

 private:
  // The component of a hinge orthogonal to straight lines, normalised.
  void AddHinge(double at) {
    std::vector<double> hinge(t_.size());
    double sum = 0.0, odd = 0.0, all = 0.0;
    for (size_t i = 0; i < t_.size(); ++i) {
      hinge[i] = std::max(0.0, t_[i] - at);
      sum += hinge[i];
      odd += hinge[i] * t_[i];
    }
    for (size_t i = 0; i < t_.size(); ++i) {
      hinge[i] -= sum / static_cast<double>(t_.size()) + odd / squares_ * t_[i];
      all += hinge[i] * hinge[i];
    }
    for (double& value : hinge) value /= std::sqrt(all);
    hinges_.push_back(std::move(hinge));
  }

  std::vector<double> t_;
  double squares_ = 0.0;
  std::vector<std::vector<double>> hinges_;
};

}  // namespace ossa::depth
