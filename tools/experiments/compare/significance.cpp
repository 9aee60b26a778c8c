#include "tools/experiments/compare/significance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

namespace ossa::tools {
namespace {

// Constants: bounds of series, against endless loops; double precision ends them before.

constexpr double kTiny = 1e-300;  // without it a ratio of a continued fraction would divide by 0
constexpr double kPrecision = 1e-15;  // share of the sum
constexpr int kMostTerms = 1000;

// Upper incomplete gamma, regularised: series below a + 1, Lentz's continued fraction above
// (Abramowitz & Stegun 6.5.29, 6.5.31).
double GammaQ(double a, double x) {
  if (x <= 0) return 1.0;
  const double front = std::exp(-x + a * std::log(x) - std::lgamma(a));
  if (x < a + 1) {
    double term = 1 / a;
    double sum = term;
    for (int n = 1; n < kMostTerms && term > sum * kPrecision; ++n) {
      term *= x / (a + n);
      sum += term;
    }
    return 1 - front * sum;
  }
  double b = x + 1 - a;
  double c = 1 / kTiny;
  double d = 1 / b;
  double h = d;
  for (int n = 1; n < kMostTerms; ++n) {
    const double an = -n * (n - a);
    b += 2;
    d = 1 / (an * d + b);
    c = b + an / c;
    h *= d * c;
    if (std::abs(d * c - 1) < kPrecision) break;
  }
  return front * h;
}

double BetaFraction(double a, double b, double x) {
  double c = 1;
  double d = 1 - (a + b) * x / (a + 1);
  d = 1 / (std::abs(d) < kTiny ? kTiny : d);
  double h = d;
  for (int m = 1; m < kMostTerms; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    for (const double term : {even, odd}) {
      d = 1 + term * d;
      d = 1 / (std::abs(d) < kTiny ? kTiny : d);
      c = 1 + term / c;
      if (std::abs(c) < kTiny) c = kTiny;
      h *= d * c;
    }
    if (std::abs(d * c - 1) < kPrecision) break;
  }
  return h;
}

// Incomplete beta, regularised (Abramowitz & Stegun 26.5.8).
double BetaI(double a, double b, double x) {
  if (x <= 0) return 0;
  if (x >= 1) return 1;
  const double front = std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) +
                                a * std::log(x) + b * std::log1p(-x));
  if (x < (a + 1) / (a + b + 2)) return front * BetaFraction(a, b, x) / a;
  return 1 - front * BetaFraction(b, a, 1 - x) / b;
}

