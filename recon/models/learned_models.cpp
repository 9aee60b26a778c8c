#include "recon/models/learned_models.h"

#include <algorithm>
#include <cmath>

#include "depth/base/checksummed_container.h"
#include "depth/base/error.h"
#include "depth/base/naming_the_file.h"
#include "depth/base/perceptron/perceptron_file.h"
#include "recon/database/posture_database.h"

namespace ossa::recon {
namespace {

constexpr ContainerFormat kLearnedFormat = {
    {'O', 'S', 'S', 'A', 'G', 'P', '0', '0'}, LearnedModels::kVersion, "learned reconstruction"};
// Constants: versions of the format; counts by hand.

constexpr uint32_t kOldestVersion = 2, kVersionOfSteps = 3, kVersionOfInfluences = 4;

// More than any valid file holds; damaged counts are refused before they cost memory or time.
constexpr uint64_t kMostModels = LearnOptions::kMostRegions;
constexpr uint64_t kMostRows = LearnOptions::kMostSamples;

void PutMatrix(PayloadWriter& out, const Eigen::MatrixXf& m) {
  out.Put<uint32_t>(static_cast<uint32_t>(m.rows()));
  out.Put<uint32_t>(static_cast<uint32_t>(m.cols()));
  out.PutArray(std::span<const float>(m.data(), static_cast<size_t>(m.size())));
}

Eigen::MatrixXf GetMatrix(PayloadReader& in, std::string_view field) {
  const auto rows = in.Get<uint32_t>(field), cols = in.Get<uint32_t>(field);
  const auto values = in.GetVector<float>(field);
  if (uint64_t{rows} * cols != values.size()) in.Fail(field, "expected rows times columns numbers");
  for (const float v : values) {
    if (!(std::abs(v) < 1e6F)) in.Fail(field, "expected finite numbers");
  }
  return Eigen::Map<const Eigen::MatrixXf>(values.data(), rows, cols);
}

void PutProcess(PayloadWriter& out, const GaussianProcess& model) {
  out.Put(model.parameters());
  PutMatrix(out, model.inputs().cast<float>());
  PutMatrix(out, model.outputs().cast<float>());
}

/// The factor is not in the file; it is recomputed from the samples.
GaussianProcess GetProcess(PayloadReader& in, Eigen::Index features) {
  const auto p = in.Get<GaussianProcessParameters>("kernel");
  for (const double v : {p.theta0, p.theta1, p.w, p.beta}) {
    if (!(v > 1e-9 && v < 1e9)) in.Fail("kernel", "expected positive parameters");
  }
  const Eigen::MatrixXf x = GetMatrix(in, "inputs"), y = GetMatrix(in, "outputs");
  if (x.rows() < 1 || x.rows() > static_cast<Eigen::Index>(kMostRows) || x.cols() != features ||
      y.rows() != x.rows() || y.cols() != 3) {
    in.Fail("inputs", "expected samples of this joint's feature with three outputs each");
  }
  GaussianProcess model(p, x.cast<double>(), y.cast<double>());
  if (!model.factor().allFinite()) in.Fail("kernel", "the covariance is not positive definite");
  return model;
}

LocalMixture GetMixture(PayloadReader& in, Eigen::Index features) {
  const auto count = in.Get<uint64_t>("local models");
  if (count > kMostModels) in.Fail("local models", "expected at most 1000");
  std::vector<GaussianProcess> models;
  for (uint64_t q = 0; q < count; ++q) models.push_back(GetProcess(in, features));
  return LocalMixture(std::move(models));
}

std::vector<PosturePair> GetExemplars(PayloadReader& in) {
  const Eigen::MatrixXf observed = GetMatrix(in, "exemplars"), residual = GetMatrix(in, "offsets");
  const Eigen::MatrixXf known = GetMatrix(in, "known joints");
  if (observed.rows() != kPostureDims || residual.rows() != kPostureDims ||
      known.rows() != kJointCount || residual.cols() != observed.cols() ||
      known.cols() != observed.cols()) {
    in.Fail("exemplars", "expected 60 numbers, 60 offsets and 20 flags a pair");
  }
  std::vector<PosturePair> exemplars;
  for (Eigen::Index i = 0; i < observed.cols(); ++i) {
    PosturePair& pair = exemplars.emplace_back();
    pair.observed = ToPosture(observed.col(i));
    pair.residual = ToPosture(residual.col(i));
    for (size_t j = 0; j < kJointCount; ++j) pair.known[j] = known(static_cast<Eigen::Index>(j), i);
  }
  return exemplars;
}

PoseCorrection GetCorrection(PayloadReader& in) {
  PoseCorrection c;
  c.centres = GetMatrix(in, "centres");
  c.weights = GetMatrix(in, "weights");
  const Eigen::MatrixXf mean = GetMatrix(in, "mean offsets");
  c.width = in.Get<double>("width");
  c.proportions = in.Get<BoneLengths>("proportions");
  for (const double p : c.proportions) {
    if (!(p >= 0.0 && p < PoseCorrection::kMostProportion)) {
      in.Fail("proportions", "expected 0 to 5");
    }
  }
  const Eigen::Index features = CorrectionFeature(Posture()).size();
  const bool fits =
      c.weights.size() == 0 ||
      (c.centres.rows() == features && c.weights.rows() == c.centres.cols() + features &&
       c.weights.cols() == kPostureDims && mean.size() == kPostureDims);
  if (!fits || !(c.width > 1e-3 && c.width < 1e3)) {
    in.Fail("centres", "expected a correction of whole postures");
  }
  c.mean = Eigen::Map<const Eigen::VectorXf>(mean.data(), mean.size());
  return c;
}

/// Weights of left and midline joints; an empty matrix if nothing was learned.
void PutFilter(PayloadWriter& out, const LinearFilter& filter) {
  out.Put(filter.step_s);
  for (const auto& of_output : filter.weights) {
    for (size_t joint = 0; joint < kJointCount; ++joint) {
      if (LearnedSideOf(joint) == joint) PutMatrix(out, of_output[joint]);
    }
  }
}

LinearFilter GetFilter(PayloadReader& in) {
  LinearFilter filter;
  filter.step_s = in.Get<double>("filter's step");
  if (filter.step_s != 0.0 && !LinearFilter::CanLearnOf(filter.step_s)) {
    in.Fail("filter's step", "expected 0, or 0.001 s to 1 s");
  }
  for (const auto output : {LinearFilter::kNow, LinearFilter::kBefore}) {
    for (size_t joint = 0; joint < kJointCount; ++joint) {
      if (LearnedSideOf(joint) != joint) continue;
      Eigen::MatrixXf& weights = filter.weights[output][joint];
      weights = GetMatrix(in, "filter's weights");
      const bool steps = weights.rows() == FilterFeatureSize(joint) && weights.cols() == 3;
      const bool influences = weights.rows() == InfluenceFeatureSize(output) && weights.cols() == 1;
      if (weights.size() > 0 && !steps && !influences) {
        in.Fail(
            "filter's weights",
            "expected three numbers for each step that the joint sees, or one for each influence");
      }
    }
  }
  return filter;
}

void PutWindow(PayloadWriter& out, const WindowCorrection& window) {
  out.Put<uint32_t>(static_cast<uint32_t>(window.network.layers.front().bias.size()));
  PutPerceptron(out, window.network);
  out.Put(window.gains);
}

WindowCorrection GetWindow(PayloadReader& in) {
  WindowCorrection window;
  const Eigen::Index hidden = GetUnits(in);
  window.network = GetPerceptron(in, {WindowSize(), hidden, kPostureDims});
  window.gains = in.Get<JointWeights>("gains");
  for (const double gain : window.gains) {
    if (!(gain >= 0.0 && gain <= 1.0)) in.Fail("gains", "expected 0 to 1");
  }
  return window;
}

/// The oldest version that can hold the models, so that older programs can read them.
uint32_t VersionFor(const LearnedModels& models) {
  if (!models.window.empty()) return LearnedModels::kVersion;
  return models.filter.HasInfluences() ? kVersionOfInfluences : kVersionOfSteps;
}

Eigen::Index FeatureSize(size_t joint) { return JointFeature(Posture(), joint).size(); }

struct JointSamples {
  Eigen::MatrixXd inputs, outputs;
};

JointSamples CollectSamples(const std::vector<PosturePair>& pairs, size_t joint) {
  JointSamples s;
  const auto known = std::count_if(pairs.begin(), pairs.end(),
                                   [joint](const PosturePair& p) { return p.known[joint] > 0.0; });
  s.inputs.resize(known, FeatureSize(joint));
  s.outputs.resize(known, 3);
  Eigen::Index row = 0;
  for (const PosturePair& pair : pairs) {
    if (pair.known[joint] == 0.0) continue;
    s.inputs.row(row) = JointFeature(pair.observed, joint).transpose();
    s.outputs.row(row++) = pair.residual.position_m[joint].transpose();
  }
  return s;
}

Eigen::MatrixXd EveryNthRow(const Eigen::MatrixXd& m, Eigen::Index most) {
  if (m.rows() <= most) return m;
  Eigen::MatrixXd out(most, m.cols());
  for (Eigen::Index i = 0; i < most; ++i) out.row(i) = m.row(i * m.rows() / most);
  return out;
}

}  // namespace

LearnedModels LearnedModels::Learn(const std::vector<PosturePair>& pairs,
                                   const LearnOptions& options,
                                   const std::function<bool(int)>& progress) {
  LearnedModels out;
  out.pair_count = pairs.size();
  if (options.correction.centres > 0) {
    out.correction = PoseCorrection::Learn(pairs, options.correction);
    out.window = WindowCorrection::Learn(pairs, options.window);
    out.filter = LinearFilter::Learn(pairs, options.filter);
  }
  if (!options.processes) return out;
  out.exemplars = Thinned(pairs, options.most_pairs);
  for (size_t joint = 0; joint < kJointCount; ++joint) {
    if (progress && !progress(static_cast<int>(joint))) return out;
    const JointSamples s = CollectSamples(out.exemplars, joint);
    if (s.inputs.rows() < LearnOptions::kFewestPairs) continue;
    out.mixtures[joint] = LocalMixture::Learn(s.inputs, s.outputs, options.mixture);
    constexpr Eigen::Index kForParameters = 200;
    const auto parameters = LearnParameters(EveryNthRow(s.inputs, kForParameters),
                                            EveryNthRow(s.outputs, kForParameters), {});
    out.full[joint] = GaussianProcess(parameters, EveryNthRow(s.inputs, options.full_samples),
                                      EveryNthRow(s.outputs, options.full_samples));
  }
  return out;
}

void LearnedModels::Save(const std::filesystem::path& path) const {
  PayloadWriter out;
  out.Put(pair_count);
  for (size_t joint = 0; joint < kJointCount; ++joint) {
    out.Put<uint64_t>(mixtures[joint].models().size());
    for (const GaussianProcess& model : mixtures[joint].models()) PutProcess(out, model);
    out.Put<uint8_t>(full[joint].size() > 0 ? 1 : 0);
    if (full[joint].size() > 0) PutProcess(out, full[joint]);
  }
  const auto n = static_cast<Eigen::Index>(exemplars.size());
  Eigen::MatrixXf observed(kPostureDims, n), residual(kPostureDims, n), known(kJointCount, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const PosturePair& pair = exemplars[static_cast<size_t>(i)];
    observed.col(i) = ToVector(pair.observed);
    residual.col(i) = ToVector(pair.residual);
    for (size_t j = 0; j < kJointCount; ++j) {
      known(static_cast<Eigen::Index>(j), i) = static_cast<float>(pair.known[j]);
    }
  }
  for (const Eigen::MatrixXf* m : {&observed, &residual, &known}) PutMatrix(out, *m);
  PutMatrix(out, correction.centres);
  PutMatrix(out, correction.weights);
  PutMatrix(out, correction.mean);
  out.Put(correction.width);
  out.Put(correction.proportions);
  PutFilter(out, filter);
  ContainerFormat format = kLearnedFormat;
  format.version = VersionFor(*this);
  if (format.version == kVersion) PutWindow(out, window);
  WriteContainer(path, format, out.bytes());
}

bool LearnedModels::IsFile(const std::filesystem::path& path) {
  return IsContainer(path, kLearnedFormat);
}

LearnedModels LearnedModels::Load(const std::filesystem::path& path) {
  const ContainerFormat format = ReadContainerFormat(path, kLearnedFormat, kOldestVersion);
  return NamingTheFile(
      path, [&] { return FromBytes(ReadContainer(path, format), path.string(), format.version); });
}

LearnedModels LearnedModels::FromBytes(std::span<const std::byte> bytes, const std::string& name,
                                       uint32_t version) {
  PayloadReader in(bytes, name);
  LearnedModels out;
  out.pair_count = in.Get<uint64_t>("pair count");
  for (size_t joint = 0; joint < kJointCount; ++joint) {
    out.mixtures[joint] = GetMixture(in, FeatureSize(joint));
    if (in.Get<uint8_t>("full process") != 0) out.full[joint] = GetProcess(in, FeatureSize(joint));
  }
  out.exemplars = GetExemplars(in);
  out.correction = GetCorrection(in);
  if (version >= kVersionOfSteps) out.filter = GetFilter(in);
  if (version > kVersionOfInfluences) out.window = GetWindow(in);
  in.ExpectEnd();
  return out;
}

}  // namespace ossa::recon
