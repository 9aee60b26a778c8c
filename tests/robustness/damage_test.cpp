// No damage to a file that carries a checksum passes in silence.
//   robustness_test                          a few hundred damaged copies of each sample
//   OSSA_ROBUSTNESS=full robustness_test     cut at every byte, every bit flipped; prints the table
//                                            of docs/benchmarks/robustness.md
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "tests/robustness/samples.h"

namespace ossa::test {
namespace {

bool IsFull() {
  const char* asked = std::getenv("OSSA_ROBUSTNESS");
  return asked != nullptr && std::string_view(asked) == "full";
}

// So that so many copies are tried; odd, so that all bits of a byte have their turn.
size_t StepFor(size_t places, size_t copies) { return IsFull() ? 1 : places / copies | 1; }

void Print(const char* damage, const DamageSample& sample, const DamageOutcomes& outcomes) {
  std::printf("| %s | %s | %zu | %zu | %zu | %zu | %zu |\n", sample.name.c_str(), damage,
              outcomes.tried, outcomes.refused, outcomes.same, outcomes.told, outcomes.silent);
}

class Damage : public testing::TestWithParam<size_t> {
 protected:
  static const DamageSample& Sample() {
    static const std::vector<DamageSample> samples = ChecksummedSamples();
    return samples.at(GetParam());
  }
};

TEST_P(Damage, OfAnEndThatIsMissingIsNoticed) {
  const DamageOutcomes outcomes = CutShort(Sample(), StepFor(Sample().bytes.size(), 200));
  Print("cut short", Sample(), outcomes);
  EXPECT_GT(outcomes.refused, 0U);
  EXPECT_EQ(outcomes.silent, 0U) << Sample().name << ": " << outcomes.first_silent;
}

TEST_P(Damage, OfAFlippedBitIsNoticed) {
  const DamageOutcomes outcomes = FlipBits(Sample(), StepFor(8 * Sample().bytes.size(), 500));
  Print("a bit flipped", Sample(), outcomes);
  EXPECT_GT(outcomes.refused, 0U);
  EXPECT_EQ(outcomes.silent, 0U) << Sample().name << ": " << outcomes.first_silent;
}

INSTANTIATE_TEST_SUITE_P(EachFormat, Damage, testing::Range<size_t>(0, 11));

TEST(DamageSamples, AreAsManyAsAreTried) { EXPECT_EQ(ChecksummedSamples().size(), 11U); }

}  // namespace
}  // namespace ossa::test
