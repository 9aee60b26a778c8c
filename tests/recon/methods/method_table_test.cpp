#include "recon/methods/method_table.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "depth/base/error.h"
#include "recon/methods/reconstructor.h"

namespace ossa::recon {
namespace {

class MethodRow : public testing::TestWithParam<std::string> {};

TEST_P(MethodRow, IsFoundByItsName) {
  const MethodInfo* row = FindMethod(GetParam());
  ASSERT_NE(row, nullptr);
  EXPECT_EQ(row->name, GetParam());
  EXPECT_EQ(&RequireMethod(GetParam()), row);
}

// Without files a method can be created unless its row requires one.
TEST_P(MethodRow, StatesTheRequiredModels) {
  const MethodInfo& row = RequireMethod(GetParam());
  ReconstructorOptions options;
  options.method = GetParam();
  if (row.database == Reads::kRequired || row.learned == Reads::kRequired) {
    EXPECT_THROW(MakeReconstructor(options), InputError);
  } else {
    EXPECT_NE(MakeReconstructor(options), nullptr);
  }
}

INSTANTIATE_TEST_SUITE_P(All, MethodRow, testing::ValuesIn(ReconstructionMethods()),
                         [](const auto& info) {
                           std::string name = info.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

// For methods that need no files.
TEST(MethodTable, StatesWhichMethodsKeepBones) {
  for (const MethodInfo& row : MethodTable()) {
    if (row.database == Reads::kRequired || row.learned == Reads::kRequired) continue;
    ReconstructorOptions options;
    options.method = row.name;
    options.bones_m.emplace().fill(0.3);
    if (row.keeps_bones) {
      EXPECT_NE(MakeReconstructor(options), nullptr) << row.name;
    } else {
      EXPECT_THROW(MakeReconstructor(options), InputError) << row.name;
    }
  }
}

TEST(MethodTable, NamesAreUniqueAndIncludeTheDefault) {
  auto names = ReconstructionMethods();
  EXPECT_EQ(names.size(), MethodTable().size());
  std::sort(names.begin(), names.end());
  EXPECT_EQ(std::unique(names.begin(), names.end()), names.end());
  EXPECT_NE(FindMethod(kDefaultMethod), nullptr);
}

TEST(MethodTable, UnknownNameIsRefusedWithAllNames) {
  EXPECT_EQ(FindMethod("treacle"), nullptr);
  try {
    RequireMethod("treacle");
    FAIL();
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("'treacle'"), std::string::npos) << message;
    for (const std::string& name : ReconstructionMethods()) {
      EXPECT_NE(message.find(name), std::string::npos) << name;
    }
  }
}

}  // namespace
}  // namespace ossa::recon
