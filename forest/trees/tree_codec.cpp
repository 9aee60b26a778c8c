// Trees are stored in columns. Numbers of one kind compress better together than node by node, even
// better split into byte planes, and what follows from the order (children, leaf numbers) is not
// stored: a tree takes two thirds of the bytes of version 2.
#include "forest/trees/tree_codec_internal.h"

#include <algorithm>
#include <array>

namespace ossa::forest {
namespace {

// Constants: of the format.

constexpr unsigned kCodeBits = 9;  // of an entry; the weight is in the bits above
constexpr unsigned kCodes = 1U << kCodeBits;
constexpr size_t kNodeColumns = 5;

struct NodeColumns {
  std::vector<uint8_t> is_leaf;
  std::array<std::vector<int16_t>, kNodeColumns> inner;  // u, v, threshold of inner nodes
};

NodeColumns MakeColumns(const std::vector<Node>& nodes) {
  NodeColumns columns;
  for (const Node& node : nodes) {
    columns.is_leaf.push_back(node.is_leaf() ? 1 : 0);
    if (node.is_leaf()) continue;
    const int16_t fields[kNodeColumns] = {node.u[0], node.u[1], node.v[0], node.v[1],
                                          node.threshold_mm};
    for (size_t i = 0; i < kNodeColumns; ++i) columns.inner[i].push_back(fields[i]);
  }
  return columns;
}

// A view of 16-bit numbers stored as byte planes by PutPlanes.
template <typename T>
class Planes {
 public:
  Planes(PayloadReader* reader, std::string_view field)
      : first_(reader->GetBytes(field)), second_(reader->GetBytes(field)) {
    if (first_.size() != second_.size()) reader->Fail(field, "uneven planes of bytes");
  }
  size_t size() const { return first_.size(); }
  T operator[](size_t i) const {
    return static_cast<T>(first_.data()[i] | unsigned{second_.data()[i]} << 8U);
  }

