#include "tools/learning/learn_prior_network.h"

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "depth/base/error.h"
#include "depth/base/perceptron/train_perceptron.h"
#include "depth/base/random.h"
#include "depth/base/threads.h"
#include "depth/base/train_interrupted.h"
#include "forest/training/train.h"
#include "recon/models/prior_filter.h"

namespace ossa::tools {
namespace {

using recon::BoneLengths;
using recon::BoneVector;
using recon::kBoneDims;
using recon::kJointCount;
using recon::Posture;

using Joints = recon::JointArray<bool>;

// Constants: chosen by hand.

constexpr size_t kEvery = 4;  // frames give an example: neighbours hardly differ
constexpr size_t kShortest = 60, kLongest = 150;  // frames for which things stay as hidden as ever

/// Visible joints in the setups of Shum 2013's table III, and of a person behind a table.
constexpr std::array<std::initializer_list<size_t>, 6> kFewSeen = {{{7, 15},
                                                                    {11, 19},
                                                                    {7, 11},
                                                                    {7, 11, 15, 19},
                                                                    {5, 7, 9, 11, 13, 15, 17, 19},
                                                                    {3, 7, 11, 15, 19}}};
/// Joints hidden together by one object: arms, legs, the trunk.
constexpr std::array<std::initializer_list<size_t>, 5> kHiddenTogether = {
    {{5, 6, 7}, {9, 10, 11}, {13, 14, 15}, {17, 18, 19}, {1, 2, 3, 4, 8}}};

/// True of joints that are seen; the root is no part of it.
Joints SampleVisibility(Random& random) {
  Joints seen;
  const double kind = random.Uniform(0.0, 1.0);
  seen.fill(kind >= 0.4);
  if (kind < 0.4) {
    for (const size_t joint : kFewSeen[random.Index(kFewSeen.size())]) {
      seen[joint] = true;
    }
  } else if (kind < 0.75) {
    const size_t groups = 1 + random.Index((size_t{1} << kHiddenTogether.size()) - 1);
    for (size_t g = 0; g < kHiddenTogether.size(); ++g) {
      if ((groups >> g & 1U) == 0) continue;
      for (const size_t joint : kHiddenTogether[g]) seen[joint] = false;
    }
    const bool hips = random.Chance(0.7);
    seen[12] = hips;
    seen[16] = hips;
  } else {
    const double share = random.Uniform(0.0, 1.0);
    for (bool& joint : seen) joint = !random.Chance(share);
  }
  return seen;
}

/// A person's size and the sensor's errors for a while.
struct Circumstances {
  Joints seen{};
  double yaw_rad = 0.0;  // by which the heading is wrong
  double root_sd_m = 0.0;
  double white_m = 0.0;  // error of what is seen, another one each frame
  Posture error;         // the same one all the time
  BoneLengths lengths_m{};
};

Eigen::Vector3d SampleVector(Random& random, double deviation) {
  Eigen::Vector3d v;
  for (double& x : v) x = random.Normal(0.0, deviation);
  return v;
}

Circumstances Draw(Random& random) {
  Circumstances c;
  c.seen = SampleVisibility(random);
  c.yaw_rad = random.Normal(0.0, 4.0 * std::numbers::pi / 180.0);
  const bool root_seen = random.Chance(0.8);
  c.root_sd_m = recon::BaseSigma_m(0.0) / (root_seen ? 1.0 : 0.3);
  c.white_m = random.Uniform(0.0, 0.012);
  const double error_m = random.Uniform(0.0, 0.012);
  for (Eigen::Vector3d& error : c.error.position_m) error = SampleVector(random, error_m);
  c.error.position_m[0] = SampleVector(random, root_seen ? 0.5 * error_m : 0.05);
  for (size_t i = 0; i < kJointCount; ++i) {
    const auto twin = recon::kMirroredJoint[i];
    const double ratio = std::exp(random.Normal(0.0, 0.03));
    c.lengths_m[i] = recon::StandardBoneLengths()[i] * ratio;
    if (twin < i) c.lengths_m[i] = c.lengths_m[twin];
  }
  return c;
}

/// The posture as of a sensor that does not guess hidden joints.
recon::PriorObservation Observe(const Posture& truth, const Circumstances& c, bool all,
                                Random& random) {
  recon::PriorObservation out;
  out.lengths_m = c.lengths_m;
  out.root_sd_m = c.root_sd_m;
  out.seen = recon::Retargeted(truth, c.lengths_m);
  for (size_t i = 1; i < kJointCount; ++i) {
    const Eigen::Vector3d white = SampleVector(random, c.white_m);
    out.seen.position_m[i] += c.error.position_m[0] + c.error.position_m[i] + white;
    out.sd_m[i] = all || c.seen[i] ? recon::BaseSigma_m(0.0) : 0.0;
  }
  return out;
}

Posture Turned(const Posture& posture, double yaw_rad) {
  Posture turned;
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitY()).toRotationMatrix();
  for (size_t i = 0; i < kJointCount; ++i) turned.position_m[i] = turn * posture.position_m[i];
  return turned;
}

/// One walk of the filter through a motion.
struct Walk {
  const std::vector<BoneVector>* run = nullptr;
  double frame_s = 0.0;
  uint64_t number = 0;   // of all
  Eigen::Index row = 0;  // of its first example

