#include <zstd.h>

#include <array>
#include <cstring>
#include <fstream>

#include "depth/error.h"
#include "depth/file/sealed_file.h"
#include "forest/compact.h"
#include "forest/forest.h"

namespace ossa::forest {
namespace {

// Version 2 added arrangements and what agreement with them says; models of version 1 lack them.
constexpr SealedFormat kFormat{{'o', 's', 's', 'a', 'f', 'r', 's', 't'}, 2, "forest model"};
constexpr size_t kVersionAt = 12;  // of a sealed file
constexpr int kCompressionLevel = 19;
constexpr int kQuickLevel = 3;
constexpr uint64_t kMaxUnpacked = uint64_t{1} << 31U;

void PutNames(PayloadWriter* writer, const std::vector<std::string>& names) {
  writer->Put<uint32_t>(static_cast<uint32_t>(names.size()));
  for (const std::string& name : names) writer->PutString(name);
}

std::vector<std::string> GetNames(PayloadReader* reader, std::string_view field) {
  const auto count = reader->Get<uint32_t>(field);
  if (count > 255) reader->Fail(field, "more than 255");
  std::vector<std::string> names;
  for (uint32_t i = 0; i < count; ++i) names.push_back(reader->GetString(field));
  return names;
}

void PutTarget(PayloadWriter* writer, const ProposalTarget& target) {
  writer->PutString(target.name);
  writer->PutVector(target.classes);
  writer->Put(std::array{target.bandwidth_m, target.probability_threshold, target.push_back_m,
                         target.class_weight, target.vote_radius_m, target.vote_sharpness_m,
                         target.tracked_confidence, target.inferred_confidence});
  writer->Put(target.correct);
  writer->Put(target.visible);
}

void PutAgreement(PayloadWriter* writer, const ForestData& data) {
  for (const ProposalTarget& target : data.targets) {
    writer->Put(target.mode_noise_m);
    writer->Put(target.fused);
    writer->Put(target.apart);
  }
  writer->Put<uint32_t>(static_cast<uint32_t>(data.arrangements.size()));
  for (const Arrangement& arrangement : data.arrangements) {
    writer->PutVector(arrangement.mean_m);
    writer->PutVector(arrangement.loading_m);
    writer->PutVector(arrangement.noise_m);
  }
}

void GetAgreement(PayloadReader* reader, ForestData* data) {
  for (ProposalTarget& target : data->targets) {
    target.mode_noise_m = reader->Get<float>("target mode noise");
    target.fused = reader->Get<Agreement>("target agreement");
    target.apart = reader->Get<Agreement>("target agreement of modes apart");
  }
  const auto count = reader->Get<uint32_t>("number of arrangements");
  if (count > data->context_names.size()) reader->Fail("number of arrangements", "too many");
  for (uint32_t i = 0; i < count; ++i) {
    Arrangement arrangement;
    arrangement.mean_m = reader->GetVector<float>("arrangement means");
    arrangement.loading_m = reader->GetVector<float>("arrangement loadings");
    arrangement.noise_m = reader->GetVector<float>("arrangement noise");
    data->arrangements.push_back(std::move(arrangement));
  }
}

ProposalTarget GetTarget(PayloadReader* reader) {
  ProposalTarget target;
  target.name = reader->GetString("target name");
  target.classes = reader->GetVector<uint8_t>("target classes");
  const auto numbers = reader->Get<std::array<float, 8>>("target parameters");
  target.bandwidth_m = numbers[0];
  target.probability_threshold = numbers[1];
  target.push_back_m = numbers[2];
  target.class_weight = numbers[3];
  target.vote_radius_m = numbers[4];
  target.vote_sharpness_m = numbers[5];
  target.tracked_confidence = numbers[6];
  target.inferred_confidence = numbers[7];
  target.correct = reader->Get<Confidence>("target confidence");
  target.visible = reader->Get<Confidence>("target visibility");
  return target;
}

// Arrays of one kind side by side compress better than nodes one after another.
void PutTree(PayloadWriter* writer, const Tree& tree) {
  std::vector<int16_t> columns[5];
  std::vector<uint8_t> is_leaf;
  std::vector<int32_t> leaf_number;
  for (const Node& node : tree.nodes) {
    is_leaf.push_back(node.is_leaf() ? 1 : 0);
    if (node.is_leaf()) {
      leaf_number.push_back(node.leaf());
      continue;
    }
    const int16_t fields[5] = {node.u[0], node.u[1], node.v[0], node.v[1], node.threshold_mm};
    for (size_t i = 0; i < 5; ++i) columns[i].push_back(fields[i]);
  }
  writer->PutVector(is_leaf);
  writer->PutVector(leaf_number);
  for (const auto& column : columns) writer->PutVector(column);
  std::vector<uint16_t> entry_count;
  for (size_t i = 0; i < tree.leaf_count(); ++i) {
    entry_count.push_back(static_cast<uint16_t>(tree.entry_begin[i + 1] - tree.entry_begin[i]));
  }
  writer->PutVector(entry_count);
  writer->PutVector(tree.entries);
  writer->Put(tree.vote_depth);
  writer->PutVector(tree.votes);
}

Tree GetTree(PayloadReader* reader) {
  const auto is_leaf = reader->GetVector<uint8_t>("nodes");
  const auto leaf_number = reader->GetVector<int32_t>("leaf numbers");
  std::vector<int16_t> columns[5];
  for (auto& column : columns) column = reader->GetVector<int16_t>("node parameters");
  Tree tree;
  size_t inner = 0;
  size_t leaf = 0;
  for (const uint8_t kind : is_leaf) {
    Node node;
    if (kind != 0) {
      if (leaf >= leaf_number.size()) reader->Fail("leaf numbers", "fewer than leaves");
      if (leaf_number[leaf] < 0) reader->Fail("leaf numbers", "a negative number");
      node.left = ~leaf_number[leaf++];
    } else {
      for (const auto& column : columns) {
        if (inner >= column.size()) reader->Fail("node parameters", "fewer than nodes");
      }
      node.u = {columns[0][inner], columns[1][inner]};
      node.v = {columns[2][inner], columns[3][inner]};
      node.threshold_mm = columns[4][inner];
      node.left = static_cast<int32_t>(1 + 2 * inner++);
    }
    tree.nodes.push_back(node);
  }
  tree.entry_begin.push_back(0);
  for (const uint16_t count : reader->GetVector<uint16_t>("leaf entry counts")) {
    tree.entry_begin.push_back(tree.entry_begin.back() + count);
  }
  tree.entries = reader->GetVector<uint16_t>("leaf entries");
  tree.vote_depth = reader->Get<int32_t>("vote depth");
  tree.votes = reader->GetVector<Vote>("votes");
  return tree;
}

std::vector<std::byte> Compressed(const std::vector<std::byte>& bytes, int level) {
  std::vector<std::byte> out(ZSTD_compressBound(bytes.size()));
  const size_t size = ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), level);
  out.resize(size);
  return out;
}