 private:
  std::span<const uint8_t> first_, second_;
};

// Visits nodes breadth-first: the n-th inner node has children 1 + 2n and 2 + 2n, the n-th leaf
// number n.
template <typename Column>
std::vector<Node> DecodeNodes(std::span<const uint8_t> is_leaf,
                              const std::vector<Column>& parameters, const PayloadReader& reader) {
  std::vector<Node> nodes;
  nodes.reserve(is_leaf.size());
  size_t inner = 0;
  int32_t leaf = 0;
  for (const auto& column : parameters) {
    if (column.size() != parameters[0].size()) reader.Fail("node parameters", "uneven columns");
  }
  if (is_leaf.size() != 2 * parameters[0].size() + 1) {
    reader.Fail("node parameters", "expected one set for two nodes but the root");
  }
  for (const uint8_t kind : is_leaf) {
    Node node;
    if (kind != 0) {
      node.left = ~leaf++;
    } else {
      if (inner >= parameters[0].size()) reader.Fail("node parameters", "fewer than nodes");
      node.u = {parameters[0][inner], parameters[1][inner]};
      node.v = {parameters[2][inner], parameters[3][inner]};
      node.threshold_mm = parameters[4][inner];
      node.left = static_cast<int32_t>(1 + 2 * inner++);
    }
    nodes.push_back(node);
  }
  return nodes;
}

// Entries of a leaf sorted by code, each code as the difference from the previous one.
void PutLeaves(PayloadWriter* writer, const Tree& tree) {
  std::vector<uint16_t> counts;
  std::vector<uint16_t> steps;
  std::vector<uint8_t> weights;
  for (size_t leaf = 0; leaf < tree.leaf_count(); ++leaf) {
    std::vector<uint16_t> entries(tree.entries.begin() + tree.entry_begin[leaf],
                                  tree.entries.begin() + tree.entry_begin[leaf + 1]);
    std::sort(entries.begin(), entries.end(),
              [](uint16_t a, uint16_t b) { return a % kCodes < b % kCodes; });
    counts.push_back(static_cast<uint16_t>(entries.size()));
    unsigned before = 0;
    for (const uint16_t entry : entries) {
      steps.push_back(static_cast<uint16_t>(entry % kCodes - before));
      weights.push_back(static_cast<uint8_t>(entry >> kCodeBits));
      before = entry % kCodes;
    }
  }
  PutPlanes(writer, counts);
  PutPlanes(writer, steps);
  writer->PutVector(weights);
}

void GetLeaves(PayloadReader* reader, Tree* tree) {
  const Planes<uint16_t> counts(reader, "leaf entry counts");
  const Planes<uint16_t> steps(reader, "leaf entry codes");
  const std::span<const uint8_t> weights = reader->GetBytes("leaf entry weights");
  if (steps.size() != weights.size()) reader->Fail("leaf entry weights", "not one a code");
  tree->entries.reserve(steps.size());
  tree->entry_begin.reserve(counts.size() + 1);
  tree->entry_begin.push_back(0);
  for (size_t leaf = 0; leaf < counts.size(); ++leaf) {
    const uint16_t count = counts[leaf];
    if (count > steps.size() - tree->entries.size()) reader->Fail("leaf entries", "too few");
    unsigned code = 0;
    for (uint16_t i = 0; i < count; ++i) {
      const size_t at = tree->entries.size();
      code += steps[at];
      if (code >= kCodes || weights[at] > 127) reader->Fail("leaf entry", "code or weight unknown");
      tree->entries.push_back(static_cast<uint16_t>(unsigned{weights[at]} << kCodeBits | code));
    }
    tree->entry_begin.push_back(static_cast<uint32_t>(tree->entries.size()));
  }
  if (tree->entries.size() != steps.size()) reader->Fail("leaf entries", "more than counted");
}

}  // namespace

void PutTree(PayloadWriter* writer, const Tree& tree) {
  const NodeColumns columns = MakeColumns(tree.nodes);
  writer->PutVector(columns.is_leaf);
  for (const auto& column : columns.inner) PutPlanes(writer, column);
  PutLeaves(writer, tree);
  writer->Put(tree.vote_depth);
  PutPlanes(writer, tree.votes);
}

Tree GetTree(PayloadReader* reader) {
  const std::span<const uint8_t> is_leaf = reader->GetBytes("nodes");
  std::vector<Planes<int16_t>> parameters;
  while (parameters.size() < kNodeColumns) parameters.emplace_back(reader, "node parameters");
  Tree tree;
  tree.nodes = DecodeNodes(is_leaf, parameters, *reader);
  GetLeaves(reader, &tree);
  tree.vote_depth = reader->Get<int32_t>("vote depth");
  tree.votes = GetPlanes<Vote>(reader, "votes");
  return tree;
}

void SkipTree(PayloadReader* reader) {
  const auto skip = [&](size_t planes, std::string_view field) {
    for (size_t i = 0; i < planes; ++i) reader->GetBytes(field);
  };
  skip(1, "nodes");
  skip(kNodeColumns * sizeof(int16_t), "node parameters");
  skip(sizeof(uint16_t), "leaf entry counts");
  skip(sizeof(uint16_t), "leaf entry codes");
  skip(1, "leaf entry weights");
  reader->Get<int32_t>("vote depth");
  skip(sizeof(Vote), "votes");
}

Tree GetTreeOfVersion2(PayloadReader* reader) {
  const std::span<const uint8_t> is_leaf = reader->GetBytes("nodes");
  reader->GetVector<int32_t>("leaf numbers");  // implied by breadth-first order
  std::vector<std::vector<int16_t>> parameters(kNodeColumns);
  for (auto& column : parameters) column = reader->GetVector<int16_t>("node parameters");
  Tree tree;
  tree.nodes = DecodeNodes(is_leaf, parameters, *reader);
  tree.entry_begin.push_back(0);
  for (const uint16_t count : reader->GetVector<uint16_t>("leaf entry counts")) {
    tree.entry_begin.push_back(tree.entry_begin.back() + count);
  }
  tree.entries = reader->GetVector<uint16_t>("leaf entries");
  tree.vote_depth = reader->Get<int32_t>("vote depth");
  tree.votes = reader->GetVector<Vote>("votes");
  return tree;
}

}  // namespace ossa::forest
