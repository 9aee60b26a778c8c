// Learns the relabelling (forest/proposals/relabel.cpp): multinomial logistic regression of the
// true class on a pixel's proximity to the proposed targets, with the trees' log-probabilities as
// an offset. On images that neither trees nor refinement have seen, so that proposals have
// realistic errors.
#include <oneapi/tbb/parallel_for.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "depth/base/error.h"
#include "depth/base/perceptron/perceptron_trainer.h"
#include "depth/base/random.h"
#include "depth/base/threads.h"
#include "forest/classification/classify.h"
#include "forest/proposals/propose.h"
#include "forest/proposals/relabel_internal.h"
#include "forest/training/validation_internal.h"

namespace ossa::forest {
namespace {

// Constants: chosen by hand on validation subjects (`ossa evaluate`).

constexpr size_t kPixels = 60;  // per image: more are redundant
constexpr Eigen::Index kBatch = 2048;
constexpr int kEpochs = 5;
constexpr float kRate = 0.02F;    // Adam's maximum learning rate; no unit
constexpr float kDecay = 0.02F;   // weight decay per unit of the learning rate
constexpr double kRarest = 1e-3;  // lower bound of a class frequency; share

// Pixels of one or all images, one per row.
struct LabelledPixels {
  RowMatrix near;           // pixel × (scale · target), then the same times confidence
  RowMatrix offset;         // pixel × class from 1 on: log P of the trees
  std::vector<int> column;  // column of the true class
};

LabelledPixels Sample(const ForestModel& model, const TrainingImage& image) {
  LabelledPixels out;
  const Classification result = ClassifyImage(model, image);
  if (result.pixel.empty()) return out;
  const int width = image.camera.width;
  const depth::DepthView view{image.depth_mm.data(), width, image.camera.height, width};
  const Anchors anchors(Propose(model, view, image.camera, result));
  const size_t count = std::min(kPixels, result.pixel.size());
  const auto rows = static_cast<Eigen::Index>(count);
  const Eigen::Index classes = model.class_count() - 1;
  out.offset.resize(rows, classes);
  std::vector<Eigen::Vector3f> points_m;
  for (size_t k = 0; k < count; ++k) {
    const size_t i = (2 * k + 1) * result.pixel.size() / (2 * count);
    const int32_t p = result.pixel[i];
    const uint16_t mm = image.depth_mm[static_cast<size_t>(p)];
    points_m.push_back(depth::BackProject(image.camera, p % width, p / width, mm).cast<float>());
    const int label = image.label[static_cast<size_t>(p)];
    if (label > classes) {
      throw InputError("relabelling: expected labels of at most " + std::to_string(classes) +
                       ", found " + std::to_string(label));
    }
    out.column.push_back(label - 1);
    for (Eigen::Index c = 0; c < classes; ++c) {
      const float probability = result.Probability(i, static_cast<size_t>(c) + 1);
      out.offset(static_cast<Eigen::Index>(k), c) = std::log(probability + kLeastLeafProbability);
    }
  }
  const RowMatrix near = ComputeRadialBasis(anchors, points_m);
  out.near.resize(rows, 2 * near.cols());
  out.near.leftCols(near.cols()) = near;
  const auto targets = static_cast<Eigen::Index>(anchors.confidence.size());
  for (Eigen::Index c = 0; c < near.cols(); ++c) {
    out.near.col(near.cols() + c) =
        anchors.confidence[static_cast<size_t>(c % targets)] * near.col(c);
  }
  return out;
}

LabelledPixels Gather(const ForestModel& model, const TrainingSource& source) {
  std::vector<LabelledPixels> parts(source.size());
  oneapi::tbb::parallel_for(size_t{0}, source.size(),
                            [&](size_t i) { parts[i] = Sample(model, source.Read(i)); });
  LabelledPixels all;
  size_t rows = 0;
  for (const LabelledPixels& part : parts) rows += part.column.size();
  const auto targets = static_cast<Eigen::Index>(model.targets().size());
  all.near.resize(static_cast<Eigen::Index>(rows),
                  2 * static_cast<Eigen::Index>(kRadialBasisScales) * targets);
  all.offset.resize(static_cast<Eigen::Index>(rows), model.class_count() - 1);
  for (LabelledPixels& part : parts) {
    const auto first = static_cast<Eigen::Index>(all.column.size());
    const auto count = static_cast<Eigen::Index>(part.column.size());
    if (count == 0) continue;
    all.near.middleRows(first, count) = part.near;
    all.offset.middleRows(first, count) = part.offset;
    all.column.insert(all.column.end(), part.column.begin(), part.column.end());
    part = LabelledPixels();
  }
  return all;
}

// Classes have equal weight regardless of frequency: the metric is the mean over classes.
std::vector<float> ComputeClassWeights(const std::vector<int>& column, Eigen::Index classes) {
  std::vector<double> count(static_cast<size_t>(classes), 0.0);
  for (const int c : column) count[static_cast<size_t>(c)] += 1.0;
  std::vector<float> weight;
  for (const double n : count) {
    const double share = n / static_cast<double>(column.size());
    weight.push_back(
        static_cast<float>(1.0 / static_cast<double>(classes) / std::max(share, kRarest)));
  }
  return weight;
}

// Gradient of the weighted cross entropy with respect to the scores, one row per pixel.
RowMatrix ComputeGradient(const RowMatrix& score, const LabelledPixels& pixels,
                          const std::vector<Eigen::Index>& chosen,
                          const std::vector<float>& weight) {
  RowMatrix gradient(score.rows(), score.cols());
  for (Eigen::Index i = 0; i < score.rows(); ++i) {
    const Eigen::Index row = chosen[static_cast<size_t>(i)];
    const int truth = pixels.column[static_cast<size_t>(row)];
    Eigen::ArrayXf p = (score.row(i) + pixels.offset.row(row)).transpose().array();
    p = (p - p.maxCoeff()).exp();
    p /= p.sum();
    p[truth] -= 1.0F;
    gradient.row(i) =
        (weight[static_cast<size_t>(truth)] / static_cast<float>(score.rows()) * p).matrix();
  }
  return gradient;
}

Relabelling Fit(const LabelledPixels& pixels, uint64_t seed) {
  const Eigen::Index classes = pixels.offset.cols();
  const std::vector<float> weight = ComputeClassWeights(pixels.column, classes);
  PerceptronTrainer regression({pixels.near.cols(), classes}, {.decay = kDecay}, seed);
  Random random(MixSeed(seed, 0x9a57));
  const auto count = static_cast<uint32_t>(pixels.column.size());
  const int64_t steps = kEpochs * static_cast<int64_t>(count) / kBatch + 1;
  std::vector<Eigen::Index> chosen(static_cast<size_t>(kBatch));
  RowMatrix batch(kBatch, pixels.near.cols());
  for (int64_t step = 0; step < steps; ++step) {
    for (size_t i = 0; i < chosen.size(); ++i) {
      chosen[i] = random.Below(count);
      batch.row(static_cast<Eigen::Index>(i)) = pixels.near.row(chosen[i]);
    }
    const RowMatrix& score = regression.Forward(batch);
    const float left = 1.0F - static_cast<float>(step) / static_cast<float>(steps);
    regression.Step(ComputeGradient(score, pixels, chosen, weight), kRate * left);
  }
  const PerceptronLayer layer = regression.Layers().front();
  return {{layer.weight.data(), layer.weight.data() + layer.weight.size()},
          {layer.bias.data(), layer.bias.data() + layer.bias.size()}};
}

}  // namespace

ForestModel LearnRelabelling(const ForestModel& model, const TrainingSource& source, uint64_t seed,
                             int threads) {
  const ThreadLimit limit(threads);
  const LabelledPixels pixels = Gather(model, source);
  if (pixels.column.empty()) throw InputError("relabelling: no image shows anything");
  ForestData data = model.data();
  data.relabelling = Fit(pixels, seed);
  return ForestModel(std::move(data));
}

}  // namespace ossa::forest
