// Below the uppermost levels each step of a walk meets a node that is in no near cache. Two pairs
// of children fit a line: the second is that of the child which more leaves lie below, so that of
// two steps the second often costs nothing.
#include <cstdint>

#include "forest/runtime_internal.h"

namespace ossa::forest {
namespace {

constexpr int32_t kNowhere = -1;
constexpr int32_t kLine = static_cast<int32_t>(sizeof(NodeLine) / sizeof(Node));
static_assert(kLine == 4);

std::vector<int32_t> LeavesBelow(const std::vector<Node>& nodes) {
  std::vector<int32_t> leaves(nodes.size(), 1);
  for (size_t i = nodes.size(); i-- > 0;) {  // children stand behind their parents
    if (nodes[i].is_leaf()) continue;
    const auto left = static_cast<size_t>(nodes[i].left);
    leaves[i] = leaves[left] + leaves[left + 1];
  }
  return leaves;
}

// Finds each node's new place. Pairs are named by their left node.
class Placer {
 public:
  explicit Placer(const std::vector<Node>& nodes)
      : place(nodes.size(), kNowhere), nodes_(nodes), leaves_(LeavesBelow(nodes)) {
    place[0] = 0;
    waiting_.reserve(nodes.size() / 2);
    PushPairBelow(0);
    for (size_t i = 0; i < waiting_.size(); ++i) PlaceLine(waiting_[i]);
  }

  std::vector<int32_t> place;
  int32_t lines() const { return end_ / kLine; }

 private:
  void PushPairBelow(int32_t node) {
    const int32_t left = nodes_[static_cast<size_t>(node)].left;
    if (left >= 0) waiting_.push_back(left);
  }

  void PlacePair(int32_t left, int32_t at) {
    place[static_cast<size_t>(left)] = at;
    place[static_cast<size_t>(left) + 1] = at + 1;
  }

  // The pair, and with it the pair below the heavier of its nodes.
  void PlaceLine(int32_t pair) {
    const auto weight = [&](int32_t node) { return leaves_[static_cast<size_t>(node)]; };
    const int32_t heavier = weight(pair) >= weight(pair + 1) ? pair : pair + 1;
    const int32_t below = nodes_[static_cast<size_t>(heavier)].left;
    if (below < 0) return PlaceTwoLeaves(pair);
    PlacePair(pair, end_);
    PlacePair(below, end_ + 2);
    end_ += kLine;
    PushPairBelow(heavier == pair ? pair + 1 : pair);
    PushPairBelow(below);
    PushPairBelow(below + 1);
  }

  // Nothing is below: two such pairs share a line.
  void PlaceTwoLeaves(int32_t pair) {
    if (half_line_ == kNowhere) {
      PlacePair(pair, end_);
      half_line_ = end_ + 2;
      end_ += kLine;
    } else {
      PlacePair(pair, half_line_);
      half_line_ = kNowhere;
    }
  }

  const std::vector<Node>& nodes_;
  std::vector<int32_t> leaves_;
  std::vector<int32_t> waiting_;  // pairs; those before the one at hand are placed
  int32_t end_ = kLine;           // the root has a line of its own
  int32_t half_line_ = kNowhere;  // the free half of a line of leaves
};

}  // namespace

std::vector<NodeLine> LayOutInLines(const std::vector<Node>& nodes) {
  const Placer placer(nodes);
  std::vector<NodeLine> lines(static_cast<size_t>(placer.lines()));
  for (size_t i = 0; i < nodes.size(); ++i) {
    const auto at = static_cast<size_t>(placer.place[i]);
    Node& node = lines[at / kLine].node[at % kLine];
    node = nodes[i];
    if (!node.is_leaf()) node.left = placer.place[static_cast<size_t>(node.left)];
  }
  return lines;
}

}  // namespace ossa::forest
