#include "forest/import_pcl.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <fstream>
#include <sstream>

#include "depth/base/error.h"
#include "depth/base/open_file.h"

namespace ossa::forest {
namespace {

// Labels in the order of PCL's people module. Class = label + 1: 0 is background here.
constexpr std::array kPclNames = {
    "Lfoot", "Lleg",   "Lknee",  "Lthigh", "Rfoot",    "Rleg",   "Rknee", "Rthigh", "Rhips",
    "Lhips", "Neck",   "Rarm",   "Relbow", "Rforearm", "Rhand",  "Larm",  "Lelbow", "Lforearm",
    "Lhand", "FaceLB", "FaceRB", "FaceLT", "FaceRT",   "Rchest", "Lchest"};
// Constants: of PCL's format.

constexpr uint16_t kPclBackground_mm = 32767;
// PCL: offset in pixels = du · f / depth_mm, so du is in millimetres at any f; ours is in 1/16
// pixel·metre at f = 575.
constexpr double kUnitsPerPclOffset = kReferenceFocal_px * kOffsetUnitsPerPixelMetre * 1e-3;

struct PclNode {
  std::array<int, 4> offset{};
  int threshold_mm = 0;
};

struct PclTree {
  std::vector<PclNode> nodes;  // heap order
  std::vector<int> labels;
};

class Lines {
 public:
  explicit Lines(const std::filesystem::path& path) : path_(path), file_(OpenFile(path)) {
    if (!file_) throw InputError(path.string() + ": cannot be read: expected a PCL people tree");
  }
  // Reads the next line as integers.
  std::vector<int> Next(size_t count, const std::string& what) {
    ++line_;
    // Lines of a tree are not longer; another file may be one endless line.
    std::array<char, 128> line{};
    file_.getline(line.data(), line.size());
    const auto length = static_cast<size_t>(file_.gcount()) - (file_.good() ? 1 : 0);
    const std::string text(line.data(), length);
    std::istringstream words(text);
    std::vector<int> values;
    for (int value = 0; words >> value;) values.push_back(value);
    if (!file_.fail() && values.size() == count && words.eof()) return values;
    Fail("expected " + what + ", found '" + text.substr(0, 40) + "'");
  }
  [[noreturn]] void Fail(const std::string& reason) const {
    throw InputError(path_.string() + ": line " + std::to_string(line_) + ": " + reason);
  }

 private:
  std::filesystem::path path_;
  std::ifstream file_;
  size_t line_ = 0;
};

PclTree ReadPclTree(const std::filesystem::path& path) {
  Lines lines(path);
  const int depth = lines.Next(1, "the depth of a PCL people tree")[0];
  if (depth < 1 || depth > 24) lines.Fail("depth: expected 1 to 24");
  const size_t leaves = size_t{1} << static_cast<unsigned>(depth);
  PclTree tree;
  for (size_t i = 0; i + 1 < leaves; ++i) {
    const auto v = lines.Next(5, "a node of 5 whole numbers");
    tree.nodes.push_back({{v[0], v[1], v[2], v[3]}, v[4]});
  }
  for (size_t i = 0; i < leaves; ++i) {
    tree.labels.push_back(lines.Next(1, "the label of a leaf")[0]);
    const int label = tree.labels.back();
    if (label < 0 || label > 31) lines.Fail("label: expected 0 to 31");
  }
  return tree;
}

int16_t Clamped(double value) {
  return static_cast<int16_t>(std::lround(std::clamp(value, -32767.0, 32767.0)));
}

// The common label of all leaves below each heap node, if there is one: the node becomes a leaf.
std::vector<int> CommonLabels(const PclTree& tree) {
  const size_t inner = tree.nodes.size();
  std::vector<int> common(inner + tree.labels.size());
  std::copy(tree.labels.begin(), tree.labels.end(), common.begin() + static_cast<ptrdiff_t>(inner));
  for (size_t i = inner; i-- > 0;) {
    common[i] = common[2 * i + 1] == common[2 * i + 2] ? common[2 * i + 1] : -1;
  }
  return common;
}

Tree Convert(const PclTree& source) {
  const std::vector<int> common = CommonLabels(source);
  Tree tree;
  tree.entry_begin.push_back(0);
  std::deque<size_t> queue = {0};
  int32_t next_child = 1;
  while (!queue.empty()) {
    const size_t i = queue.front();
    queue.pop_front();
    Node node;
    if (common[i] >= 0) {
      node.left = ~static_cast<int32_t>(tree.leaf_count());
      // The unused labels 25 to 31 mean background in PCL: a leaf without entries.
      if (common[i] < static_cast<int>(kPclNames.size())) {
        tree.entries.push_back(
            static_cast<uint16_t>(127U << 9U | (static_cast<uint32_t>(common[i]) + 1U)));
      }
      tree.entry_begin.push_back(static_cast<uint32_t>(tree.entries.size()));
    } else {
      const auto& offset = source.nodes[i].offset;
      const auto scaled = [&](size_t k) { return Clamped(offset[k] * kUnitsPerPclOffset); };
      node.u = {scaled(0), scaled(1)};
      node.v = {scaled(2), scaled(3)};
      node.threshold_mm = Clamped(source.nodes[i].threshold_mm);
      node.left = next_child;
      next_child += 2;
      queue.push_back(2 * i + 1);
      queue.push_back(2 * i + 2);
    }
    tree.nodes.push_back(node);
  }
  return tree;
}

}  // namespace

ForestModel ImportPclTrees(const std::vector<std::filesystem::path>& paths) {
  ForestData data;
  data.class_names = {"background"};
  data.class_names.insert(data.class_names.end(), kPclNames.begin(), kPclNames.end());
  data.context_names = {"any"};
  data.context_prior = {1.0F};
  data.background_mm = kPclBackground_mm;
  for (const auto& path : paths) data.trees.push_back(Convert(ReadPclTree(path)));
  data.manifest = "{\"source\": \"Point Cloud Library people trees, BSD-3-Clause\"}";
  return ForestModel(std::move(data), paths.empty() ? "model" : paths.front().string());
}

}  // namespace ossa::forest
