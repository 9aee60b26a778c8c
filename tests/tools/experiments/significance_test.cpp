#include "tools/experiments/compare/significance.h"
#include "tests/support/places.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <random>
#include <sstream>

#include "tools/experiments/compare/rigid_transform.h"

namespace ossa::tools {
namespace {

using Numbers = std::vector<double>;

std::map<std::string, Numbers> ParseGolden(std::istream& stream) {
  std::map<std::string, Numbers> golden;
  for (std::string line; std::getline(stream, line);) {
    if (line.starts_with('#')) continue;
    std::istringstream words(line);
    std::string name;
    words >> name;
    for (double number = 0; words >> number;) golden[name].push_back(number);
  }
  return golden;
}

const std::map<std::string, Numbers>& Golden() {
  static const auto kGolden = [] {
    std::ifstream file(test::SourceFolder() / "tests/golden/statistics.txt");
    return ParseGolden(file);
  }();
  return kGolden;
}

const Numbers& G(const std::string& name) { return Golden().at(name); }

// Golden numbers carry twelve digits; both sides compute in double precision.
constexpr double kTolerance = 1e-9;

void ExpectResult(const std::optional<TestResult>& result, const std::string& name) {
  ASSERT_TRUE(result.has_value()) << name;
  EXPECT_NEAR(result->statistic, G(name)[0], kTolerance) << name;
  EXPECT_NEAR(result->p, G(name)[1], kTolerance) << name;
}

TEST(Statistics, AgreeWithScipy) {
  ExpectResult(Wilcoxon(G("a"), G("b")), "wilcoxon_exact");
  ExpectResult(Wilcoxon(G("big_a"), G("big_b")), "wilcoxon_ties");
  ExpectResult(PairedT(G("a"), G("b")), "paired_t");
  ExpectResult(Friedman({G("a"), G("b"), G("c")}), "friedman");
  ExpectResult(RepeatedAnova({G("a"), G("b"), G("c")}), "anova");
  auto rounded = std::vector<Numbers>{G("a"), G("b"), G("c")};
  // numpy rounds halves to even; none of the values is a half.
  for (Numbers& values : rounded) {
    for (double& value : values) value = std::nearbyint(value);
  }
  ExpectResult(Friedman(rounded), "friedman_ties");
}

TEST(Statistics, TailsAgreeWithScipy) {
  const Numbers& chi = G("chi_square_tail");
  EXPECT_NEAR(ChiSquareTail(3.7, 2), chi[0], kTolerance);
  EXPECT_NEAR(ChiSquareTail(60, 40), chi[1], kTolerance);
  EXPECT_NEAR(ChiSquareTail(0.05, 7), chi[2], kTolerance);
  const Numbers& f = G("f_tail");
  EXPECT_NEAR(FTail(2.5, 2, 22), f[0], kTolerance);
  EXPECT_NEAR(FTail(30, 3, 9), f[1], kTolerance);
  EXPECT_NEAR(FTail(0.3, 5, 100), f[2], kTolerance);
  const Numbers& t = G("student_tail");
  EXPECT_NEAR(StudentTail(2.2, 11), t[0], kTolerance);
  EXPECT_NEAR(StudentTail(-0.1, 3), t[1], kTolerance);
  EXPECT_NEAR(StudentTail(9, 30), t[2], kTolerance);
}

TEST(Lilliefors, AgreesWithSimulation) {
  // The simulated p has a deviation of 0.001; the table between p of 0.1 and 1 is linear between
  // quantiles that move by 0.003 with the number of values: about 0.01 in p.
  const std::map<std::string, double> tolerances = {
      {"a", 0.01}, {"skewed", 0.01}, {"many", 0.005}, {"far", 0.002}};
  for (const auto& [name, tolerance] : tolerances) {
    const auto result = Lilliefors(G(name));
    ASSERT_TRUE(result.has_value());
    EXPECT_NEAR(result->statistic, G("lilliefors_" + name)[0], kTolerance) << name;
    EXPECT_NEAR(result->p, G("lilliefors_" + name)[1], tolerance) << name;
  }
}

// By Kolmogorov's law, for a normal law given beforehand, one in 40 000 was at 0.05.
TEST(Lilliefors, RejectsNormalSamplesAtItsSignificanceLevel) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal(30.0, 7.0);
  constexpr int kSamples = 4000;
  std::map<double, int> rejected = {{0.01, 0}, {0.05, 0}, {0.5, 0}};
  for (int s = 0; s < kSamples; ++s) {
    Numbers sample(10);
    for (double& value : sample) value = normal(random);
    const double p = Lilliefors(sample)->p;
    for (auto& [level, count] : rejected) count += p <= level ? 1 : 0;
  }
  for (const auto& [level, count] : rejected) {
    // Three deviations of a binomial count, and 0.01 of p for the formulas.
    const double tolerance = 3 * std::sqrt(level * (1 - level) / kSamples) + 0.01 * level;
    EXPECT_NEAR(static_cast<double>(count) / kSamples, level, tolerance);
  }
}

TEST(Lilliefors, HasNoResultForTooFewOrEqualValues) {
  EXPECT_FALSE(Lilliefors(Numbers{1, 2, 3, 5}).has_value());
  EXPECT_FALSE(Lilliefors(Numbers{2, 2, 2, 2, 2}).has_value());
}

TEST(Bootstrap, AgreesWithScipyWithinSamplingNoise) {
  const auto interval = BootstrapMean(G("a"), 3, 20000);
  ASSERT_TRUE(interval.has_value());
  // A 2.5 % quantile of 20 000 means of deviation 0.3 is known to about 0.3 * 0.02 = 0.006;
  // four such deviations.
  EXPECT_NEAR(interval->low, G("bootstrap")[0], 0.024);
  EXPECT_NEAR(interval->high, G("bootstrap")[1], 0.024);
}

TEST(Bootstrap, IsDeterministicPerSeedAndHasNoResultForOneValue) {
  EXPECT_EQ(BootstrapMean(G("a"), 5)->low, BootstrapMean(G("a"), 5)->low);
  EXPECT_NE(BootstrapMean(G("a"), 5)->low, BootstrapMean(G("a"), 6)->low);
  EXPECT_FALSE(BootstrapMean(Numbers{1.0}, 5).has_value());
}

TEST(Wilcoxon, HasNoResultForEqualSamples) {
  EXPECT_FALSE(Wilcoxon(G("a"), G("a")).has_value());
  EXPECT_FALSE(PairedT(G("a"), G("a")).has_value());
}

TEST(RigidTransform, AgreesWithScipysKabsch) {
  const auto count = static_cast<Eigen::Index>(G("from").size() / 3);
  const Eigen::Map<const Eigen::Matrix3Xd> from(G("from").data(), 3, count);
  const Eigen::Map<const Eigen::Matrix3Xd> to(G("to").data(), 3, count);
  const Eigen::Matrix4d transform = RigidTransform(from, to);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      EXPECT_NEAR(transform(row, column), G("rotation")[static_cast<size_t>(3 * row + column)],
                  kTolerance);
    }
    EXPECT_NEAR(transform(row, 3), G("translation")[static_cast<size_t>(row)], kTolerance);
  }
}

TEST(GoldenNumbers, EqualThoseOfTheInstalledScipy) {
  const std::string script = test::SourceFolder() / "tests/golden/statistics.py";
  if (std::system("/usr/bin/python3 -c 'import scipy.stats' 2>/dev/null") != 0) {
    GTEST_SKIP() << "python3-scipy is not installed";
  }
  const test::TemporaryFolder folder;
  const std::string out = (folder / "statistics.txt").string();
  ASSERT_EQ(std::system(("/usr/bin/python3 " + script + " > " + out + " 2>/dev/null").c_str()), 0);
  std::ifstream file(out);
  const auto fresh = ParseGolden(file);
  for (const auto& [name, numbers] : Golden()) {
    ASSERT_TRUE(fresh.contains(name)) << name;
    for (size_t i = 0; i < numbers.size(); ++i) {
      EXPECT_NEAR(fresh.at(name).at(i), numbers[i], kTolerance) << name;
    }
  }
}

}  // namespace
}  // namespace ossa::tools
