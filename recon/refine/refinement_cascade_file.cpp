#include <fmt/format.h>

#include "depth/base/checksummed_container.h"
#include "depth/base/compressed.h"
#include "depth/base/naming_the_file.h"
#include "depth/base/perceptron/perceptron_file.h"
#include "recon/refine/bone_estimation.h"
#include "recon/refine/refinement_cascade.h"

namespace ossa::recon {
namespace {

constexpr ContainerFormat kFormat = {
    {'O', 'S', 'S', 'A', 'L', 'K', '0', '0'}, RefinementCascade::kVersion, "refinement cascade"};
// Constants: of the format (zstd level), and bounds against damaged files.

constexpr uint32_t kFirstBoneConditioned = 5;  // version that has such stages
constexpr uint32_t kFirstCompressed = 6;       // version that is
constexpr int kCompressionLevel = 19;

Perceptron GetStageNetwork(PayloadReader& in, Eigen::Index inputs, Eigen::Index outputs) {
  constexpr uint32_t kMostLayers = 2;  // with modest weights no sum through them is too large
  const auto hidden = in.Get<uint32_t>("layers");
  if (hidden > kMostLayers) in.Fail("layers", fmt::format("expected at most {}", kMostLayers));
  std::vector<Eigen::Index> sizes = {inputs};
  for (uint32_t l = 0; l < hidden; ++l) sizes.push_back(GetUnits(in));
  sizes.push_back(outputs);
  return GetPerceptron(in, sizes, WeightForm::kBytes);
}

void PutStageNetwork(PayloadWriter& out, const Perceptron& network) {
  const size_t hidden = network.layers.size() - 1;
  out.Put(static_cast<uint32_t>(hidden));
  for (size_t l = 0; l < hidden; ++l) {
    out.Put(static_cast<uint32_t>(network.layers[l].bias.size()));
  }
  PutPerceptron(out, network, WeightForm::kBytes);
}

std::vector<RefinementStage> GetStages(PayloadReader& in, const char* name, uint32_t fewest,
                                       Eigen::Index inputs) {
  const auto count = in.Get<uint32_t>(name);
  if (count < fewest || count > RefinementCascade::kMaxStages) {
    in.Fail(name, fmt::format("expected {} to {}", fewest, RefinementCascade::kMaxStages));
  }
  std::vector<RefinementStage> stages;
  for (uint32_t g = 0; g < count; ++g) {
    for (Perceptron& network : stages.emplace_back()) {
      network = GetStageNetwork(in, inputs, 3);
    }
  }
  return stages;
}

void PutStages(PayloadWriter& out, const std::vector<RefinementStage>& stages) {
  out.Put(static_cast<uint32_t>(stages.size()));
  for (const RefinementStage& stage : stages) {
    for (const Perceptron& network : stage) PutStageNetwork(out, network);
  }
}

}  // namespace

void RefinementCascade::Save(const std::filesystem::path& path) const {
  PayloadWriter out;
  out.Put(people);
  PutStages(out, stages);
  out.Put(bones.empty() ? uint64_t{0} : measured);
  if (!bones.empty()) {
    PutStageNetwork(out, bones);
    PutStages(out, bone_conditioned);
  }
  WriteContainer(path, kFormat, Compress(out.bytes(), kCompressionLevel));
}

bool RefinementCascade::IsFile(const std::filesystem::path& path) {
  return IsContainer(path, kFormat);
}

RefinementCascade RefinementCascade::Load(const std::filesystem::path& path) {
  const ContainerFormat format = ReadContainerFormat(path, kFormat, kOldestVersion);
  return NamingTheFile(path, [&] {
    std::vector<std::byte> payload = ReadContainer(path, format);
    std::string name = path.string();
    if (format.version >= kFirstCompressed) {
      payload = Decompress(payload, name, format.what);
      name += " (unpacked)";
    }
    return FromBytes(payload, name, format.version);
  });
}

RefinementCascade RefinementCascade::FromBytes(std::span<const std::byte> bytes,
                                               const std::string& name, uint32_t version) {
  PayloadReader in(bytes, name);
  RefinementCascade out;
  out.people = in.Get<uint64_t>("people");
  out.stages = GetStages(in, "stages", 1, kStageFeatures);
  out.measured = in.Get<uint64_t>("people whose bones were measured");
  if (out.measured > 0) {
    out.bones = GetStageNetwork(in, kBoneFeatures, kEstimatedBones.size());
    if (version >= kFirstBoneConditioned)
      out.bone_conditioned = GetStages(in, "bone-conditioned stages", 0, kBoneConditionedFeatures);
  }
  in.ExpectEnd();
  return out;
}

}  // namespace ossa::recon
