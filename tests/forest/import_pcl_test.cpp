#include "forest/import_pcl.h"

#include <gtest/gtest.h>

#include <fstream>

#include "depth/base/error.h"
#include "tests/support/temporary_folder.h"

namespace ossa::forest {
namespace {

std::string RefusalOf(const std::string& content) {
  const ossa::test::TemporaryFolder folder;
  const auto path = folder.path() / "tree.txt";
  std::ofstream(path, std::ios::binary) << content;
  try {
    ImportPclTrees({path});
  } catch (const InputError& error) {
    return std::string(error.what()).substr(path.string().size());
  }
  return "accepted";
}

TEST(PclImport, TreeOfOneSplitHasTwoLeaves) {
  const ossa::test::TemporaryFolder folder;
  const auto path = folder.path() / "tree.txt";
  std::ofstream(path) << "1\n16 -32 0 48 200\n4\n10\n";
  const ForestModel model = ImportPclTrees({path});
  ASSERT_EQ(model.data().trees.size(), 1U);
  const Tree& tree = model.data().trees[0];
  ASSERT_EQ(tree.nodes.size(), 3U);
  // 16 mm at f = 575 px is 9.2 pixel·metres, 147.2 of our sixteenths.
  EXPECT_EQ(tree.nodes[0].u, (std::array<int16_t, 2>{147, -294}));
  EXPECT_EQ(tree.nodes[0].v, (std::array<int16_t, 2>{0, 442}));
  EXPECT_EQ(tree.nodes[0].threshold_mm, 200);
  EXPECT_EQ(model.data().class_names[5], "Rfoot");
}

TEST(PclImport, ErrorsNameLineAndExpectation) {
  EXPECT_EQ(RefusalOf(std::string("\x89PNG\r\n\0\xFF", 8)),
            ": line 1: expected the depth of a PCL people tree, found '\\x89PNG\\x0D'");
  EXPECT_EQ(RefusalOf("1\n1 2 3\n"), ": line 2: expected a node of 5 whole numbers, found '1 2 3'");
  EXPECT_EQ(RefusalOf(std::string("1\n1 2 3 4 5\n7\0\n7\n", 16)),
            ": line 3: expected the label of a leaf, found '7\\x00'");
  EXPECT_EQ(RefusalOf("1\n1 2 3 4 5\n7\n"), ": line 4: expected the label of a leaf, found ''");
}

TEST(PclImport, DoesNotReadEndlessLines) {
  EXPECT_EQ(
      RefusalOf(std::string(5'000'000, '1')),
      ": line 1: expected the depth of a PCL people tree, found '" + std::string(40, '1') + "'");
}

}  // namespace
}  // namespace ossa::forest
