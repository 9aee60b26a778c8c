#include "forest/classification/classify.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <utility>

#include "forest/classification/sample_grid_internal.h"
#include "forest/classification/smoothed_masses_internal.h"
#include "forest/runtime_tables_internal.h"
#include "forest/trees/depth_feature_internal.h"
#include "tests/forest/ball_figure.h"

namespace ossa::forest {
namespace {

using test::BallFigures;
using test::BallModel;

Classification ClassifyFigure(const TrainingImage& image, const ClassifyOptions& options) {
  return Classify(BallModel(), test::MakeView(image), image.camera, test::ObjectPixels(image),
                  options);
}

TEST(Classify, GivesTheSameBitsOnEveryPath) {
  const BallFigures figures(20, 31);
  for (const double sample_spacing_m : {0.0, 0.03}) {
    for (size_t i = 0; i < figures.size(); ++i) {
      const TrainingImage image = figures.Read(i);
      ClassifyOptions options;
      options.sample_spacing_m = sample_spacing_m;
      const Classification best = ClassifyFigure(image, options);
      options.instructions = InstructionSet::kScalar;
      options.threads = 3;
      const Classification scalar = ClassifyFigure(image, options);
      EXPECT_EQ(best.label, scalar.label);
      EXPECT_EQ(best.mass, scalar.mass);
      EXPECT_EQ(best.mass_scale, scalar.mass_scale);
      EXPECT_EQ(best.context, scalar.context);
      EXPECT_EQ(best.leaf, scalar.leaf);
    }
  }
}

TEST(Classify, RowsOfProbabilitiesSumToOne) {
  const TrainingImage image = BallFigures(1, 8).Read(0);
  const Classification result = ClassifyFigure(image, {});
  for (size_t i = 0; i < result.pixel.size(); ++i) {
    float sum = 0;
    for (int c = 0; c < result.class_count; ++c) {
      sum += result.Probability(i, static_cast<size_t>(c));
    }
    EXPECT_NEAR(sum, 1.0F, 1e-5F);  // of five floats
  }
}

TEST(Classify, SharesSamplesBetweenNeighbours) {
  const BallFigures figures(20, 12, 256);  // a pixel is about 8 mm
  int64_t same = 0;
  int64_t all = 0;
  for (size_t i = 0; i < figures.size(); ++i) {
    const TrainingImage image = figures.Read(i);
    ClassifyOptions options;
    options.sample_spacing_m = 0.0;
    const Classification each = ClassifyFigure(image, options);
    options.sample_spacing_m = 0.02;
    const Classification few = ClassifyFigure(image, options);
    for (size_t p = 0; p < each.label.size(); ++p) same += each.label[p] == few.label[p] ? 1 : 0;
    all += static_cast<int64_t>(each.label.size());
  }
  // What changes lies at the edges of the balls, a pixel wide: 3 % of a ball 60 pixels across.
  EXPECT_GT(static_cast<double>(same) / static_cast<double>(all), 0.97);
}

TEST(ForRows, VisitsEachNonEmptyRowOnce) {
  const std::vector<int32_t> place = {3, 4, 9, 20, 29, 30};  // in rows of ten
  std::vector<std::array<size_t, 3>> rows;
  ForRows(place, 10, [&](int32_t row, size_t first, size_t last) {
    rows.push_back({static_cast<size_t>(row), first, last});
  });
  EXPECT_EQ(rows, (std::vector<std::array<size_t, 3>>{{0, 0, 3}, {2, 3, 5}, {3, 5, 6}}));
}

TEST(ForRows, LargestBoxDoesNotOverflow) {
  const std::vector<int32_t> place = {0x7fff'0000, 0x7fff'ffff};
  ForRows(place, kPositionRow, [](int32_t row, size_t first, size_t last) {
    EXPECT_EQ(row, 0x7fff);
    EXPECT_EQ(last - first, 2U);
  });
}

// A cropped figure, with all pixels of the box as positions, including its border and pixels
// outside the object.
ObjectImage CutFigure(std::vector<int32_t>* position) {
  const TrainingImage image = BallFigures(1, 8).Read(0);
  const ObjectImage cut = CutOut(test::MakeView(image), image.camera, test::ObjectPixels(image),
                                 BallModel().data().background_mm);
  for (int i = 0; i < cut.width * cut.height; ++i) {
    position->push_back(i / cut.width << 16 | i % cut.width);
  }
  return cut;
}

// The vector path processes 128 pixels at a time, eight per vector: all remainders must work.
TEST(Walk, EqualsTheScalarPathForAnyNumberOfPixels) {
  std::vector<int32_t> position;
  const ObjectImage cut = CutFigure(&position);
  const LinedTree tree = LayOutInLines(BallModel().data().trees.front().nodes);
  for (const size_t count : {size_t{1}, size_t{7}, size_t{8}, size_t{9}, size_t{127}, size_t{128},
                             size_t{137}, position.size()}) {
    const WalkInput input{&tree, &cut, std::span(position).last(count)};
    std::vector<int32_t> scalar(count), best(count);
    WalkScalar(input, scalar.data(), 1);
    Walk(input, best.data(), 1);
    EXPECT_EQ(best, scalar) << count << " pixels";
  }
}

// A random tree: leaves on all levels, one in `leaf_in` nodes.
std::vector<Node> RandomTree(unsigned seed, int levels, int leaf_in, int offset_step) {
  std::mt19937 random(seed);
  const auto draw = [&](int most) {
    return static_cast<int>(random() % (2U * static_cast<uint32_t>(most) + 1U)) - most;
  };
  std::vector<Node> nodes(1);
  std::vector<int> level(1, 0);
  int32_t leaves = 0;
  for (size_t i = 0; i < nodes.size(); ++i) {
    if (level[i] == levels || (i > 0 && random() % static_cast<unsigned>(leaf_in) == 0)) {
      nodes[i].left = ~leaves++;
      continue;
    }
    Node node;
    for (auto* offset : {&node.u, &node.v}) {
      for (int16_t& value : *offset) value = static_cast<int16_t>(draw(500) * offset_step);
    }
    node.threshold_mm = static_cast<int16_t>(draw(300));
    node.left = static_cast<int32_t>(nodes.size());
    nodes[i] = node;
    nodes.resize(nodes.size() + 2);
    level.resize(nodes.size(), level[i] + 1);
  }
  return nodes;
}

// The leaf reached by a scalar walk.
int32_t LeafOf(const std::vector<Node>& nodes, const ObjectImage& image, int x, int y) {
  const auto d_mm = static_cast<float>(image.depth_mm[image.At(x, y)]);
  const auto read = [&](const std::array<int16_t, 2>& offset) {
    const int u = x + ScaleOffset(offset[0], FixedScale(image.scale_u, d_mm));
    const int v = y + ScaleOffset(offset[1], FixedScale(image.scale_v, d_mm));
    return int{
        image.depth_mm[image.At(std::clamp(u, -1, image.width), std::clamp(v, -1, image.height))]};
  };
  const Node* node = nodes.data();
  while (!node->is_leaf()) {
    node = &nodes[static_cast<size_t>(node->left) +
                  (read(node->u) - read(node->v) > node->threshold_mm ? 1 : 0)];
  }
  return node->leaf();
}

TEST(LayOutInLines, KeepsTheLeafOfEveryWalk) {
  std::vector<int32_t> position;
  const ObjectImage cut = CutFigure(&position);
  for (int levels = 1; levels <= 11; ++levels) {
    for (const int leaf_in : {3, 10, 1000}) {
      const auto seed = static_cast<unsigned>(100 * levels + leaf_in);
      const std::vector<Node> nodes = RandomTree(seed, levels, leaf_in, 1 + levels % 8);
      const LinedTree tree = LayOutInLines(nodes);
      std::vector<int32_t> leaf(position.size());
      Walk({&tree, &cut, position}, leaf.data(), 1);
      for (size_t i = 0; i < position.size(); ++i) {
        ASSERT_EQ(tree.leaf.at(static_cast<size_t>(leaf[i])),
                  LeafOf(nodes, cut, position[i] & 0xffff, position[i] >> 16))
            << levels << " levels, a leaf in " << leaf_in;
      }
    }
  }
}

TEST(LayOutInLines, LeavesHaveUniqueNumbers) {
  const std::vector<Node> nodes = RandomTree(5, 12, 6, 1);
  std::vector<int32_t> leaf = LayOutInLines(nodes).leaf;
  std::sort(leaf.begin(), leaf.end());
  ASSERT_EQ(leaf.size(), nodes.size() / 2 + 1);
  for (size_t i = 0; i < leaf.size(); ++i) EXPECT_EQ(leaf[i], static_cast<int32_t>(i));
}

TEST(LayOutInLines, FullTreeOfSixLevelsHasNineLines) {
  EXPECT_EQ(LayOutInLines(RandomTree(1, 6, 1 << 30, 1)).lines.size(), 9U);
}

TEST(LayOutInLines, RoundsTooManyDistinctOffsets) {
  Node inner;
  inner.u = {32767, -32768};
  inner.v = {1000, 7};
  inner.threshold_mm = -1234;
  inner.left = 1;
  Node left, right;
  left.left = ~0;
  right.left = ~1;
  const LinedTree tree = LayOutInLines({inner, left, right});
  const PackedNode& node = tree.lines.front().node.at(static_cast<size_t>(tree.first_node));
  for (const auto& [k, offset] : {std::pair{0, 32767}, {1, -32768}, {2, 1000}, {3, 7}}) {
    EXPECT_NEAR(node.offset(static_cast<size_t>(k)) * tree.offset_step, offset,
                0.5 * tree.offset_step);
  }
  EXPECT_EQ(node.threshold_mm(), -1234);
}

TEST(LayOutInLines, TreeOfOneLeafHasOneLine) {
  std::vector<int32_t> position;
  const ObjectImage cut = CutFigure(&position);
  const LinedTree tree = LayOutInLines({Node{}});
  EXPECT_EQ(tree.lines.size(), 1U);
  std::vector<int32_t> leaf(position.size(), -1);
  Walk({&tree, &cut, position}, leaf.data(), 1);
  EXPECT_EQ(leaf, std::vector<int32_t>(position.size(), 0));
}

// A flat board of 6 × 4 pixels, the right half 20 cm behind the left.
ObjectImage SteppedBoard(std::vector<int32_t>* position) {
  ObjectImage image;
  image.width = 6;
  image.height = 4;
  image.depth_mm.assign(8 * 6 + 2, 10000);
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 6; ++x) {
      image.depth_mm[image.At(x, y)] = x < 3 ? 2000 : 2200;
      position->push_back(y << 16 | x);
    }
  }
  return image;
}