double ComputeMean(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

struct Ranks {
  std::vector<double> rank;  // from 1; ties share their mean rank
  double tie_sum = 0;        // sum of t^3 - t over groups of t equal values
};

Ranks ComputeRanks(std::span<const double> values) {
  std::vector<size_t> order(values.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::sort(order.begin(), order.end(), [&](size_t i, size_t j) { return values[i] < values[j]; });
  Ranks ranks{std::vector<double>(values.size()), 0};
  for (size_t begin = 0; begin < order.size();) {
    size_t end = begin;
    while (end < order.size() && values[order[end]] == values[order[begin]]) ++end;
    const double mean = 0.5 * static_cast<double>(begin + 1 + end);
    for (size_t i = begin; i < end; ++i) ranks.rank[order[i]] = mean;
    const auto t = static_cast<double>(end - begin);
    ranks.tie_sum += t * t * t - t;
    begin = end;
  }
  return ranks;
}

// P(W <= w) by counting the sign patterns of each rank sum: ways(s) = coefficient of x^s in the
// product of (1 + x^i), i = 1..n.
double ExactWilcoxonTail(size_t n, double smaller_sum) {
  const size_t most = n * (n + 1) / 2;
  std::vector<double> ways(most + 1, 0.0);
  ways[0] = 1;
  for (size_t i = 1; i <= n; ++i) {
    for (size_t s = most; s >= i; --s) ways[s] += ways[s - i];
  }
  double below = 0;
  for (size_t s = 0; s <= most && static_cast<double>(s) <= smaller_sum; ++s) below += ways[s];
  return std::min(1.0, 2 * below / std::pow(2.0, static_cast<double>(n)));
}

// P(D >= d) for small probabilities: Dallal & Wilkinson 1986, "An analytic approximation to the
// distribution of Lilliefors's test statistic for normality", The American Statistician 40(4). Good
// up to 0.1 and 100 values; above those d is brought to 100.
double DallalWilkinsonTail(double d, double n) {
  constexpr double kMost = 100;  // no unit: values; Dallal & Wilkinson 1986
  if (n > kMost) {
    d *= std::pow(n / kMost, 0.49);
    n = kMost;
  }
  const double m = n + 2.78019;
  return std::exp(-7.01256 * d * d * m + 2.99587 * d * std::sqrt(m) - 0.122119 +
                  0.974598 / std::sqrt(n) + 1.67997 / n);
}

// For larger probabilities, quantiles of (sqrt(n) - 0.01 + 0.85 / sqrt(n)) D, the modification with
// which Stephens 1974 ("EDF statistics for goodness of fit and some comparisons", Journal of the
// American Statistical Association 69(347)) makes D nearly the same for every n. Simulated by
// tests/golden/statistics.py (lilliefors_quantiles), with n = 20; linear between.
double StephensTail(double d, double n) {
  struct Quantile {
    double statistic, p;
  };
  constexpr std::array<Quantile, 14> kLaw = {{{0.30, 1.0},
                                              {0.357, 0.99},
                                              {0.411, 0.95},
                                              {0.445, 0.9},
                                              {0.492, 0.8},
                                              {0.530, 0.7},
                                              {0.566, 0.6},
                                              {0.601, 0.5},
                                              {0.639, 0.4},
                                              {0.683, 0.3},
                                              {0.709, 0.25},
                                              {0.738, 0.2},
                                              {0.773, 0.15},
                                              {0.820, 0.1}}};
  const double statistic = (std::sqrt(n) - 0.01 + 0.85 / std::sqrt(n)) * d;
  if (statistic <= kLaw.front().statistic) return kLaw.front().p;
  for (size_t i = 1; i < kLaw.size(); ++i) {
    const Quantile& low = kLaw[i - 1];
    const Quantile& high = kLaw[i];
    if (statistic > high.statistic) continue;
    const double share = (statistic - low.statistic) / (high.statistic - low.statistic);
    return low.p + share * (high.p - low.p);
  }
  return kLaw.back().p;
}

double LillieforsTail(double d, double n) {
  const double p = DallalWilkinsonTail(d, n);
  return p <= 0.1 ? p : StephensTail(d, n);
}

}  // namespace

double ChiSquareTail(double x, double degrees) { return GammaQ(degrees / 2, x / 2); }

double FTail(double f, double degrees_1, double degrees_2) {
  if (f <= 0) return 1;
  return BetaI(degrees_2 / 2, degrees_1 / 2, degrees_2 / (degrees_2 + degrees_1 * f));
}

double StudentTail(double t, double degrees) {
  return BetaI(degrees / 2, 0.5, degrees / (degrees + t * t));
}

double NormalTail(double z) { return std::erfc(std::abs(z) / std::sqrt(2.0)); }

std::optional<Interval> BootstrapMean(std::span<const double> values, uint64_t seed, int resamples,
                                      double level) {
  if (values.size() < 2) return std::nullopt;
  std::mt19937_64 random(seed);
  std::vector<double> means;
  means.reserve(static_cast<size_t>(resamples));
  for (int r = 0; r < resamples; ++r) {
    double sum = 0;
    // The remainder is used instead of std::uniform_int_distribution, whose numbers differ between
    // standard libraries; its bias is under 2^-50 here.
    for (size_t i = 0; i < values.size(); ++i) sum += values[random() % values.size()];
    means.push_back(sum / static_cast<double>(values.size()));
  }
  std::sort(means.begin(), means.end());
  const auto at = [&](double share) {
    return means[static_cast<size_t>(std::lround(share * static_cast<double>(means.size() - 1)))];
  };
  return Interval{at((1 - level) / 2), at((1 + level) / 2)};
}

std::optional<TestResult> Wilcoxon(std::span<const double> a, std::span<const double> b) {
  std::vector<double> sizes;
  std::vector<bool> positive;
  for (size_t i = 0; i < a.size(); ++i) {
    if (a[i] == b[i]) continue;
    sizes.push_back(std::abs(a[i] - b[i]));
    positive.push_back(a[i] > b[i]);
  }
  const size_t n = sizes.size();
  if (n == 0) return std::nullopt;
  const Ranks ranks = ComputeRanks(sizes);
  double plus = 0;
  for (size_t i = 0; i < n; ++i) plus += positive[i] ? ranks.rank[i] : 0;
  const auto count = static_cast<double>(n);
  const double smaller = std::min(plus, count * (count + 1) / 2 - plus);
  constexpr size_t kExactPairs = 50;  // pairs, for speed
  if (n <= kExactPairs && n == a.size() && ranks.tie_sum == 0) {
    return TestResult{smaller, ExactWilcoxonTail(n, smaller)};
  }
  const double mean = count * (count + 1) / 4;
  const double variance = count * (count + 1) * (2 * count + 1) / 24 - ranks.tie_sum / 48;
  if (variance <= 0) return std::nullopt;
  return TestResult{smaller, NormalTail((smaller - mean) / std::sqrt(variance))};
}

std::optional<TestResult> PairedT(std::span<const double> a, std::span<const double> b) {
  if (a.size() < 2) return std::nullopt;
  std::vector<double> differences;
  for (size_t i = 0; i < a.size(); ++i) differences.push_back(a[i] - b[i]);
  const double mean = ComputeMean(differences);
  double squares = 0;
  for (const double d : differences) squares += (d - mean) * (d - mean);
  const auto n = static_cast<double>(a.size());
  const double error = std::sqrt(squares / (n - 1) / n);
  if (error == 0) return std::nullopt;
  return TestResult{mean / error, StudentTail(mean / error, n - 1)};
}

std::optional<TestResult> Friedman(const std::vector<std::vector<double>>& values) {
  const size_t k = values.size();
  if (k < 3 || values[0].size() < 2) return std::nullopt;
  const size_t n = values[0].size();
  std::vector<double> sums(k, 0.0);
  double ties = 0;
  for (size_t unit = 0; unit < n; ++unit) {
    std::vector<double> block;
    for (const auto& method : values) block.push_back(method[unit]);
    const Ranks ranks = ComputeRanks(block);
    for (size_t m = 0; m < k; ++m) sums[m] += ranks.rank[m];
    ties += ranks.tie_sum;
  }
  const auto kd = static_cast<double>(k);
  const auto nd = static_cast<double>(n);
  double squares = 0;
  for (const double sum : sums) squares += sum * sum;
  const double correction = 1 - ties / (nd * kd * (kd * kd - 1));
  if (correction <= 0) return std::nullopt;
  const double chi = (12 / (nd * kd * (kd + 1)) * squares - 3 * nd * (kd + 1)) / correction;
  return TestResult{chi, ChiSquareTail(chi, kd - 1)};
}

std::optional<TestResult> RepeatedAnova(const std::vector<std::vector<double>>& values) {
  const size_t k = values.size();
  if (k < 2 || values[0].size() < 2) return std::nullopt;
  const size_t n = values[0].size();
  double grand = 0;
  std::vector<double> unit_means(n, 0.0);
  for (const auto& method : values) {
    grand += ComputeMean(method) / static_cast<double>(k);
    for (size_t u = 0; u < n; ++u) unit_means[u] += method[u] / static_cast<double>(k);
  }
  double between = 0;
  double residual = 0;
  for (const auto& method : values) {
    const double mean = ComputeMean(method);
    between += static_cast<double>(n) * (mean - grand) * (mean - grand);
    for (size_t u = 0; u < n; ++u) {
      const double rest = method[u] - mean - unit_means[u] + grand;
      residual += rest * rest;
    }
  }
  if (residual <= 0) return std::nullopt;
  const auto d1 = static_cast<double>(k - 1);
  const double d2 = d1 * static_cast<double>(n - 1);
  const double f = (between / d1) / (residual / d2);
  return TestResult{f, FTail(f, d1, d2)};
}

std::optional<TestResult> Lilliefors(std::span<const double> values) {
  constexpr size_t kFewest = 5;  // the formulas of p hold from there; Lilliefors 1967
  if (values.size() < kFewest) return std::nullopt;
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  const double mean = ComputeMean(sorted);
  double squares = 0;
  for (const double v : sorted) squares += (v - mean) * (v - mean);
  const auto n = static_cast<double>(sorted.size());
  const double deviation = std::sqrt(squares / (n - 1));
  if (deviation == 0) return std::nullopt;
  double distance = 0;
  for (size_t i = 0; i < sorted.size(); ++i) {
    const double law = 0.5 * std::erfc(-(sorted[i] - mean) / deviation / std::sqrt(2.0));
    const auto below = static_cast<double>(i);
    distance = std::max({distance, (below + 1) / n - law, law - below / n});
  }
  return TestResult{distance, LillieforsTail(distance, n)};
}

}  // namespace ossa::tools
