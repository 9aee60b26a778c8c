#include <fmt/format.h>

#include <functional>
#include <utility>

#include "depth/base/checksummed_container.h"
#include "depth/base/compressed.h"
#include "depth/base/naming_the_file.h"
#include "depth/base/perceptron/perceptron_file.h"
#include "recon/refine/bone_estimation.h"
#include "recon/refine/refinement_cascade.h"

namespace ossa::recon {
namespace {

constexpr ContainerFormat kCascadeFormat = {
    {'O', 'S', 'S', 'A', 'L', 'K', '0', '0'}, RefinementCascade::kVersion, "refinement cascade"};
// Constants: of the format (zstd level), and bounds against damaged files.

constexpr uint32_t kFirstBoneConditioned = 5;  // first version with such stages
constexpr uint32_t kFirstCompressed = 6;       // first compressed version
constexpr uint32_t kFirstFromAbove = 7;        // first version with from_above
constexpr uint32_t kFirstForest = 8;           // first version that names the forest
constexpr int kCompressionLevel = 19;

Perceptron GetStageNetwork(PayloadReader& in, Eigen::Index inputs, Eigen::Index outputs) {
  constexpr uint32_t kMostLayers = 2;  // sums through them cannot overflow
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

// Consumes each network as soon as it is read.
using TakeNetwork = std::function<void(Perceptron)>;

uint32_t GetStages(PayloadReader& in, const char* name, uint32_t fewest, Eigen::Index inputs,
                   const TakeNetwork& take) {
  const auto count = in.Get<uint32_t>(name);
  if (count < fewest || count > RefinementCascade::kMaxStages) {
    in.Fail(name, fmt::format("expected {} to {}", fewest, RefinementCascade::kMaxStages));
  }
  for (size_t n = 0; n < count * kStageJoints.size(); ++n) take(GetStageNetwork(in, inputs, 3));
  return count;
}

// The contents of a file besides its networks.
struct FileCounts {
  bool from_above = false;
  uint64_t forest_checksum = 0;
  uint64_t people = 0, measured = 0;          // as RefinementCascade's
  uint32_t stages = 0, bone_conditioned = 0;  // kStageJoints networks each
};

bool GetFromAbove(PayloadReader& in) {
  const auto from_above = in.Get<uint32_t>("seen from above");
  if (from_above > 1) in.Fail("seen from above", "expected 0 or 1");
  return from_above == 1;
}

// Calls `take` with the networks in execution order.
FileCounts ReadNetworks(std::span<const std::byte> bytes, const std::string& name, uint32_t version,
                        const TakeNetwork& take) {
  PayloadReader in(bytes, name);
  FileCounts counts;
  counts.people = in.Get<uint64_t>("people");
  if (version >= kFirstFromAbove) counts.from_above = GetFromAbove(in);
  if (version >= kFirstForest) counts.forest_checksum = in.Get<uint64_t>("forest");
  counts.stages = GetStages(in, "stages", 1, kStageFeatures, take);
  counts.measured = in.Get<uint64_t>("people whose bones were measured");
  if (counts.measured > 0) {
    take(GetStageNetwork(in, kBoneFeatures, kEstimatedBones.size()));
    if (version >= kFirstBoneConditioned) {
      counts.bone_conditioned =
          GetStages(in, "bone-conditioned stages", 0, kBoneConditionedFeatures, take);
    }
  }
  in.ExpectEnd();
  return counts;
}

// Returns read(payload, name, version).
template <typename Read>
auto ReadPayload(const std::filesystem::path& path, const Read& read) {
  const ContainerFormat format =
      ReadContainerFormat(path, kCascadeFormat, RefinementCascade::kOldestVersion);
  return NamingTheFile(path, [&] {
    std::vector<std::byte> payload = ReadContainer(path, format);
    std::string name = path.string();
    if (format.version >= kFirstCompressed) {
      payload = Decompress(payload, name, format.what);
      name += " (unpacked)";
    }
    return read(payload, name, format.version);
  });
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
  out.Put(uint32_t{from_above});
  out.Put(forest_checksum);
  PutStages(out, stages);
  out.Put(bones.empty() ? uint64_t{0} : measured);
  if (!bones.empty()) {
    PutStageNetwork(out, bones);
    PutStages(out, bone_conditioned);
  }
  WriteContainer(path, kCascadeFormat, Compress(out.bytes(), kCompressionLevel));
}

bool RefinementCascade::IsFile(const std::filesystem::path& path) {
  return IsContainer(path, kCascadeFormat);
}

RefinementCascade RefinementCascade::Load(const std::filesystem::path& path) {
  return ReadPayload(path, FromBytes);
}

RefinementCascade RefinementCascade::FromBytes(std::span<const std::byte> bytes,
                                               const std::string& name, uint32_t version) {
  std::vector<Perceptron> networks;
  const FileCounts counts = ReadNetworks(
      bytes, name, version, [&](Perceptron network) { networks.push_back(std::move(network)); });
  auto next = networks.begin();
  const auto take_stages = [&next](uint32_t count) {
    std::vector<RefinementStage> stages(count);
    for (RefinementStage& stage : stages) {
      for (Perceptron& network : stage) network = std::move(*next++);
    }
    return stages;
  };
  RefinementCascade out;
  out.from_above = counts.from_above;
  out.forest_checksum = counts.forest_checksum;
  out.people = counts.people;
  out.measured = counts.measured;
  out.stages = take_stages(counts.stages);
  if (counts.measured > 0) out.bones = std::move(*next++);
  out.bone_conditioned = take_stages(counts.bone_conditioned);
  return out;
}

JointRefiner JointRefiner::Load(const std::filesystem::path& path) {
  return ReadPayload(
      path, [](std::span<const std::byte> bytes, const std::string& name, uint32_t version) {
        JointRefiner refiner;
        PerceptronPacker packer(bytes.size());
        const FileCounts counts = ReadNetworks(
            bytes, name, version, [&](const Perceptron& network) { packer.Add(network); });
        refiner.before_bones_ = counts.stages * kStageJoints.size();
        refiner.networks_ = packer.Take();
        refiner.from_above_ = counts.from_above;
        refiner.forest_checksum_ = counts.forest_checksum;
        return refiner;
      });
}

}  // namespace ossa::recon