TEST(ChooseSparse, SamplesOnePixelOfFourAndNeverAcrossAnEdge) {
  std::vector<int32_t> position;
  const ObjectImage image = SteppedBoard(&position);
  const SparsePixels sparse = ChooseSparse(image, position, 2.0);
  EXPECT_EQ(sparse.on_grid, 6U);  // one of each of 3 × 2 squares
  ASSERT_EQ(sparse.from.size(), position.size());
  for (size_t i = 0; i < position.size(); ++i) {
    const int32_t walker = sparse.position[static_cast<size_t>(sparse.from[i])];
    const int32_t p = position[i];
    EXPECT_EQ(image.depth_mm[image.At(p & 0xffff, p >> 16)],
              image.depth_mm[image.At(walker & 0xffff, walker >> 16)]);
  }
}

TEST(ChooseSparse, IsolatedPixelIsASampleOffTheGrid) {
  std::vector<int32_t> position;
  ObjectImage image = SteppedBoard(&position);
  image.depth_mm[image.At(0, 0)] = 900;  // the square's sample is another pixel
  const SparsePixels sparse = ChooseSparse(image, position, 2.0);
  const auto sample = static_cast<size_t>(sparse.from[0]);
  EXPECT_GE(sample, sparse.on_grid);
  EXPECT_EQ(sparse.position[sample], position[0]);
}

