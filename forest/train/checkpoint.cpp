#include "forest/train/checkpoint_internal.h"

#include "depth/error.h"
#include "depth/file/sealed_file.h"

namespace ossa::forest {
namespace {

constexpr SealedFormat kFormat{{'o', 's', 's', 'a', 'c', 'h', 'k', 'p'}, 1, "training checkpoint"};

void CheckNodes(const std::vector<Node>& nodes, size_t frontier, const PayloadReader& reader) {
  size_t next = 1;
  for (size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].left < 0) continue;
    if (i >= frontier || static_cast<size_t>(nodes[i].left) != next) {
      reader.Fail("nodes", "not in breadth-first order");
    }
    next += 2;
  }
  if (next != nodes.size() || frontier > nodes.size()) reader.Fail("nodes", "wrong number");
}

}  // namespace

void WriteCheckpoint(const std::filesystem::path& path, const Checkpoint& checkpoint) {
  PayloadWriter writer;
  writer.PutString(checkpoint.fingerprint);
  writer.Put<uint32_t>(static_cast<uint32_t>(checkpoint.finished.size()));
  for (const auto& nodes : checkpoint.finished) writer.PutVector(nodes);
  writer.Put<int32_t>(checkpoint.growing.level);
  writer.Put<uint64_t>(checkpoint.growing.frontier_begin);
  writer.PutVector(checkpoint.growing.nodes);
  WriteSealedFile(path, kFormat, writer.bytes());
}

Checkpoint ReadCheckpoint(const std::filesystem::path& path, const std::string& fingerprint) {
  const std::vector<std::byte> payload = ReadSealedFile(path, kFormat);
  PayloadReader reader(payload, path.string());
  Checkpoint checkpoint;
  checkpoint.fingerprint = reader.GetString("fingerprint");
  if (checkpoint.fingerprint != fingerprint) {
    throw InputError(path.string() +
                     ": checkpoint of another run: expected the same data sets and options (" +
                     fingerprint + "), found " + checkpoint.fingerprint);
  }
  const auto finished = reader.Get<uint32_t>("number of trees");
  if (finished > 64) reader.Fail("number of trees", "more than 64");
  for (uint32_t i = 0; i < finished; ++i) {
    checkpoint.finished.push_back(reader.GetVector<Node>("nodes"));
    CheckNodes(checkpoint.finished.back(), checkpoint.finished.back().size(), reader);
  }
  checkpoint.growing.level = reader.Get<int32_t>("level");
  checkpoint.growing.frontier_begin = reader.Get<uint64_t>("frontier");
  checkpoint.growing.nodes = reader.GetVector<Node>("nodes");
  CheckNodes(checkpoint.growing.nodes, checkpoint.growing.frontier_begin, reader);
  reader.ExpectEnd();
  return checkpoint;
}

}  // namespace ossa::forest
