// docs/kinect_sdk.md names a test for each SDK feature: here it is read, and each must exist.
#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <set>
#include <string>

#include "tests/support/places.h"

namespace {

// Names of all tests of this program; parameterised ones as "Suite/*", as the table has them (the
// program calls them "Instances/Suite").
std::set<std::string> ExistingTests() {
  std::set<std::string> names;
  const testing::UnitTest& unit = *testing::UnitTest::GetInstance();
  for (int s = 0; s < unit.total_test_suite_count(); ++s) {
    const testing::TestSuite& suite = *unit.GetTestSuite(s);
    const std::string suite_name = suite.name();
    names.insert(suite_name.substr(suite_name.find('/') + 1) + "/*");
    names.insert(suite_name.substr(0, suite_name.find('/')) + "/*");
    for (int t = 0; t < suite.total_test_count(); ++t) names.insert(suite.GetTestInfo(t)->name());
  }
  return names;
}

TEST(SdkTable, NamesOnlyTestsThatExistAndOneInEachRow) {
  std::ifstream page(ossa::test::SourceFolder() / "docs" / "kinect_sdk.md");
  ASSERT_TRUE(page.is_open());
  const std::set<std::string> existing = ExistingTests();
  const std::regex test_name("[A-Z][A-Za-z0-9]*(/\\*)?");
  int rows = 0;
  bool in_table = false;
  for (std::string line; std::getline(page, line);) {
    if (line.rfind("| SDK 1.8 skeleton stream", 0) == 0) {
      in_table = true;
      continue;
    }
    in_table = in_table && !line.empty() && line[0] == '|';
    if (!in_table || line.rfind("|---", 0) == 0) continue;
    ++rows;
    const size_t end = line.rfind('|'), begin = line.rfind('|', end - 1);
    const std::string cell = line.substr(begin + 1, end - begin - 1);
    const std::sregex_iterator names(cell.begin(), cell.end(), test_name), none;
    EXPECT_NE(names, none) << line;
    for (auto name = names; name != none; ++name)
      EXPECT_EQ(existing.count(name->str()), 1U) << name->str() << " of: " << line;
  }
  EXPECT_GE(rows, 15);  // the table is there, and was found
}

}  // namespace
