#include <array>
#include <cstring>
#include <stdexcept>

#include "depth/base/checksummed_container.h"
#include "depth/base/compressed.h"
#include "depth/base/error.h"
#include "depth/base/naming_the_file.h"
#include "forest/each_tree_internal.h"
#include "forest/forest.h"
#include "forest/forest_file_internal.h"
#include "forest/prune.h"
#include "forest/trees/tree_codec_internal.h"

namespace ossa::forest {
namespace {

// Version 2 added pose priors and the confidences that depend on them; version 3 packs trees more
// compactly; version 4 added the refinement, version 5 the relabelling.
constexpr ContainerFormat kModelFormat{{'o', 's', 's', 'a', 'f', 'r', 's', 't'}, 5, "forest model"};
constexpr uint32_t kOldestVersion = 1;  // oldest readable version
// Constants: of the format (zstd levels) and bounds against damaged files.

constexpr int kCompressionLevel = 19;
constexpr int kQuickLevel = 3;

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
  writer->Put<uint32_t>(static_cast<uint32_t>(data.pose_priors.size()));
  for (const PosePrior& prior : data.pose_priors) {
    writer->PutVector(prior.mean_m);
    writer->PutVector(prior.loading_m);
    writer->PutVector(prior.noise_m);
  }
}

void GetAgreement(PayloadReader* reader, ForestData* data) {
  for (ProposalTarget& target : data->targets) {
    target.mode_noise_m = reader->Get<float>("target mode noise");
    target.fused = reader->Get<PlaceConfidence>("target confidence of fused places");
    target.apart = reader->Get<PlaceConfidence>("target confidence of modes apart");
  }
  const auto count = reader->Get<uint32_t>("number of pose priors");
  if (count > data->context_names.size()) reader->Fail("number of pose priors", "too many");
  for (uint32_t i = 0; i < count; ++i) {
    PosePrior prior;
    prior.mean_m = reader->GetVector<float>("pose prior means");
    prior.loading_m = reader->GetVector<float>("pose prior loadings");
    prior.noise_m = reader->GetVector<float>("pose prior noise");
    data->pose_priors.push_back(std::move(prior));
  }
}

// The elements of a matrix in memory order.
template <typename Matrix>
std::vector<float> ToVector(const Matrix& numbers) {
  return {numbers.data(), numbers.data() + numbers.size()};
}

Eigen::RowVectorXf ToRow(const std::vector<float>& numbers) {
  return Eigen::Map<const Eigen::RowVectorXf>(numbers.data(),
                                              static_cast<Eigen::Index>(numbers.size()));
}

void PutRefinement(PayloadWriter* writer, const Perceptron& refinement) {
  writer->PutVector(ToVector(refinement.input_mean));
  writer->PutVector(ToVector(refinement.input_scale));
  writer->Put<uint32_t>(static_cast<uint32_t>(refinement.layers.size()));
  for (const PerceptronLayer& layer : refinement.layers) {
    PutPlanes(writer, ToVector(layer.weight));
    writer->PutVector(ToVector(layer.bias));
  }
}

Perceptron GetRefinement(PayloadReader* reader) {
  Perceptron refinement;
  refinement.input_mean = ToRow(reader->GetVector<float>("refinement input means"));
  refinement.input_scale = ToRow(reader->GetVector<float>("refinement input scales"));
  const auto layers = reader->Get<uint32_t>("refinement layers");
  constexpr uint32_t kMost = 64;  // the model itself allows fewer
  if (layers > kMost) reader->Fail("refinement layers", "more than 64");
  Eigen::Index inputs = refinement.input_mean.size();
  for (uint32_t i = 0; i < layers; ++i) {
    const auto weight = GetPlanes<float>(reader, "refinement weights");
    PerceptronLayer& layer = refinement.layers.emplace_back();
    layer.bias = ToRow(reader->GetVector<float>("refinement biases"));
    const Eigen::Index outputs = layer.bias.size();
    if (weight.size() != static_cast<size_t>(inputs) * static_cast<size_t>(outputs)) {
      reader->Fail("refinement weights", "a layer's weights do not match its inputs and outputs");
    }
    layer.weight = Eigen::Map<const RowMatrix>(weight.data(), inputs, outputs);
    inputs = outputs;
  }
  return refinement;
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
  target.correct = reader->Get<ModeConfidence>("target confidence");
  target.visible = reader->Get<ModeConfidence>("target visibility");
  return target;
}

// Reads the trees, in parallel for current files: they are most of a file.
std::vector<Tree> GetTrees(PayloadReader* reader, uint32_t count, uint32_t version) {
  std::vector<Tree> trees;
  std::vector<PayloadReader> at;
  for (uint32_t i = 0; i < count; ++i) {
    if (version < 3) {
      trees.push_back(GetTreeOfVersion2(reader));
      continue;
    }
    at.push_back(*reader);
    SkipTree(reader);
  }
  trees.resize(count);
  ForEachTree(at.size(), [&](size_t t) { trees[t] = GetTree(&at[t]); });
  return trees;
}

ForestData ParseVersion(std::span<const std::byte> payload, const std::string& name,
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
  data.trees = GetTrees(&reader, trees, version);
  if (version >= 2) GetAgreement(&reader, &data);
  if (version >= 4) data.refinement = GetRefinement(&reader);
  if (version >= 5) {
    data.relabelling.weight = GetPlanes<float>(&reader, "relabelling weights");
    data.relabelling.bias = reader.GetVector<float>("relabelling biases");
  }
  reader.ExpectEnd();
  return data;
}

// Frees each representation early: a model takes some 60 MB in each of them.
ForestModel Parse(std::vector<std::byte> compressed, const std::string& name, uint32_t version,
                  ModelUse use) {
  std::vector<std::byte> payload = Decompress(compressed, name, kModelFormat.what);
  std::vector<std::byte>().swap(compressed);
  const std::string where = name + " (unpacked)";
  ForestData data = ParseVersion(payload, where, version);
  std::vector<std::byte>().swap(payload);
  return ForestModel(std::move(data), where, use);
}

std::vector<std::byte> Packed(const ForestData& data, int level) {
  return Compress(PackForest(data, data.trees), level);
}

}  // namespace

