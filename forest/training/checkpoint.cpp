#include "forest/training/checkpoint_internal.h"

#include <algorithm>

#include "depth/base/checksummed_container.h"
#include "depth/base/error.h"

namespace ossa::forest {
namespace {

constexpr ContainerFormat kCheckpointFormat{
    {'o', 's', 's', 'a', 'c', 'h', 'k', 'p'}, 2, "training checkpoint"};

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

std::vector<Setting> ReadSettings(PayloadReader& reader) {
  const auto count = reader.Get<uint32_t>("number of settings");
  if (count > 64) reader.Fail("number of settings", "more than 64");
  std::vector<Setting> settings;
  for (uint32_t i = 0; i < count; ++i) {
    std::string name = reader.GetString("setting");
    settings.push_back({std::move(name), reader.GetString("setting's value")});
  }
  return settings;
}

void CheckSameRun(const std::vector<Setting>& found, const std::vector<Setting>& expected,
                  const std::filesystem::path& path) {
  for (const Setting& setting : expected) {
    const auto same = std::ranges::find(found, setting.name, &Setting::name);
    const std::string value = same == found.end() ? "none" : same->value;
    if (value == setting.value) continue;
    throw InputError(path.string() + ": checkpoint of another run: " + setting.name +
                     ": expected " + setting.value + " as in this run, found " + value);
  }
}

}  // namespace

void WriteCheckpoint(const std::filesystem::path& path, const Checkpoint& checkpoint) {
  PayloadWriter writer;
  writer.Put<uint32_t>(static_cast<uint32_t>(checkpoint.settings.size()));
  for (const Setting& setting : checkpoint.settings) {
    writer.PutString(setting.name);
    writer.PutString(setting.value);
  }
  writer.Put<uint32_t>(static_cast<uint32_t>(checkpoint.finished.size()));
  for (const auto& nodes : checkpoint.finished) writer.PutVector(nodes);
  writer.Put<int32_t>(checkpoint.growing.level);
  writer.Put<uint64_t>(checkpoint.growing.frontier_begin);
  writer.PutVector(checkpoint.growing.nodes);
  WriteContainer(path, kCheckpointFormat, writer.bytes());
}

Checkpoint ReadCheckpoint(const std::filesystem::path& path, const std::vector<Setting>& settings) {
  const std::vector<std::byte> payload = ReadContainer(path, kCheckpointFormat);
  PayloadReader reader(payload, path.string());
  Checkpoint checkpoint;
  checkpoint.settings = ReadSettings(reader);
  CheckSameRun(checkpoint.settings, settings, path);
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
