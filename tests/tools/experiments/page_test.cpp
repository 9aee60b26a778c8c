#include "tools/experiments/page/page.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/temporary_folder.h"
#include "tools/json/base64.h"

namespace ossa::tools {
namespace {

// RFC 4648, section 10.
TEST(Base64, MatchesTheStandard) {
  EXPECT_EQ(Base64(""), "");
  EXPECT_EQ(Base64("f"), "Zg==");
  EXPECT_EQ(Base64("fo"), "Zm8=");
  EXPECT_EQ(Base64("foo"), "Zm9v");
  EXPECT_EQ(Base64("foobar"), "Zm9vYmFy");
}

TEST(ExperimentPage, PlotsNumericColumns) {
  const test::TemporaryFolder folder;
  const Table table{"Errors",
                    {"method", "cm", "source"},
                    {{"best", "2.5 ± 0.1", "ours"}, {"none", "–", "<b>"}},
                    {}};
  const std::string page = ExperimentPage("study", {table}, folder.path());
  EXPECT_NE(page.find("<title>best cm: 2.50</title>"), std::string::npos);
  EXPECT_EQ(page.find("source: "), std::string::npos);
  EXPECT_NE(page.find("&lt;b&gt;"), std::string::npos);
}

TEST(ExperimentPage, EmbedsTheFiguresBesideIt) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "curve.svg") << "foo";
  std::ofstream(folder / "notes.txt") << "foobar";
  const std::string page = ExperimentPage("study", {}, folder.path());
  EXPECT_NE(page.find("src=\"data:image/svg+xml;base64,Zm9v\""), std::string::npos);
  EXPECT_EQ(page.find("Zm9vYmFy"), std::string::npos);
}

}  // namespace
}  // namespace ossa::tools