TEST(ChooseSparse, CellWithoutItsCentreUsesItsFirstPixel) {
  std::vector<int32_t> position;
  ObjectImage image = SteppedBoard(&position);
  std::erase(position, 1 << 16 | 1);  // the middle of the first cell of three by three
  image.depth_mm[image.At(1, 1)] = 10000;
  const SparsePixels sparse = ChooseSparse(image, position, 3.0);
  EXPECT_EQ(sparse.position.at(0), 0);
  EXPECT_EQ(sparse.position.at(1), 1 << 16 | 4);
}

TEST(ChooseSparse, StepOneSamplesEveryPixel) {
  std::vector<int32_t> position;
  const ObjectImage image = SteppedBoard(&position);
  const SparsePixels sparse = ChooseSparse(image, position, 1.0);
  EXPECT_EQ(sparse.on_grid, position.size());
  ASSERT_EQ(sparse.from.size(), position.size());
  for (size_t i = 0; i < position.size(); ++i) {
    EXPECT_EQ(sparse.position[static_cast<size_t>(sparse.from[i])], position[i]);
  }
}

// Two samples in a row, three pixels apart, the left one of class 1 and the right one of class 2:
// the border is halfway between them.
TEST(LabelPixels, BorderOfTwoLabelsIsBetweenTheirSamples) {
  ObjectImage image;
  image.width = 6;
  image.height = 1;
  image.depth_mm.assign(static_cast<size_t>(image.stride()) * 3 + 2, 10000);
  const std::vector<int32_t> position = {0, 1, 2, 3, 4, 5};
  for (const int32_t x : position) image.depth_mm[image.At(x, 0)] = 2000;
  const SparsePixels sparse = ChooseSparse(image, position, 3.0);
  ASSERT_EQ(sparse.on_grid, 2U);
  SmoothMasses smooth;
  smooth.stride = 16;
  smooth.mass.assign(2 * smooth.stride, 0);
  smooth.mass[0] = smooth.mass[smooth.stride + 1] = 1000;
  smooth.label = {1, 2};
  EXPECT_EQ(LabelPixels(image, position, sparse, smooth), (std::vector<uint8_t>{1, 1, 1, 2, 2, 2}));
}

}  // namespace
}  // namespace ossa::forest