std::vector<std::byte> PackForest(const ForestData& data, std::span<const Tree> trees) {
  PayloadWriter writer;
  writer.PutString(data.manifest);
  PutNames(&writer, data.class_names);
  PutNames(&writer, data.context_names);
  writer.PutVector(data.context_prior);
  writer.Put(data.evidence_scale);
  writer.Put(data.background_mm);
  writer.Put<uint32_t>(static_cast<uint32_t>(data.targets.size()));
  for (const ProposalTarget& target : data.targets) PutTarget(&writer, target);
  writer.Put<uint32_t>(static_cast<uint32_t>(trees.size()));
  for (const Tree& tree : trees) PutTree(&writer, tree);
  PutAgreement(&writer, data);
  PutRefinement(&writer, data.refinement);
  PutPlanes(&writer, data.relabelling.weight);
  writer.PutVector(data.relabelling.bias);
  return {writer.bytes().begin(), writer.bytes().end()};
}

ForestData ParseForest(std::span<const std::byte> payload, const std::string& name) {
  return ParseVersion(payload, name, kModelFormat.version);
}

ForestModel ReadForestModel(const std::filesystem::path& path, ModelUse use) {
  const ContainerFormat format = ReadContainerFormat(path, kModelFormat, kOldestVersion);
  return NamingTheFile(
      path, [&] { return Parse(ReadContainer(path, format), path.string(), format.version, use); });
}

ForestModel ReadForestModel(std::span<const std::byte> bytes, const std::string& name) {
  const ContainerFormat format = ReadContainerFormat(bytes, kModelFormat, kOldestVersion);
  return Parse(ReadContainerBytes(bytes, name, format), name, format.version, ModelUse::kAny);
}

bool IsForestModel(const std::filesystem::path& path) { return IsContainer(path, kModelFormat); }

void WriteForestModel(const std::filesystem::path& path, const ForestModel& model) {
  const Tree& first = model.data().trees.front();
  if (first.entry_begin.empty()) throw std::logic_error("a model to run only cannot be written");
  WriteContainer(path, kModelFormat, Packed(model.data(), kCompressionLevel));
}

uint64_t FileSize(const ForestData& data, Packing packing) {
  // Of a checksummed container: magic, version, checksum, length
  constexpr uint64_t kContainerHeader = 40;
  const bool tight = packing == Packing::kFile;
  return Packed(data, tight ? kCompressionLevel : kQuickLevel).size() + kContainerHeader;
}

}  // namespace ossa::forest