  Eigen::Index Examples() const { return static_cast<Eigen::Index>(run->size() / kEvery); }
};

void Take(const Walk& walk, const std::shared_ptr<const recon::PosturePrior>& prior, uint64_t seed,
          PerceptronExamples* out) {
  Random random(seed, walk.number);
  recon::PriorFilter filter(prior);
  Circumstances now;
  size_t left = 0;
  Eigen::Index row = walk.row;
  for (size_t t = 0; t < walk.run->size(); ++t) {
    bool all = false;
    if (left-- == 0) {
      now = Draw(random);
      left = kShortest + random.Index(kLongest - kShortest);
      all = random.Chance(0.5);  // seen whole before
      if (random.Chance(0.7)) filter.Reset();
    }
    Posture truth = recon::PostureFromBones((*walk.run)[t]);
    if (walk.number % 2 == 1) truth = recon::Mirrored(truth);
    truth = Turned(truth, now.yaw_rad);
    filter.Step(walk.frame_s, Observe(truth, now, all, random));
    if (t % kEvery != kEvery - 1) continue;
    out->input.row(row) = filter.Input().transpose();
    out->wanted.row(row) =
        ((recon::ToBoneVector(truth) - filter.Bones_m()) / recon::PriorNetwork::kBoneStep_m)
            .cast<float>()
            .transpose();
    ++row;
  }
}

}  // namespace

recon::PriorNetwork LearnPriorNetwork(const recon::PosturePrior& prior,
                                      const std::vector<recon::PriorClip>& clips,
                                      const PriorNetworkOptions& options) {
  const ThreadLimit limit(options.threads);
  auto gaussian = std::make_shared<recon::PosturePrior>(prior);
  gaussian->network = {};
  std::vector<std::vector<std::vector<BoneVector>>> runs;
  for (const recon::PriorClip& clip : clips) runs.push_back(recon::NormalisedRuns(clip));
  std::vector<Walk> walks;
  Eigen::Index rows = 0;
  for (size_t c = 0; c < clips.size(); ++c) {
    const int times = std::max(1, static_cast<int>(std::lround(options.walks * clips[c].weight)));
    for (int i = 0; i < times; ++i) {
      for (const auto& run : runs[c]) {
        walks.push_back({&run, clips[c].frame_s, walks.size(), rows});
        rows += walks.back().Examples();
      }
    }
  }
  if (rows < kPerceptronBatch) {
    throw InputError("posture prior: the motions are too short to learn a network of");
  }
  PerceptronExamples examples{RowMatrix(rows, recon::kPriorInputs), RowMatrix(rows, kBoneDims)};
  oneapi::tbb::parallel_for(size_t{0}, walks.size(), [&](size_t i) {
    if (!options.stop || !options.stop()) Take(walks[i], gaussian, options.seed, &examples);
  });
  if (options.stop && options.stop()) throw TrainInterrupted("interrupted");
  PerceptronTraining learning;
  learning.hidden = {options.hidden};
  learning.outputs = kBoneDims;
  learning.epochs = options.epochs;
  learning.seed = options.seed;
  learning.progress = options.progress;
  learning.stop = options.stop;
  constexpr float kSoft = 0.05F;  // steps; no unit
  return {TrainPerceptron(&examples, PointDistanceGradient(kSoft), learning)};
}

}  // namespace ossa::tools
