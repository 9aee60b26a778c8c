// Factor analysis of the targets' positions (Harman 1976, iterated principal factors): correlated
// motion becomes factors, independent motion of a target its noise.
#include <oneapi/tbb/parallel_for.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>

#include "depth/base/error.h"
#include "depth/base/threads.h"
#include "forest/training/train.h"

namespace ossa::forest {
namespace {

constexpr Eigen::Index kFactors = 24;  // for 60 numbers: 32 find no more joints, 16 fewer
// Constants: chosen by hand.

constexpr int kRounds = 8;
constexpr double kLeastNoise_m = 0.014;  // lower bound of a target's residual deviation
// Weight of the mean over contexts in each, in images: some contexts are rare; times an image's
// weight
constexpr double kBorrowed = 5;

struct Example {
  size_t context = 0;
  Eigen::VectorXd position;  // target · 3, relative to their mean
};

std::optional<Example> MakeExample(const TrainingImage& image, size_t targets) {
  if (image.target_m.size() != targets) return std::nullopt;
  Example example;
  example.context = image.context;
  example.position.resize(static_cast<Eigen::Index>(3 * targets));
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3f& p : image.target_m) {
    if (!p.allFinite()) return std::nullopt;
    mean += p.cast<double>() / static_cast<double>(targets);
  }
  for (size_t t = 0; t < targets; ++t) {
    example.position.segment<3>(static_cast<Eigen::Index>(3 * t)) =
        image.target_m[t].cast<double>() - mean;
  }
  return example;
}

std::vector<std::optional<Example>> ReadExamples(const TrainingSource& source, size_t targets,
                                                 size_t max_images) {
  const size_t count = std::min(source.size(), max_images);
  std::vector<std::optional<Example>> examples(count);
  oneapi::tbb::parallel_for(size_t{0}, count, [&](size_t i) {
    examples[i] = MakeExample(source.Read(i * source.size() / count), targets);
  });
  std::erase_if(examples, [](const auto& example) { return !example.has_value(); });
  return examples;
}

struct Moments {
  double count = 0;
  Eigen::VectorXd sum;
  Eigen::MatrixXd square;

  explicit Moments(Eigen::Index size)
      : sum(Eigen::VectorXd::Zero(size)), square(Eigen::MatrixXd::Zero(size, size)) {}
  void Add(const Eigen::VectorXd& x) {
    count += 1;
    sum += x;
    square += x * x.transpose();
  }
  void Borrow(const Moments& other, double images) {
    const double scale = images / other.count;
    count += images;
    sum += scale * other.sum;
    square += scale * other.square;
  }
};

PosePrior Analyse(const Moments& moments) {
  const Eigen::VectorXd mean = moments.sum / moments.count;
  const Eigen::MatrixXd covariance = moments.square / moments.count - mean * mean.transpose();
  const Eigen::Index size = mean.size();
  const Eigen::Index factors = std::min(kFactors, size - 1);
  Eigen::VectorXd noise = Eigen::VectorXd::Constant(size, 1e-4);
  Eigen::MatrixXd loading;
  for (int round = 0; round < kRounds; ++round) {
    Eigen::MatrixXd common = covariance;
    common.diagonal() -= noise;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(common);
    loading = solver.eigenvectors().rightCols(factors) *
              solver.eigenvalues().tail(factors).cwiseMax(0.0).cwiseSqrt().asDiagonal();
    noise = covariance.diagonal() - loading.rowwise().squaredNorm();
    for (Eigen::Index t = 0; t < size; t += 3) {  // the same for each axis
      const double variance = std::max(noise.segment<3>(t).mean(), kLeastNoise_m * kLeastNoise_m);
      noise.segment<3>(t).setConstant(variance);
    }
  }
  PosePrior prior;
  for (Eigen::Index i = 0; i < size; ++i) {
    prior.mean_m.push_back(static_cast<float>(mean[i]));
    for (Eigen::Index f = 0; f < factors; ++f) {
      prior.loading_m.push_back(static_cast<float>(loading(i, f)));
    }
    if (i % 3 == 0) prior.noise_m.push_back(static_cast<float>(std::sqrt(noise[i])));
  }
  return prior;
}

}  // namespace

ForestModel LearnPosePriors(const ForestModel& model, const TrainingSource& source,
                            size_t max_images, int threads) {
  const ThreadLimit limit(threads);
  const size_t targets = model.targets().size();
  const auto contexts = static_cast<size_t>(model.context_count());
  const auto examples = ReadExamples(source, targets, max_images);
  // Fewer examples than numbers give no useful covariance; two targets have no structure.
  if (targets < 3 || examples.size() < 3 * targets) return model;
  const auto size = static_cast<Eigen::Index>(3 * targets);
  Moments whole(size);
  std::vector<Moments> of_context(contexts, Moments(size));
  for (const auto& example : examples) {
    whole.Add(example->position);
    if (example->context < contexts) of_context[example->context].Add(example->position);
  }
  ForestData data = model.data();
  data.pose_priors.clear();
  data.refinement = Perceptron();  // was trained on the old ones
  for (Moments& moments : of_context) {
    moments.Borrow(whole, kBorrowed);
    data.pose_priors.push_back(Analyse(moments));
  }
  return ForestModel(std::move(data));
}

}  // namespace ossa::forest
