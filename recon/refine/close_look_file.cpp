#include <fmt/format.h>

#include "depth/base/checksummed_container.h"
#include "depth/base/compressed.h"
#include "depth/base/naming_the_file.h"
#include "recon/refine/bone_measure.h"
#include "recon/refine/close_look.h"

namespace ossa::recon {
namespace {

constexpr ContainerFormat kFormat = {
    {'O', 'S', 'S', 'A', 'L', 'K', '0', '0'}, CloseLook::kVersion, "close look"};
constexpr uint32_t kFirstTold = 5;        // version with glances that are told of the bones
constexpr uint32_t kFirstCompressed = 6;  // version that is
constexpr int kCompressionLevel = 19;

RectifiedNetwork GetLookNetwork(PayloadReader& in, Eigen::Index inputs, Eigen::Index outputs) {
  constexpr uint32_t kMostLayers = 2;  // with modest weights no sum through them is too large
  const auto hidden = in.Get<uint32_t>("layers");
  if (hidden > kMostLayers) in.Fail("layers", fmt::format("expected at most {}", kMostLayers));
  std::vector<Eigen::Index> sizes = {inputs};
  for (uint32_t l = 0; l < hidden; ++l) sizes.push_back(GetUnits(in));
  sizes.push_back(outputs);
  return GetNetwork(in, sizes, WeightForm::kBytes);
}

void PutLookNetwork(PayloadWriter& out, const RectifiedNetwork& network) {
  const size_t hidden = network.layers.size() - 1;
  out.Put(static_cast<uint32_t>(hidden));
  for (size_t l = 0; l < hidden; ++l) {
    out.Put(static_cast<uint32_t>(network.layers[l].bias.size()));
  }
  PutNetwork(out, network, WeightForm::kBytes);
}

std::vector<Glance> GetGlances(PayloadReader& in, const char* name, uint32_t fewest,
                               Eigen::Index inputs) {
  const auto count = in.Get<uint32_t>(name);
  if (count < fewest || count > CloseLook::kMostGlances) {
    in.Fail(name, fmt::format("expected {} to {}", fewest, CloseLook::kMostGlances));
  }
  std::vector<Glance> glances;
  for (uint32_t g = 0; g < count; ++g) {
    for (RectifiedNetwork& network : glances.emplace_back()) {
      network = GetLookNetwork(in, inputs, 3);
    }
  }
  return glances;
}

void PutGlances(PayloadWriter& out, const std::vector<Glance>& glances) {
  out.Put(static_cast<uint32_t>(glances.size()));
  for (const Glance& glance : glances) {
    for (const RectifiedNetwork& network : glance) PutLookNetwork(out, network);
  }
}

}  // namespace

void CloseLook::Save(const std::filesystem::path& path) const {
  PayloadWriter out;
  out.Put(people);
  PutGlances(out, glances);
  out.Put(bones.empty() ? uint64_t{0} : measured);
  if (!bones.empty()) {
    PutLookNetwork(out, bones);
    PutGlances(out, told);
  }
  WriteContainer(path, kFormat, Compress(out.bytes(), kCompressionLevel));
}

bool CloseLook::IsOne(const std::filesystem::path& path) { return IsContainer(path, kFormat); }

CloseLook CloseLook::Load(const std::filesystem::path& path) {
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

CloseLook CloseLook::FromBytes(std::span<const std::byte> bytes, const std::string& name,
                               uint32_t version) {
  PayloadReader in(bytes, name);
  CloseLook out;
  out.people = in.Get<uint64_t>("people");
  out.glances = GetGlances(in, "glances", 1, kLookInputs);
  out.measured = in.Get<uint64_t>("people measured");
  if (out.measured > 0) {
    out.bones = GetLookNetwork(in, kBoneInputs, kMeasuredBones.size());
    if (version >= kFirstTold) out.told = GetGlances(in, "told glances", 0, kToldInputs);
  }
  in.ExpectEnd();
  return out;
}

}  // namespace ossa::recon
