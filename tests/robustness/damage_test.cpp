// No damage to a file that carries a checksum stays undetected.
//   robustness_test                          a few hundred damaged copies of each sample
//   OSSA_ROBUSTNESS=full robustness_test     cut at every byte, every bit flipped; prints the table
//                                            of docs/benchmarks/robustness.md
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "tests/robustness/recordings.h"
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
              outcomes.tried, outcomes.refused, outcomes.same, outcomes.warned, outcomes.silent);
}

class Damage : public testing::TestWithParam<size_t> {
 protected:
  static const DamageSample& Sample() {
    static const std::vector<DamageSample> samples = ChecksummedSamples();
    return samples.at(GetParam());
  }
};

TEST_P(Damage, TruncatedFilesAreDetected) {
  const DamageOutcomes outcomes = CutShort(Sample(), StepFor(Sample().bytes.size(), 200));
  Print("cut short", Sample(), outcomes);
  EXPECT_GT(outcomes.refused, 0U);
  EXPECT_EQ(outcomes.silent, 0U) << Sample().name << ": " << outcomes.first_silent;
}

TEST_P(Damage, FlippedBitsAreDetected) {
  const DamageOutcomes outcomes = FlipBits(Sample(), StepFor(8 * Sample().bytes.size(), 500));
  Print("a bit flipped", Sample(), outcomes);
  EXPECT_GT(outcomes.refused, 0U);
  EXPECT_EQ(outcomes.silent, 0U) << Sample().name << ": " << outcomes.first_silent;
}

INSTANTIATE_TEST_SUITE_P(EachFormat, Damage, testing::Range<size_t>(0, 13));

// A program of its own reads each copy: a hundredth of a second.
class PlainDamage : public testing::TestWithParam<size_t> {
 protected:
  void SetUp() override {
    static const std::vector<DamageSample> samples = PlainRecordings();
    if (GetParam() >= samples.size()) GTEST_SKIP() << "built without its reader";
    sample_ = &samples[GetParam()];
  }
  static size_t Step(size_t places, size_t copies) {
    constexpr size_t kFull = 1000;
    return places / (IsFull() ? kFull : copies) | 1;
  }
  const DamageSample* sample_ = nullptr;
};

TEST_P(PlainDamage, TruncatedFilesAreDetected) {
  const DamageOutcomes outcomes = CutShort(*sample_, Step(sample_->bytes.size(), 30));
  Print("cut short", *sample_, outcomes);
  EXPECT_EQ(outcomes.silent, 0U) << sample_->name << ": " << outcomes.first_silent;
}

TEST_P(PlainDamage, FlippedBitsDoNotCrash) {
  const DamageOutcomes outcomes = FlipBits(*sample_, Step(8 * sample_->bytes.size(), 50));
  Print("a bit flipped", *sample_, outcomes);
  EXPECT_GT(outcomes.refused + outcomes.same, 0U);
}

INSTANTIATE_TEST_SUITE_P(EachFormat, PlainDamage, testing::Range<size_t>(0, 14));

TEST(DamageSamples, AreAsManyAsTried) { EXPECT_EQ(ChecksummedSamples().size(), 13U); }

}  // namespace
}  // namespace ossa::test
