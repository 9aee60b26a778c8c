#include "tools/learning/labels_picture.h"

#include <gtest/gtest.h>

#include <utility>

#include "recon/body/parts.h"
#include "tools/learning/person_source.h"

namespace ossa::tools {
namespace {

constexpr uint8_t kNeck = 5, kLeftHand = 16;

// A forest of a single leaf, which labels every pixel as `part`.
forest::ForestData OneLeaf(uint8_t part) {
  const forest::TrainingVocabulary vocabulary = BodyVocabulary();
  forest::ForestData data;
  data.class_names = vocabulary.class_names;
  data.context_names = {"any"};
  data.context_prior = {1.0F};
  data.targets = vocabulary.targets;
  forest::Tree& tree = data.trees.emplace_back();
  tree.nodes.emplace_back();
  tree.entry_begin = {0, 1};
  tree.entries = {static_cast<uint16_t>(127U << 9U | part)};
  return data;
}

// A person of a few pixels.
LabelledFrame SmallFrame() {
  LabelledFrame frame;
  frame.depth.camera = depth::KinectV1Camera(8, 6);
  frame.depth.depth_mm.assign(48, 0);
  frame.parts = frame.users = depth::Image<uint8_t>(8, 6);
  for (const size_t pixel : {19U, 20U, 27U, 28U}) {
    frame.depth.depth_mm[pixel] = 2000;
    frame.parts.data[pixel] = kNeck;
    frame.users.data[pixel] = 1;
  }
  frame.bodies.emplace_back();
  return frame;
}

// The picture showed the labels before relabelling, the accuracy was that after it.
TEST(DrawPanels, ShowsRelabelledParts) {
  const LabelledFrame frame = SmallFrame();
  forest::ForestData relabelled = OneLeaf(kNeck);
  const size_t classes = relabelled.class_names.size() - 1;
  relabelled.relabelling.weight.assign(
      2 * forest::kRadialBasisScales * relabelled.targets.size() * classes, 0.0F);
  relabelled.relabelling.bias.assign(classes, 0.0F);
  relabelled.relabelling.bias[kLeftHand - 1] = 20.0F;  // nats: more than the trees say
  const auto hands = DrawPanels(forest::ForestModel(OneLeaf(kLeftHand)), frame);
  EXPECT_TRUE(DrawPanels(forest::ForestModel(std::move(relabelled)), frame) == hands);
  EXPECT_FALSE(DrawPanels(forest::ForestModel(OneLeaf(kNeck)), frame) == hands);
}

}  // namespace
}  // namespace ossa::tools
