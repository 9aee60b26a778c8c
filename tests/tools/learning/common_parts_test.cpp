#include "tools/learning/common_parts.h"

#include <gtest/gtest.h>

#include <set>

#include "recon/body/parts.h"

namespace ossa::tools {
namespace {

// PCL's classes as the importer names them.
const std::vector<std::string> kPcl = {
    "background", "Lfoot", "Lleg",   "Lknee",  "Lthigh", "Rfoot",    "Rleg",   "Rknee", "Rthigh",
    "Rhips",      "Lhips", "Neck",   "Rarm",   "Relbow", "Rforearm", "Rhand",  "Larm",  "Lelbow",
    "Lforearm",   "Lhand", "FaceLB", "FaceRB", "FaceLT", "FaceRT",   "Rchest", "Lchest"};

std::vector<std::string> OurNames() { return {recon::kPartNames.begin(), recon::kPartNames.end()}; }

TEST(CommonParts, EveryPclClassMapsToACommonPart) {
  const auto common = FindCommonParts(kPcl);
  ASSERT_TRUE(common);
  EXPECT_EQ((*common)[0], kNoCommonPart);
  std::set<uint8_t> parts(common->begin() + 1, common->end());
  EXPECT_EQ(parts.size(), static_cast<size_t>(kCommonPartCount));
  EXPECT_EQ(parts.count(kNoCommonPart), 0U);
}

TEST(CommonParts, LabelsOfOurModelMapLikeTheTruth) {
  const auto common = FindCommonParts(OurNames());
  ASSERT_TRUE(common);
  for (uint8_t label = 0; label < recon::kLabelCount; ++label) {
    const uint8_t truth = ToCommonPart(label);
    if (truth == kNoCommonPart) continue;
    EXPECT_EQ((*common)[label], truth) << recon::kPartNames[label];
  }
}

TEST(CommonParts, ShouldersWristsAndAnklesAreAcceptedButNotScored) {
  const auto common = FindCommonParts(OurNames());
  ASSERT_TRUE(common);
  for (uint8_t label = 1; label <= recon::kPartCount; ++label) {
    const std::string name(recon::kPartNames[label]);
    const bool between = name.find("shoulder") != std::string::npos ||
                         name.find("wrist") != std::string::npos ||
                         name.find("ankle") != std::string::npos;
    EXPECT_EQ(ToCommonPart(label) == kNoCommonPart, between) << name;
    EXPECT_NE((*common)[label], kNoCommonPart) << name;
  }
}

TEST(CommonParts, UnknownClassNamesHaveNoMapping) {
  EXPECT_FALSE(FindCommonParts(std::vector<std::string>{"background", "cat", "dog"}));
}

TEST(CommonParts, PclTargetsAreInPclClasses) {
  const auto targets = PclTargets(kPcl);
  ASSERT_EQ(targets.size(), static_cast<size_t>(recon::kJointCount));
  for (size_t j = 0; j < targets.size(); ++j) {
    EXPECT_EQ(targets[j].name, recon::kJointNames[j]);
    EXPECT_EQ(!targets[j].classes.empty(), IsCommonJoint(static_cast<recon::Joint>(j)));
  }
}

}  // namespace
}  // namespace ossa::tools
