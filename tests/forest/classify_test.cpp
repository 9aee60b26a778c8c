#include "forest/classify.h"

#include <gtest/gtest.h>

#include <array>

#include "forest/feature_internal.h"
#include "forest/runtime_internal.h"
#include "forest/smooth_internal.h"
#include "forest/sparse_internal.h"
#include "tests/forest/ball_figure.h"

namespace ossa::forest {
namespace {

using test::BallFigures;
using test::BallModel;

Classification ClassifyFigure(const TrainingImage& image, const ClassifyOptions& options) {
  return Classify(BallModel(), test::ViewOf(image), image.camera, test::ObjectPixels(image),
                  options);
}

TEST(Classify, GivesTheSameBitsOnEveryPath) {
  const BallFigures figures(20, 31);
  for (const double fine_m : {0.0, 0.03}) {
    for (size_t i = 0; i < figures.size(); ++i) {
      const TrainingImage image = figures.Read(i);
      ClassifyOptions options;
      options.fine_m = fine_m;
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

TEST(Classify, LetsFewPixelsSpeakForTheirNeighbours) {
  const BallFigures figures(20, 12, 256);  // a pixel is about 8 mm
  int64_t same = 0;
  int64_t all = 0;
  for (size_t i = 0; i < figures.size(); ++i) {
    const TrainingImage image = figures.Read(i);
    ClassifyOptions options;
    options.fine_m = 0.0;
    const Classification each = ClassifyFigure(image, options);
    options.fine_m = 0.02;
    const Classification few = ClassifyFigure(image, options);
    for (size_t p = 0; p < each.label.size(); ++p) same += each.label[p] == few.label[p] ? 1 : 0;
    all += static_cast<int64_t>(each.label.size());
  }
  // What changes lies at the edges of the balls, a pixel wide: 3 % of a ball 60 pixels across.
  EXPECT_GT(static_cast<double>(same) / static_cast<double>(all), 0.97);
}

TEST(ForRows, GivesEachRowThatHoldsAnythingOnce) {
  const std::vector<int32_t> place = {3, 4, 9, 20, 29, 30};  // in rows of ten
  std::vector<std::array<size_t, 3>> rows;
  ForRows(place, 10, [&](int32_t row, size_t first, size_t last) {
    rows.push_back({static_cast<size_t>(row), first, last});
  });
  EXPECT_EQ(rows, (std::vector<std::array<size_t, 3>>{{0, 0, 3}, {2, 3, 5}, {3, 5, 6}}));
}

TEST(ForRows, TheLastRowOfTheLargestBoxOverflowsNothing) {
  const std::vector<int32_t> place = {0x7fff'0000, 0x7fff'ffff};
  ForRows(place, kPositionRow, [](int32_t row, size_t first, size_t last) {
    EXPECT_EQ(row, 0x7fff);
    EXPECT_EQ(last - first, 2U);
  });
}

// The vector path takes 128 pixels at a time, eight to a vector: any rest of them must do.
TEST(Walk, AnyNumberOfPixelsEndsInTheLeavesOfTheScalarPath) {
  const TrainingImage image = BallFigures(1, 8).Read(0);
  const ObjectImage cut = CutOut(test::ViewOf(image), image.camera, test::ObjectPixels(image),
                                 BallModel().data().background_mm);
  std::vector<int32_t> position;  // the whole box: its border and pixels off the object as well
  for (int i = 0; i < cut.width * cut.height; ++i) {
    position.push_back(i / cut.width << 16 | i % cut.width);
  }
  const Tree& tree = BallModel().data().trees.front();
  for (const size_t count : {size_t{1}, size_t{7}, size_t{8}, size_t{9}, size_t{127}, size_t{128},
                             size_t{137}, position.size()}) {
    const WalkInput input{tree.nodes.data(), &cut, std::span(position).last(count)};
    std::vector<int32_t> scalar(count), best(count);
    WalkScalar(input, scalar.data(), 1);
    Walk(input, best.data(), 1);
    EXPECT_EQ(best, scalar) << count << " pixels";
  }
}

TEST(LayOutInLines, EveryWalkEndsInTheLeafItEndedInBefore) {
  const TrainingImage image = BallFigures(1, 8).Read(0);
  const ObjectImage cut = CutOut(test::ViewOf(image), image.camera, test::ObjectPixels(image),
                                 BallModel().data().background_mm);
  std::vector<int32_t> position;
  for (int i = 0; i < cut.width * cut.height; ++i) {
    position.push_back(i / cut.width << 16 | i % cut.width);
  }
  const std::vector<Node>& nodes = BallModel().data().trees.front().nodes;
  const std::vector<NodeLine> lines = LayOutInLines(nodes);
  EXPECT_LE(4 * lines.size(), nodes.size() + 5);  // the root's line and one of two leaves have room
  std::vector<int32_t> before(position.size()), after(position.size());
  WalkScalar({nodes.data(), &cut, position}, before.data(), 1);
  WalkScalar({lines.front().node.data(), &cut, position}, after.data(), 1);
  EXPECT_EQ(after, before);
}

TEST(LayOutInLines, ATreeOfOneLeafIsOneLine) {
  const std::vector<NodeLine> lines = LayOutInLines({Node{}});
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_EQ(lines.front().node.front(), Node{});
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

TEST(ChooseSparse, OnePixelOfFourWalksAndNoneSpeaksAcrossAnEdge) {
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

TEST(ChooseSparse, APixelAloneOnItsSurfaceIsASampleOffTheGrid) {
  std::vector<int32_t> position;
  ObjectImage image = SteppedBoard(&position);
  image.depth_mm[image.At(0, 0)] = 900;  // the square's sample is another pixel
  const SparsePixels sparse = ChooseSparse(image, position, 2.0);
  const auto sample = static_cast<size_t>(sparse.from[0]);
  EXPECT_GE(sample, sparse.on_grid);
  EXPECT_EQ(sparse.position[sample], position[0]);
}

TEST(ChooseSparse, EveryPixelWalksAtStepOne) {
  std::vector<int32_t> position;
  const ObjectImage image = SteppedBoard(&position);
  const SparsePixels sparse = ChooseSparse(image, position, 1.0);
  EXPECT_EQ(sparse.on_grid, position.size());
  ASSERT_EQ(sparse.from.size(), position.size());
  for (size_t i = 0; i < position.size(); ++i) {
    EXPECT_EQ(sparse.position[static_cast<size_t>(sparse.from[i])], position[i]);
  }
}

// Two samples of a row, three pixels apart, the left one of class 1 and the right one of class 2:
// the border lies in the middle between them.
TEST(LabelPixels, TheBorderOfTwoLabelsLiesBetweenTheirSamples) {
  ObjectImage image;
  image.width = 6;
  image.height = 1;
  image.depth_mm.assign(static_cast<size_t>(image.stride()) * 3 + 2, 2000);
  const std::vector<int32_t> position = {0, 1, 2, 3, 4, 5};
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
