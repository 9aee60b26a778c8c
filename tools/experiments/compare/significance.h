#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace ossa::tools {

struct Interval {
  double low = 0;
  double high = 0;
};

/// Percentile bootstrap of the mean (Efron 1979) with `resamples` resamples. `values` has one entry
/// per independent unit (a clip, a subject), never per frame: frames of a clip are correlated and
/// would make the interval far too small. Empty for fewer than two values.
std::optional<Interval> BootstrapMean(std::span<const double> values, uint64_t seed,
                                      int resamples = 2000, double level = 0.95);

struct TestResult {
  double statistic = 0;
  double p = 1;
};

/// Two-sided paired tests of a against b, one entry per unit, equal sizes. Empty if there are too
/// few units.

/// Wilcoxon's signed rank test; statistic = the smaller rank sum. Exact up to 50 pairs without ties
/// or zeros, else the normal approximation with the correction for ties (zeros left out).
std::optional<TestResult> Wilcoxon(std::span<const double> a, std::span<const double> b);
/// Student's t on the differences.
std::optional<TestResult> PairedT(std::span<const double> a, std::span<const double> b);

/// Friedman's test of k >= 3 methods on n units, values[method][unit]; chi-square approximation
/// with the correction for ties.
std::optional<TestResult> Friedman(const std::vector<std::vector<double>>& values);
/// One-way repeated-measures analysis of variance; statistic = F(k - 1, (k - 1)(n - 1)).
std::optional<TestResult> RepeatedAnova(const std::vector<std::vector<double>>& values);
/// Lilliefors' test of normality: Kolmogorov-Smirnov distance from the normal distribution with the
/// values' own mean and standard deviation; because these are fitted, p is not Kolmogorov's. Empty
/// for fewer than five values. Plantard 2016 tests normality to choose between the tests above.
std::optional<TestResult> Lilliefors(std::span<const double> values);

/// Upper tail probabilities.
double ChiSquareTail(double x, double degrees);
double FTail(double f, double degrees_1, double degrees_2);
double StudentTail(double t, double degrees);  // two-sided
double NormalTail(double z);                   // two-sided

}  // namespace ossa::tools