std::vector<std::byte> Decompressed(const std::vector<std::byte>& bytes, uint64_t size,
                                    const std::string& name) {
  // zstd stores at most about 1 : 2^17; a larger claim is a lie, refused before allocating.
  if (size > kMaxUnpacked || size / (uint64_t{1} << 18U) > bytes.size()) {
    throw InputError(name + ": byte 32: unpacked length: " + std::to_string(size) +
                     " is more than the file can hold");
  }
  std::vector<std::byte> out(size);
  const size_t got = ZSTD_decompress(out.data(), out.size(), bytes.data(), bytes.size());
  if (ZSTD_isError(got) != 0 || got != size) {
    throw InputError(name + ": byte 40: compressed payload: the forest model is damaged");
  }
  return out;
}

ForestData ParseForest(std::span<const std::byte> payload, const std::string& name,
                       uint32_t version) {
  PayloadReader reader(payload, name);
  ForestData data;
  data.manifest = reader.GetString("manifest");
  data.class_names = GetNames(&reader, "class names");
  data.context_names = GetNames(&reader, "context names");
  data.context_prior = reader.GetVector<float>("context prior");
  data.evidence_scale = reader.Get<float>("evidence scale");
  data.background_mm = reader.Get<uint16_t>("background depth");
  const auto targets = reader.Get<uint32_t>("number of targets");
  for (uint32_t i = 0; i < targets; ++i) data.targets.push_back(GetTarget(&reader));
  const auto trees = reader.Get<uint32_t>("number of trees");
  for (uint32_t i = 0; i < trees; ++i) data.trees.push_back(GetTree(&reader));
  if (version >= 2) GetAgreement(&reader, &data);
  reader.ExpectEnd();
  return data;
}

