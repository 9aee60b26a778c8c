#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>

#include "forest/network.h"
#include "forest/training/network_trainer_internal.h"
#include "forest/training/random_internal.h"
#include "forest/training/train.h"

namespace ossa::forest {
namespace {

constexpr int64_t kWarmUp = 200;  // steps until the rate is at its highest

RowMatrix Rows(const RowMatrix& all, std::span<const Eigen::Index> chosen) {
  RowMatrix rows(static_cast<Eigen::Index>(chosen.size()), all.cols());
  for (size_t i = 0; i < chosen.size(); ++i) {
    rows.row(static_cast<Eigen::Index>(i)) = all.row(chosen[i]);
  }
  return rows;
}

// Rises at first, then falls to nothing along half a cosine (Loshchilov and Hutter 2017).
float RateAt(double highest, int64_t step, int64_t steps) {
  const double done = static_cast<double>(step) / static_cast<double>(steps);
  const double warm = std::min(1.0, static_cast<double>(step + 1) / static_cast<double>(kWarmUp));
  return static_cast<float>(highest * warm * 0.5 * (1.0 + std::cos(std::numbers::pi * done)));
}

}  // namespace

std::vector<NetworkLayer> LearnNetwork(const NetworkExamples& examples,
                                       const LossGradient& gradient,
                                       const NetworkOptions& options) {
  std::vector<Eigen::Index> widths = {examples.input.cols()};
  widths.insert(widths.end(), options.hidden.begin(), options.hidden.end());
  widths.push_back(options.outputs);
  NetworkTrainer network(widths, {options.decay, options.dropped}, options.seed);
  std::vector<Eigen::Index> order(static_cast<size_t>(examples.input.rows()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  Random random(MixSeed(options.seed, 0x5befe7));
  const auto batches = static_cast<int64_t>(order.size()) / options.batch;
  const int64_t steps = batches * options.epochs;
  for (int64_t step = 0; step < steps; ++step) {
    if (options.stop && options.stop()) throw TrainInterrupted("interrupted while refining");
    const int64_t batch = step % batches;
    for (size_t i = order.size(); batch == 0 && i > 1; --i) {
      std::swap(order[i - 1], order[random.Below(static_cast<uint32_t>(i))]);
    }
    const std::span chosen(order.data() + batch * options.batch,
                           static_cast<size_t>(options.batch));
    const RowMatrix& out = network.Forward(Rows(examples.input, chosen));
    network.Step(gradient(out, Rows(examples.wanted, chosen)),
                 RateAt(double{options.rate}, step, steps));
    if (options.progress) options.progress(step + 1, steps);
  }
  return network.Layers();
}

}  // namespace ossa::forest
