#include "depth/base/random.h"

#include <gtest/gtest.h>

namespace ossa {
namespace {

// The reference sequence of SplitMix64 for seed 1234567 (Vigna, splitmix64.c, as Rosetta Code has
// it).
TEST(Random, IsSplitMix64) {
  Random random(1234567);
  EXPECT_EQ(random.Bits(), 6457827717110365317ULL);
  EXPECT_EQ(random.Bits(), 3203168211198807973ULL);
  EXPECT_EQ(random.Bits(), 9817491932198370423ULL);
}

TEST(Random, NumberAtAnIndexEqualsTheSequence) {
  Random random(5);
  for (uint64_t index = 0; index < 10; ++index) {
    EXPECT_EQ(Random::BitsAt(5, index), random.Bits()) << index;
  }
}

TEST(Random, StreamsDiffer) {
  EXPECT_NE(Random(5, 0).Bits(), Random(5, 1).Bits());
  EXPECT_NE(Random(5, 0).Bits(), Random(6, 0).Bits());
  EXPECT_EQ(Random(5, 1).Bits(), Random(5, 1).Bits());
}

TEST(Random, StaysWithinItsBounds) {
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    EXPECT_LT(random.Below(7), 7U);
    EXPECT_LT(random.Index(3), 3U);
    const double x = random.Uniform(-2.0, 5.0);
    EXPECT_GE(x, -2.0);
    EXPECT_LT(x, 5.0);
  }
}

// Standard errors of the mean and the variance of 10 000 draws are 0.01 and 0.014.
TEST(Random, DrawsNormallyDistributedNumbers) {
  constexpr int kDraws = 10000;
  Random random(8);
  double sum = 0.0, square = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    const double x = random.Normal(0.0, 1.0);
    sum += x;
    square += x * x;
  }
  EXPECT_NEAR(sum / kDraws, 0.0, 0.05);
  EXPECT_NEAR(square / kDraws, 1.0, 0.07);
}

TEST(Random, SumsFourPartsOf16Bits) {
  EXPECT_EQ(SumOfParts(0), 0);
  EXPECT_EQ(SumOfParts(0xFFFF'0001'0020'0300ULL), 0xFFFF + 0x1 + 0x20 + 0x300);
  EXPECT_EQ(SumOfParts(~uint64_t{0}), 4 * 0xFFFF);
}

// Four independent uniform numbers: excess kurtosis -1.2 / 4. Standard errors of 100 000 draws are
// below 0.01 for the mean, variance and kurtosis.
TEST(Random, NearlyNormalHasMean0AndVariance1) {
  constexpr int kDraws = 100000;
  Random random(8);
  double sum = 0.0, square = 0.0, fourth = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    const double x = NearlyNormal(random.Bits());
    sum += x;
    square += x * x;
    fourth += x * x * x * x;
  }
  EXPECT_NEAR(sum / kDraws, 0.0, 0.02);
  EXPECT_NEAR(square / kDraws, 1.0, 0.02);
  EXPECT_NEAR(fourth / kDraws, 2.7, 0.06);
}

}  // namespace
}  // namespace ossa
