#include "recon/refine/pose_network.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "depth/base/checksummed_container.h"
#include "depth/base/error.h"
#include "depth/base/naming_the_file.h"
#include "depth/base/perceptron/perceptron_file.h"

namespace ossa::recon {
namespace {

// Constants: by hand, of the format, and part of every pose network; without a unit in the name
// they are ratios, counts or logarithms.

constexpr ContainerFormat kPoseNetworkFormat = {
    {'O', 'S', 'S', 'A', 'P', 'N', '0', '0'}, PoseNetwork::kVersion, "pose network"};

constexpr float kDepthScale = 2.0F;  // inputs a metre
constexpr float kOffset_m = 0.2F;    // of an output of 1
constexpr float kScale_m = 0.1F;     // of an error whose logarithm is 0
// Mean distance over scale of a density that decays as exp(-distance / scale) in space.
constexpr double kMeanOverScale = 3.0;
constexpr int kInputs = 3;
constexpr int kOutputs = 5;  // per joint: vote, offset, logarithm of the error's scale

// A layer: window, stride, and the layers whose outputs it reads.
struct LayerShape {
  int size = 3, stride = 1;
};
constexpr std::array<LayerShape, PoseNetwork::kLayers> kShapes = {{{5, 2},
                                                                   {3, 2},
                                                                   {3, 2},
                                                                   {3, 1},
                                                                   {3, 1},
                                                                   {3, 2},
                                                                   {3, 1},
                                                                   {3, 1},
                                                                   {3, 1},
                                                                   {3, 1},
                                                                   {1, 1},
                                                                   {3, 1},
                                                                   {1, 1}}};
enum Layer : size_t {
  kDown1,
  kDown2,
  kDown3,
  kNear,
  kDown4 = kNear + 2,
  kFar1,
  kFar2 = kFar1 + 2,
  kUp = kFar2 + 2,
  kJoin,
  kHead
};

// Expected input channels of each layer, from the actual layers.
std::array<Eigen::Index, PoseNetwork::kLayers> ExpectedInputs(const PoseNetwork::Layers& layers) {
  const auto width = [&](Layer layer) { return layers[layer].bias.size(); };
  const auto near = width(kDown3), far = width(kDown4);
  return {kInputs, width(kDown1), width(kDown2), near, near, near,        far,
          far,     far,           far,           far,  near, width(kJoin)};
}

std::array<Eigen::Index, PoseNetwork::kLayers> ExpectedOutputs(const PoseNetwork::Layers& layers) {
  const auto width = [&](Layer layer) { return layers[layer].bias.size(); };
  const auto near = width(kDown3), far = width(kDown4);
  return {width(kDown1),
          width(kDown2),
          near,
          near,
          near,
          far,
          far,
          far,
          far,
          far,
          near,
          width(kJoin),
          kOutputs * static_cast<Eigen::Index>(kJointCount)};
}

FeatureMap Residual(FeatureMap map, const QuantisedConvolution& first,
                    const QuantisedConvolution& second) {
  map.cells += second.Run(Rectified(first.Run(map))).cells;
  return Rectified(std::move(map));
}

FeatureMap ToInput(const PersonCrop& crop) {
  constexpr float kTaps = kCropTaps;
  FeatureMap input{kCropSide, RowMatrix(kCropCells, kInputs)};
  for (int c = 0; c < kCropCells; ++c) {
    const PersonCrop::Cell& cell = crop.cells[static_cast<size_t>(c)];
    const float surface = static_cast<float>(cell.surface) / kTaps;
    const auto behind_m =
        static_cast<float>(depth::MetresFromMillimetres(static_cast<double>(cell.behind_mm)));
    input.cells.row(c) << kDepthScale * behind_m * surface, surface,
        static_cast<float>(cell.hidden) / kTaps;
  }
  return input;
}

// Position, metres in the crop, and the logarithm of its error scale: means weighted by votes.
struct Voted {
  Eigen::Vector3d place_m = Eigen::Vector3d::Zero();
  double log_scale = 0.0;
};

Voted Vote(const FeatureMap& votes, Eigen::Index first) {
  const double step_m = kCropSide * kCropCell_m / votes.side;
  const double middle = (votes.side - 1) / 2.0;
  const double most = votes.cells.col(first).maxCoeff();
  Voted voted;
  double whole = 0.0;
  for (int cell = 0; cell < votes.side * votes.side; ++cell) {
    const auto of = votes.cells.row(cell).segment<kOutputs>(first).cast<double>();
    const double weight = std::exp(of[0] - most);
    const Eigen::Vector3d cell_m((middle - cell % votes.side) * step_m,
                                 (middle - cell / votes.side) * step_m, 0.0);
    voted.place_m += weight * (cell_m + kOffset_m * of.segment<3>(1).transpose());
    voted.log_scale += weight * of[4];
    whole += weight;
  }
  voted.place_m /= whole;
  voted.log_scale /= whole;
  return voted;
}

// Clamps a prediction to positions near the person and in front of the camera; non-finite
// predictions become unknown.
Voted Bounded(const Voted& voted, const PersonCrop& crop) {
  constexpr double kFarthest_m = 5.0, kNearest_m = 0.1;  // from the middle; in front of the camera
  constexpr double kMostLogScale = 10.0;                 // a ratio's logarithm: 2 km
  if (!voted.place_m.allFinite() || !std::isfinite(voted.log_scale)) {
    return {Eigen::Vector3d::Zero(), kMostLogScale};
  }
  Voted bounded = voted;
  bounded.place_m = voted.place_m.cwiseMax(-kFarthest_m).cwiseMin(kFarthest_m);
  bounded.place_m.z() = std::max(bounded.place_m.z(), kNearest_m - crop.middle_m.norm());
  bounded.log_scale = std::clamp(voted.log_scale, -kMostLogScale, kMostLogScale);
  return bounded;
}

}  // namespace

PoseNetwork::PoseNetwork(Layers layers, uint64_t people, const std::string& name)
    : layers_(std::move(layers)), people_(people) {
  const auto inputs = ExpectedInputs(layers_), outputs = ExpectedOutputs(layers_);
  for (size_t l = 0; l < kLayers; ++l) {
    const Convolution& layer = layers_[l];
    const auto cells = static_cast<Eigen::Index>(kShapes[l].size) * kShapes[l].size;
    if (layer.size != kShapes[l].size || layer.stride != kShapes[l].stride ||
        layer.weight.rows() != cells * inputs[l] || layer.weight.cols() != outputs[l] ||
        layer.bias.size() != outputs[l]) {
      throw InputError(fmt::format(
          "{}: layer {}: expected {} inputs and {} outputs of {} x {} cells, stride {}; found "
          "{}, {}, {} x {}, {}",
          name, l + 1, inputs[l], outputs[l], kShapes[l].size, kShapes[l].size, kShapes[l].stride,
          layer.inputs(), layer.weight.cols(), layer.size, layer.size, layer.stride));
    }
    if (!AreModest(layer.weight) || !AreModest(layer.bias)) {
      throw InputError(
          fmt::format("{}: layer {}: expected numbers of at most a million", name, l + 1));
    }
    quantised_[l] = QuantisedConvolution(layer);
  }
}

NetworkPose PoseNetwork::Run(const PersonCrop& crop) const {
  FeatureMap map = ToInput(crop);
  for (const Layer layer : {kDown1, kDown2, kDown3}) map = Rectified(quantised_[layer].Run(map));
  FeatureMap near = Residual(std::move(map), quantised_[kNear], quantised_[kNear + 1]);
  FeatureMap far = Rectified(quantised_[kDown4].Run(near));
  for (const Layer layer : {kFar1, kFar2}) {
    far = Residual(std::move(far), quantised_[layer], quantised_[layer + 1]);
  }
  near.cells += Doubled(quantised_[kUp].Run(far)).cells;
  const FeatureMap votes = quantised_[kHead].Run(Rectified(quantised_[kJoin].Run(near)));
  NetworkPose pose;
  for (size_t j = 0; j < kJointCount; ++j) {
    const Voted voted = Bounded(Vote(votes, kOutputs * static_cast<Eigen::Index>(j)), crop);
    pose.joints_m.position_m[j] = crop.BackProject(voted.place_m);
    pose.error_m[j] = kMeanOverScale * kScale_m * std::exp(voted.log_scale);
  }
  return pose;
}

PoseNetwork PoseNetwork::FromBytes(std::span<const std::byte> bytes, const std::string& name) {
  PayloadReader in(bytes, name);
  const auto people = in.Get<uint64_t>("people");
  Layers layers;
  for (size_t l = 0; l < kLayers; ++l) {
    Convolution& layer = layers[l];
    layer.size = kShapes[l].size;
    layer.stride = kShapes[l].stride;
    const Eigen::Index inputs = GetUnits(in), outputs = GetUnits(in);
    const Eigen::Index rows = inputs * layer.size * layer.size;
    layer.weight = GetHalves(in, "weights", rows, outputs);
    layer.bias = GetFloats(in, "biases", outputs).transpose();
  }
  in.ExpectEnd();
  return {std::move(layers), people, name};
}

void PoseNetwork::Save(const std::filesystem::path& path) const {
  PayloadWriter out;
  out.Put(people_);
  for (const Convolution& layer : layers_) {
    out.Put(static_cast<uint32_t>(layer.inputs()));
    out.Put(static_cast<uint32_t>(layer.bias.size()));
    PutHalves(out, std::span(layer.weight.data(), static_cast<size_t>(layer.weight.size())));
    out.PutArray(std::span<const float>(layer.bias.data(), static_cast<size_t>(layer.bias.size())));
  }
  WriteContainer(path, kPoseNetworkFormat, out.bytes());
}

PoseNetwork PoseNetwork::Load(const std::filesystem::path& path) {
  return NamingTheFile(
      path, [&] { return FromBytes(ReadContainer(path, kPoseNetworkFormat), path.string()); });
}

bool PoseNetwork::IsFile(const std::filesystem::path& path) {
  return IsContainer(path, kPoseNetworkFormat);
}

PoseNetwork PoseNetwork::FromNumbers(std::span<const float> numbers, uint64_t people,
                                     const std::string& name) {
  constexpr float kMostUnits = 4096.0F;  // a count
  const auto fail = [&](const std::string& expected) {
    throw InputError(fmt::format("{}: {}", name, expected));
  };
  const auto take = [&](Eigen::Index count) {
    if (std::ssize(numbers) < count) fail("expected more numbers: it ends within a layer");
    const auto taken = numbers.first(static_cast<size_t>(count));
    numbers = numbers.subspan(static_cast<size_t>(count));
    return taken;
  };
  Layers layers;
  for (size_t l = 0; l < kLayers; ++l) {
    const auto head = take(4);
    for (const float number : head) {
      if (!(number >= 1.0F && number <= kMostUnits && number == std::floor(number))) {
        fail(fmt::format("layer {}: expected inputs, outputs, size and stride, found {}", l + 1,
                         number));
      }
    }
    Convolution& layer = layers[l];
    layer.size = static_cast<int>(head[2]);
    layer.stride = static_cast<int>(head[3]);
    const auto outputs = static_cast<Eigen::Index>(head[1]);
    const Eigen::Index rows = static_cast<Eigen::Index>(head[0]) * layer.size * layer.size;
    layer.weight = Eigen::Map<const RowMatrix>(take(rows * outputs).data(), rows, outputs);
    layer.bias = Eigen::Map<const Eigen::RowVectorXf>(take(outputs).data(), outputs);
  }
  if (!numbers.empty()) fail(fmt::format("expected no more numbers, found {}", numbers.size()));
  return {std::move(layers), people, name};
}

}  // namespace ossa::recon
