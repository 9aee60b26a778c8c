// Below the top levels, each step of a walk is a cache miss. Three levels of 8-byte nodes fit into
// one cache line, which saves two of three misses. Levels are grouped from the bottom, so that the
// lowest levels, with most nodes, fill their lines.
#include "forest/trees/node_lines_internal.h"

#include <algorithm>
#include <cstdlib>
#include <numeric>

namespace ossa::forest {
namespace {

// Constants: of cache lines.

// Number of inner nodes per level.
std::vector<size_t> InnerNodes(const std::vector<Node>& nodes) {
  std::vector<size_t> count;
  std::vector<uint32_t> level(nodes.size(), 0);
  for (size_t i = 0; i < nodes.size(); ++i) {  // parents come before their children
    if (nodes[i].is_leaf()) continue;
    const auto left = static_cast<size_t>(nodes[i].left);
    level[left] = level[left + 1] = level[i] + 1;
    if (level[i] == count.size()) count.push_back(0);
    ++count[level[i]];
  }
  return count;
}

// The smallest step that divides all offsets such that the quotients fit; else the smallest for
// which they fit after rounding.
int OffsetStep(const std::vector<Node>& nodes) {
  int largest = 0;
  int common = 0;
  for (const Node& node : nodes) {
    if (node.is_leaf()) continue;
    for (const int offset : {node.u[0], node.u[1], node.v[0], node.v[1]}) {
      largest = std::max(largest, std::abs(offset));
      common = std::gcd(common, offset);
    }
  }
  const int least = std::max(1, (largest + kMostPackedOffset - 1) / kMostPackedOffset);
  for (int step = least; step <= common; ++step) {
    if (common % step == 0) return step;
  }
  return least;
}

uint16_t PackWord(int offset, int offset_step, int piece) {
  const int half = offset < 0 ? -offset_step : offset_step;  // rounds away from 0, as std::lround
  const int steps = (2 * offset + half) / (2 * offset_step);
  return static_cast<uint16_t>(steps * 16 | (piece & 15));
}

PackedNode Pack(const Node& node, int offset_step) {
  const int threshold = node.threshold_mm;
  return {{PackWord(node.u[0], offset_step, threshold),
           PackWord(node.u[1], offset_step, threshold >> 8),
           PackWord(node.v[0], offset_step, threshold >> 4),
           PackWord(node.v[1], offset_step, threshold >> 12)}};
}

class Placer {
 public:
  explicit Placer(const std::vector<Node>& nodes) : nodes_(nodes.data()) {
    tree.offset_step = OffsetStep(nodes);
    const std::vector<size_t> inner = InnerNodes(nodes);
    const size_t above = (kLevelsOfLine - inner.size() % kLevelsOfLine) % kLevelsOfLine;
    size_t lines = 1;
    for (size_t l = kLevelsOfLine - above; l < inner.size(); l += kLevelsOfLine) lines += inner[l];
    tree.lines.reserve(lines);
    tree.first_node = (1 << above) - 1;
    PlaceLine(0, static_cast<size_t>(tree.first_node));
    for (size_t i = 0; i < waiting_.size(); ++i) PlaceLine(waiting_[i], 0);
  }

  LinedTree tree;

 private:
  static constexpr size_t kNodes = 7;

  // Places the line whose root is this node of the tree.
  void PlaceLine(int32_t root, size_t at) {
    std::array<int32_t, kNodes + kExitsOfLine> places;  // nodes, and exits
    places.fill(kNowhere);
    int32_t* node = places.data();  // tree node at each position
    node[at] = root;
    NodeLine line;
    for (size_t i = at; i < kNodes; ++i) {
      if (node[i] == kNowhere) continue;
      const Node& here = nodes_[static_cast<size_t>(node[i])];
      if (here.is_leaf()) {  // padding nodes go left
        node[2 * i + 1] = node[i];
        continue;
      }
      line.node[i] = Pack(here, tree.offset_step);
      node[2 * i + 1] = here.left;
      node[2 * i + 2] = here.left + 1;
    }
    line.lines = static_cast<uint32_t>(waiting_.size() + 1) << 8U;
    line.leaves = static_cast<uint32_t>(tree.leaf.size()) << 8U;
    for (uint32_t way = 0; way < kExitsOfLine; ++way) Leave(node[kNodes + way], 1U << way, &line);
    tree.lines.push_back(line);
  }

  void Leave(int32_t node, uint32_t way, NodeLine* line) {
    if (node == kNowhere) return;
    const Node& below = nodes_[static_cast<size_t>(node)];
    if (below.is_leaf()) {
      line->leaves |= way;
      tree.leaf.push_back(below.leaf());
    } else {
      line->lines |= way;
      waiting_.push_back(node);
    }
  }

  static constexpr int32_t kNowhere = -1;
  const Node* nodes_;
  std::vector<int32_t> waiting_;  // roots of further lines; those before the current one
                                  // are placed
};

}  // namespace

LinedTree LayOutInLines(const std::vector<Node>& nodes) { return Placer(nodes).tree; }

}  // namespace ossa::forest
