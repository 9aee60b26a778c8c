// docs/kinect_sdk.md names a test for each SDK feature: here it is read, and each must exist.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
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

// What the page tells C programs to call is there.
TEST(SdkTable, NamesOnlyWhatTheCHeaderHas) {
  const auto words = [](const std::filesystem::path& file, const std::string& pattern) {
    std::ifstream stream(ossa::test::SourceFolder() / file);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    const std::regex word(pattern);
    std::set<std::string> found;
    for (std::sregex_iterator at(text.begin(), text.end(), word), none; at != none; ++at)
      found.insert(at->str(1));
    return found;
  };
  const auto in_header = words("tools/tracker/include/ossa/ossa_c.h", "([A-Za-z_]+)");
  const auto calls = words("docs/kinect_sdk.md", "(ossa_[a-z_]*[a-z])\\b");
  const auto members = words("docs/kinect_sdk.md", "ossa_[a-z_]+\\.([a-z_]{2,})");
  EXPECT_GT(calls.size(), 15U);
  for (const std::string& call : calls) {
    const bool is_file = call == "ossa_c";  // ossa_c.h
    EXPECT_TRUE(is_file || in_header.contains(call)) << call;
  }
  for (const std::string& member : members) EXPECT_TRUE(in_header.contains(member)) << member;
}

}  // namespace
