// Forest models: a payload of any bytes, under a seal that is right, is a model that runs or an
// InputError. The checksum would otherwise stop all but the first field.
#include <algorithm>
#include <cstdint>
#include <cstring>

#include "depth/base/checksummed_container.h"
#include "forest/forest.h"
#include "tests/fuzz/outcome.h"
#include "tests/fuzz/seeds.h"

namespace {

using ossa::forest::ForestData;
using ossa::forest::ForestModel;

ForestModel SmallModel() {
  ossa::forest::Tree tree;
  ossa::forest::Node root;
  root.left = 1;
  root.threshold_mm = 5;
  ossa::forest::Node first;
  first.left = ~0;
  ossa::forest::Node second;
  second.left = ~1;
  tree.nodes = {root, first, second};
  tree.entry_begin = {0, 1, 2};
  tree.entries = {static_cast<uint16_t>(100 << 9 | 1), static_cast<uint16_t>(90 << 9 | 2)};
  tree.votes.resize(1);
  ForestData data;
  data.class_names = {"background", "a", "b"};
  data.context_names = {"any"};
  data.context_prior = {1.0F};
  data.trees = {tree};
  data.targets = {{.name = "Head", .classes = {1, 2}, .correct = {}, .visible = {}}};
  data.manifest = "{}";
  data.pose_priors = {{{0, 0, 0}, {0.1F, 0, 0}, {0.02F}}};
  constexpr Eigen::Index kInputs = 64;  // that describe an object of one target, three classes
  data.refinement = {Eigen::RowVectorXf::Zero(kInputs),
                     Eigen::RowVectorXf::Ones(kInputs),
                     {{ossa::RowMatrix::Zero(kInputs, 4), Eigen::RowVectorXf::Constant(4, 0.5F)}}};
  data.relabelling = {std::vector<float>(2 * ossa::forest::kRadialBasisScales * 2, 0.25F),
                      {0.0F, 1.0F}};
  return ForestModel(data);
}

std::string WholeFile() {
  const std::string path = ossa::fuzz::ScratchPath("model");
  ossa::forest::WriteForestModel(path, SmallModel());
  return ossa::fuzz::TakeFile(path);
}

// The format of the model file at hand: its magic and version, after which the payload follows.
ossa::ContainerFormat FormatAtHand(const std::string& file) {
  ossa::ContainerFormat format;
  std::memcpy(format.magic.data(), file.data(), format.magic.size());
  constexpr size_t kVersionAt = 12;  // after the byte-order mark
  std::memcpy(&format.version, file.data() + kVersionAt, sizeof(format.version));
  format.what = "forest model";
  return format;
}

}  // namespace

std::vector<std::string> ossa::fuzz::Seeds() {
  const std::string file = WholeFile();
  const auto payload = ReadContainerBytes(std::as_bytes(std::span(file.data(), file.size())),
                                          "seed", FormatAtHand(file));
  return {std::string(reinterpret_cast<const char*>(payload.data()), payload.size())};
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const ossa::ContainerFormat format = FormatAtHand(WholeFile());
  const std::string path = ossa::fuzz::ScratchPath("input");
  ossa::WriteContainer(path, format, std::as_bytes(std::span(data, size)));
  const std::string file = ossa::fuzz::TakeFile(path);
  ossa::fuzz::ExpectValueOrOneLine([&] {
    const auto model =
        ossa::forest::ReadForestModel(std::as_bytes(std::span(file.data(), file.size())), "x.ossa");
    if (model.data().trees.empty() || model.class_count() < 2) abort();
  });
  return 0;
}
