// Small files from users, beside the checkout: each is read like the plain one.
#include <gtest/gtest.h>

#include <algorithm>

#include "recon/files/skeleton_io.h"
#include "tests/support/places.h"

namespace ossa::recon {
namespace {

std::filesystem::path Cases() { return test::SharedFolder() / "cases"; }

struct Case {
  const char* name;
  const char* file;
  const char* base;     // the plain file
  double tolerance_m;   // precision of its digits
  const char* warning;  // expected warning; "" for none
};

void PrintTo(const Case& value, std::ostream* out) { *out << value.file; }

double FarthestApart_m(const SkeletonSequence& a, const SkeletonSequence& b) {
  double farthest_m = 0.0;
  for (size_t f = 0; f < a.frames.size(); ++f) {
    for (size_t j = 0; j < kJointCount; ++j) {
      const auto& one = a.frames[f].bodies.at(0).joints[j];
      const auto& other = b.frames[f].bodies.at(0).joints[j];
      if (!one || !other) continue;
      farthest_m = std::max(farthest_m, (one->position_m - other->position_m).norm());
    }
  }
  return farthest_m;
}

size_t CountJoints(const SkeletonSequence& sequence) {
  size_t count = 0;
  for (const SkeletonFrame& frame : sequence.frames) {
    for (const BodyRecord& body : frame.bodies) {
      count += static_cast<size_t>(std::count_if(body.joints.begin(), body.joints.end(),
                                                 [](const auto& j) { return j.has_value(); }));
    }
  }
  return count;
}

class SharedCase : public testing::TestWithParam<Case> {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(Cases())) GTEST_SKIP() << "no " << Cases();
  }
};

TEST_P(SharedCase, EqualsItsReference) {
  const auto base = ReadSkeletons(Cases() / GetParam().base);
  const auto read = ReadSkeletons(Cases() / GetParam().file);
  ASSERT_EQ(read.frames.size(), base.frames.size());
  EXPECT_EQ(CountJoints(read), CountJoints(base) * read.frames[0].bodies.size());
  EXPECT_LT(FarthestApart_m(read, base), GetParam().tolerance_m);
  const std::string warning = GetParam().warning;
  if (warning.empty()) {
    EXPECT_TRUE(read.warnings.empty()) << read.warnings.front();
  } else {
    ASSERT_EQ(read.warnings.size(), 1u);
    EXPECT_NE(read.warnings[0].find(warning), std::string::npos) << read.warnings[0];
  }
}

// Six decimals of a centimetre and a degree; of a millimetre five; integers of a tenth of one.
constexpr double kBvh_m = 1e-6, kTrc_m = 2e-8, kTenth_m = 1e-4;
// The C3D have the axes of the others, a laboratory's z is up.
constexpr const char* kYUp = "the body stands along y: y is taken as up";

INSTANTIATE_TEST_SUITE_P(
    All, SharedCase,
    testing::Values(
        Case{"BvhCrOnly", "bvh/cr_only.bvh", "base.bvh", kBvh_m, ""},
        Case{"BvhFramesNoSpace", "bvh/frames_nospace.bvh", "base.bvh", kBvh_m, ""},
        Case{"BvhEndChannels0", "bvh/end_channels0.bvh", "base.bvh", kBvh_m, ""},
        Case{"BvhDeclaresMore", "bvh/declares_more.bvh", "base.bvh", kBvh_m,
             "the header says 75 frames, the file has 60"},
        Case{"BvhMixamoUnderscore", "bvh/mixamo_underscore.bvh", "base.bvh", kBvh_m, ""},
        Case{"BvhRigify", "bvh/rigify.bvh", "base.bvh", kBvh_m, ""},
        Case{"BvhTwoPeople", "bvh/two_people.bvh", "base.bvh", kBvh_m, ""},
        Case{"TrcLabelsFromX5", "trc/labels_from_X5.trc", "base_mm.trc", kTrc_m, ""},
        Case{"TrcCentimetres", "trc/cm.trc", "base_mm.trc", 10 * kTrc_m, ""},
        Case{"C3dDec", "c3d/dec_float.c3d", "c3d/intel_float.c3d", kTenth_m, kYUp},
        Case{"C3dMips", "c3d/mips_int.c3d", "c3d/intel_float.c3d", kTenth_m, kYUp},
        Case{"C3d", "c3d/intel_float.c3d", "base_mm.trc", kTenth_m, kYUp},
        Case{"CsvSemicolonComma", "csv/semicolon_comma.csv", "csv/own.csv", kTrc_m, ""}),
    [](const auto& info) { return std::string(info.param.name); });