// The format to expect of a file that starts so: version 1 is still read.
SealedFormat FormatOf(std::span<const std::byte> head) {
  SealedFormat format = kFormat;
  uint32_t version = 0;
  if (head.size() < kVersionAt + sizeof(version)) return format;
  std::memcpy(&version, head.data() + kVersionAt, sizeof(version));
  if (version == 1) format.version = version;
  return format;
}

std::vector<std::byte> Unpacked(const std::vector<std::byte>& sealed, const std::string& name) {
  PayloadReader outer(sealed, name);
  const auto size = outer.Get<uint64_t>("unpacked length");
  const auto packed = outer.GetVector<std::byte>("compressed payload");
  outer.ExpectEnd();
  return Decompressed(packed, size, name);
}

// Each form is let go before the next but one is made: a model is some 60 MB in each of them.
ForestModel Parse(std::vector<std::byte> sealed, const std::string& name, uint32_t version) {
  std::vector<std::byte> payload = Unpacked(sealed, name);
  std::vector<std::byte>().swap(sealed);
  const std::string where = name + " (unpacked)";
  ForestData data = ParseForest(payload, where, version);
  std::vector<std::byte>().swap(payload);
  return ForestModel(std::move(data), where);
}

std::vector<std::byte> Packed(const ForestData& data, int level) {
  PayloadWriter writer;
  writer.PutString(data.manifest);
  PutNames(&writer, data.class_names);
  PutNames(&writer, data.context_names);
  writer.PutVector(data.context_prior);
  writer.Put(data.evidence_scale);
  writer.Put(data.background_mm);
  writer.Put<uint32_t>(static_cast<uint32_t>(data.targets.size()));
  for (const ProposalTarget& target : data.targets) PutTarget(&writer, target);
  writer.Put<uint32_t>(static_cast<uint32_t>(data.trees.size()));
  for (const Tree& tree : data.trees) PutTree(&writer, tree);
  PutAgreement(&writer, data);
  PayloadWriter outer;
  outer.Put<uint64_t>(writer.bytes().size());
  outer.PutVector(Compressed(writer.bytes(), level));
  return outer.bytes();
}

}  // namespace

ForestModel ReadForestModel(const std::filesystem::path& path) {
  std::array<char, kVersionAt + sizeof(uint32_t)> head{};
  std::ifstream(path, std::ios::binary).read(head.data(), head.size());
  const SealedFormat format = FormatOf(std::as_bytes(std::span(head)));
  return Parse(ReadSealedFile(path, format), path.string(), format.version);
}

ForestModel ReadForestModel(std::span<const std::byte> bytes, const std::string& name) {
  const SealedFormat format = FormatOf(bytes);
  return Parse(OpenSealedBytes(bytes, name, format), name, format.version);
}

bool IsForestModel(const std::filesystem::path& path) { return IsSealedFile(path, kFormat); }

void WriteForestModel(const std::filesystem::path& path, const ForestModel& model) {
  WriteSealedFile(path, kFormat, Packed(model.data(), kCompressionLevel));
}

uint64_t FileSize(const ForestData& data, Packing packing) {
  constexpr uint64_t kSeal = 40;  // of a sealed file: magic, version, checksum, length
  const bool tight = packing == Packing::kFile;
  return Packed(data, tight ? kCompressionLevel : kQuickLevel).size() + kSeal;
}

}  // namespace ossa::forest