// A BVH must not be retargeted to the standard body.
TEST(SharedCaseOf, BvhAndTrcOfOneMotionAreEqual) {
  if (!std::filesystem::exists(Cases())) GTEST_SKIP() << "no " << Cases();
  const auto bvh = ReadSkeletons(Cases() / "base.bvh");
  const auto trc = ReadSkeletons(Cases() / "base_mm.trc");
  ASSERT_EQ(bvh.frames.size(), trc.frames.size());
  EXPECT_EQ(CountJoints(trc), trc.frames.size() * 15);
  EXPECT_LT(FarthestApart_m(bvh, trc), kBvh_m);
}

TEST(SharedCaseOf, ChildOf112CentimetresKeepsItsSize) {
  if (!std::filesystem::exists(Cases())) GTEST_SKIP() << "no " << Cases();
  const auto child = ReadSkeletons(Cases() / "bvh/child_112cm.bvh");
  const auto adult = ReadSkeletons(Cases() / "base.bvh");
  ASSERT_EQ(child.frames.size(), adult.frames.size());
  for (size_t j = 1; j < kJointCount; ++j) {
    const auto bone = [&](const SkeletonSequence& of) {
      const auto& joints = of.frames[30].bodies[0].joints;
      return (joints[j]->position_m - joints[ParentOf(j)]->position_m).norm();
    };
    EXPECT_NEAR(bone(child) / bone(adult), 0.62, 1e-4) << kJointNames[j];
  }
}

TEST(SharedCaseOf, NanInATrcIsMissing) {
  if (!std::filesystem::exists(Cases())) GTEST_SKIP() << "no " << Cases();
  const auto base = ReadSkeletons(Cases() / "base_mm.trc");
  const auto read = ReadSkeletons(Cases() / "trc/gap_NaN.trc");
  ASSERT_EQ(read.frames.size(), base.frames.size());
  EXPECT_LT(CountJoints(read), CountJoints(base));
  EXPECT_GT(CountJoints(read), CountJoints(base) / 2);
  EXPECT_LT(FarthestApart_m(read, base), kTrc_m);
}

std::string Joined(const std::vector<std::string>& warnings) {
  std::string text;
  for (const std::string& warning : warnings) text += warning + "\n";
  return text;
}

TEST(SharedCaseOf, NtuWithNanOrAWrongCountKeepsValidData) {
  if (!std::filesystem::exists(Cases())) GTEST_SKIP() << "no " << Cases();
  const auto nan = ReadSkeletons(Cases() / "ntu/nan_joints.skeleton");
  const auto more = ReadSkeletons(Cases() / "ntu/count_more.skeleton");
  ASSERT_EQ(nan.frames.size(), 40u);
  ASSERT_EQ(more.frames.size(), 40u);
  EXPECT_EQ(CountJoints(more), 40u * kJointCount);
  EXPECT_LT(CountJoints(nan), 40u * kJointCount);
  EXPECT_GT(CountJoints(nan), 40u * kJointCount * 9 / 10);
  EXPECT_EQ(FarthestApart_m(nan, more), 0.0);
  EXPECT_NE(Joined(nan.warnings).find("are NaN"), std::string::npos);
  EXPECT_NE(Joined(more.warnings).find("counts 52 frames, the file has 40"), std::string::npos);
  // The made-up motion was put into camera space by turning z alone: its person is a mirror image.
  EXPECT_NE(Joined(nan.warnings).find("bend backwards"), std::string::npos);
}

}  // namespace
}  // namespace ossa::recon
