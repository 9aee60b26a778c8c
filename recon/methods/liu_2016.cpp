// Z. Liu, L. Zhou, H. Leung, H. P. H. Shum, Kinect posture reconstruction based on a local mixture
// of Gaussian process models, IEEE TVCG 2016, sections 4.3-4.5; its baselines: one full Gaussian
// process a joint (Zhou et al. 2014), and the offsets of the nearest pairs (after Shen et al.
// 2012).
#include <algorithm>
#include <cmath>

#include "recon/database/posture_database.h"
#include "recon/methods/methods_internal.h"
#include "recon/methods/prepared_posture_internal.h"
#include "recon/methods/reach_internal.h"
#include "recon/models/learned_models.h"

namespace ossa::recon {
namespace {

/// Predicted offset of one joint, with the variance of each coordinate relative to the noise
/// variance: 0 certain, large uncertain.
struct OffsetPrediction {
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
  double unsureness = 1e9;
  double deviation_m = 1e9;  // standard deviation
};

/// Sec. 4.5 with any predictor of offsets.
class OffsetReconstructor : public Reconstructor {
 public:
  OffsetReconstructor(const ReconstructorOptions& options, bool (*holds)(const LearnedModels&))
      : options_(options.gaussian_process), models_(LearnedThatHolds(options, holds)) {}

  ReconstructedPosture Step(const ReconstructionInput& input) override {
    const PreparedPosture prepared = person_.Prepare(input);
    if (prepared.restarted) last_.reset(), before_last_.reset();
    expected_ = Expected(prepared);
    BeginFrame(prepared);
    const JointWeights seen = SeenJoints(prepared);
    const Posture made = Corrected(prepared, seen);
    ReconstructedPosture out{Placed(Scaled(made, prepared.scale), prepared.placement),
                             prepared.reliability};
    if (IsTrunkUnseen(seen)) PullIntoReach(out.posture, seen, person_.size().lengths_m());
    before_last_ = last_;
    last_ = out.posture;
    last_dt_s_ = prepared.dt_s;
    person_.Remember(out.posture, prepared);
    return out;
  }

  void Reset() override {
    person_.Reset();
    last_.reset();
    before_last_.reset();
  }

 protected:
  virtual void BeginFrame(const PreparedPosture&) {}
  virtual OffsetPrediction Predict(const PreparedPosture& prepared, size_t joint) = 0;
  /// `made`: the offset that minimises eq. 22, and the uncertainty of its prediction.
  virtual void Learn(const PreparedPosture&, size_t, const OffsetPrediction& /*made*/) {}

  GaussianProcessOptions options_;
  std::shared_ptr<const LearnedModels> models_;

 private:
  /// Adds the offsets that minimise eq. 22. Departure: an absent joint, which keeps its offset from
  /// the parent in the previous result, moves with its parent. With its own temporal term alone it
  /// would drift away by the parent's offset, every frame.
  Posture Corrected(const PreparedPosture& prepared, const JointWeights& seen) {
    Posture made = prepared.scaled;
    Posture offsets;
    for (size_t i = 0; i < kJointCount; ++i) {
      offsets.position_m[i] = Eigen::Vector3d::Zero();
      if (seen[i] > 0.0) {
        const OffsetPrediction p = Predict(prepared, i);
        offsets.position_m[i] = MinimisingOffset(p, prepared, i);
        Learn(prepared, i, {offsets.position_m[i], p.unsureness, p.deviation_m});
      } else if (i != 0) {
        offsets.position_m[i] = offsets.position_m[ParentOf(i)];
      }
      made.position_m[i] += offsets.position_m[i];
    }
    return made;
  }

  /// 2 M_{t-1} - M_{t-2} of eq. 20 in this frame's normalised space. Departure: both postures are
  /// stored in camera space. Normalised ones would rotate and jump with every error of the hips by
  /// which the frame is normalised, and the temporal term would propagate that.
  std::optional<Posture> Expected(const PreparedPosture& prepared) const {
    if (!last_ || !before_last_) return std::nullopt;
    const double share = prepared.dt_s / last_dt_s_;  // frames need not be evenly spaced
    Posture expected;
    for (size_t i = 0; i < kJointCount; ++i) {
      expected.position_m[i] =
          last_->position_m[i] + share * (last_->position_m[i] - before_last_->position_m[i]);
    }
    return Scaled(Normalised(expected, prepared.placement), 1.0 / prepared.scale);
  }

  /// argmin over y of eq. 22. Departure: the three terms are quadratic in y, so the minimum has a
  /// closed form and needs no sampling. The spatial term's precision is expressed in units of the
  /// noise, which makes the weights 0.6 / 0.2 / 0.2 comparable: without units the paper's sum of a
  /// log likelihood and square metres is meaningless.
  ///
  /// The result is (1 - b) (X + y) + b (2 M' - M''), where b is the temporal share of all weights.
  /// Its response to a jump has poles of modulus sqrt(b). Near b = 1, where a joint is neither
  /// certain nor reliable, an earlier observation would continue at constant speed and the current
  /// one would have no weight. The spatial weight is therefore never smaller than the temporal one
  /// ("should be set the largest", sec. 4.5): b <= 1/2 halves an error every two frames. Far from
  /// all samples the predicted offset is zero, so this keeps the joint near its observation.
  Eigen::Vector3d MinimisingOffset(const OffsetPrediction& p, const PreparedPosture& prepared,
                                   size_t i) const {
    const double spatial =
        std::max(options_.spatial / (1.0 + p.unsureness), options_.temporal);  // eq. 7
    const double r = prepared.reliability[i];
    const double reliability = options_.reliability * r * r;  // eq. 21
    Eigen::Vector3d sum = spatial * p.offset;
    double total = spatial + reliability;
    if (expected_) {
      const Eigen::Vector3d target = expected_->position_m[i] - prepared.scaled.position_m[i];
      sum += options_.temporal * target;  // eq. 20
      total += options_.temporal;
    }
    return total > 1e-9 ? Eigen::Vector3d(sum / total) : Eigen::Vector3d::Zero();
  }

  Person person_;
  std::optional<Posture> last_, before_last_;  // M_{t-1}, M_{t-2}: results, camera space
  std::optional<Posture> expected_;
  double last_dt_s_ = 1.0 / 30.0;
};

class Liu2016 : public OffsetReconstructor {
 public:
  explicit Liu2016(const ReconstructorOptions& options)
      : OffsetReconstructor(options, [](const LearnedModels& learned) {
          return std::any_of(learned.mixtures.begin(), learned.mixtures.end(),
                             [](const LocalMixture& mixture) { return !mixture.empty(); });
        }) {}

  void Reset() override {
    OffsetReconstructor::Reset();
    own_.fill(std::nullopt);
    seen_.fill(0);
  }

 protected:
  OffsetPrediction Predict(const PreparedPosture& prepared, size_t joint) override {
    const LocalMixture& mixture = MixtureOf(joint);
    if (mixture.empty()) return {};
    const auto p = mixture.Predict(JointFeature(prepared.scaled, joint), options_.nearby_models);
    return {p.mean, p.variance / std::max(p.noise, 1e-12), std::sqrt(p.variance)};
  }

  /// Algorithm 2, with the posture that minimises eq. 22: the spatial prediction alone holds
  /// nothing new for the model. Samples are taken from reliable joints, and must be certain if a
  /// model is near; if none is, no prediction is certain, and a new model is created. Departure:
  /// one of kEvery frames, because 30 postures per second add nothing new.
  void Learn(const PreparedPosture& prepared, size_t joint, const OffsetPrediction& made) override {
    // By hand: shares of R_i and of the noise variance, and a standard deviation that is certain
    // whatever the noise.
    constexpr double kReliable = 0.9, kSure = 0.5, kSure_m = 0.02;
    constexpr uint64_t kEvery = 10;  // frames per sample of a joint; by hand, three per second
    const LocalMixture& mixture = MixtureOf(joint);
    if (!options_.incremental || mixture.empty()) return;
    if (prepared.reliability[joint] < kReliable || ++seen_[joint] % kEvery != 0) return;
    const LocalMixtureOptions options;
    const Eigen::VectorXd feature = JointFeature(prepared.scaled, joint);
    const bool is_near = mixture.Similarity(feature) > options.w_similar;
    if (is_near && made.unsureness > kSure && made.deviation_m > kSure_m) return;
    if (!own_[joint]) own_[joint] = models_->mixtures[joint];
    own_[joint]->Update(feature, made.offset, options);
  }

 private:
  const LocalMixture& MixtureOf(size_t joint) const {
    return own_[joint] ? *own_[joint] : models_->mixtures[joint];
  }

  // This person's models, only for joints with online samples: they take megabytes, which short
  // visits should not cost.
  JointArray<std::optional<LocalMixture>> own_;
  JointArray<uint64_t> seen_{};  // number of reliable frames
};

class FullGp : public OffsetReconstructor {
 public:
  explicit FullGp(const ReconstructorOptions& options)
      : OffsetReconstructor(options, [](const LearnedModels& learned) {
          return std::any_of(learned.full.begin(), learned.full.end(),
                             [](const GaussianProcess& process) { return process.size() > 0; });
        }) {}

 protected:
  OffsetPrediction Predict(const PreparedPosture& prepared, size_t joint) override {
    const GaussianProcess& model = models_->full[joint];
    if (model.size() == 0) return {};
    const auto p = model.Predict(JointFeature(prepared.scaled, joint));
    return {p.mean, p.variance / p.noise};
  }
};

/// Mean offset of the nearest training pairs, weighted by distance.
class Exemplar : public OffsetReconstructor {
 public:
  explicit Exemplar(const ReconstructorOptions& options)
      : OffsetReconstructor(
            options, [](const LearnedModels& learned) { return !learned.exemplars.empty(); }) {
    postures_.resize(kPostureDims, static_cast<Eigen::Index>(models_->exemplars.size()));
    for (Eigen::Index i = 0; i < postures_.cols(); ++i) {
      postures_.col(i) = ToVector(models_->exemplars[static_cast<size_t>(i)].observed);
    }
  }

 protected:
  void BeginFrame(const PreparedPosture& prepared) override {
    constexpr size_t kNearest = 10;  // by hand; Shen et al. 2012 give no value
    const PostureVector query = ToVector(prepared.scaled);
    const Eigen::VectorXf d = (postures_.colwise() - query).colwise().squaredNorm().transpose();
    nearest_.clear();
    for (Eigen::Index i = 0; i < d.size(); ++i) nearest_.emplace_back(d[i], i);
    const size_t keep = std::min(kNearest, nearest_.size());
    std::partial_sort(nearest_.begin(), nearest_.begin() + static_cast<ptrdiff_t>(keep),
                      nearest_.end());
    nearest_.resize(keep);
  }

  OffsetPrediction Predict(const PreparedPosture&, size_t joint) override {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double total = 0.0;
    for (const auto& [d2, i] : nearest_) {
      const PosturePair& pair = models_->exemplars[static_cast<size_t>(i)];
      if (pair.known[joint] == 0.0) continue;
      const double weight = 1.0 / (0.01 + static_cast<double>(d2));
      sum += weight * pair.residual.position_m[joint];
      total += weight;
    }
    if (total == 0.0) return {};
    return {sum / total, 0.0};
  }

 private:
  Eigen::Matrix<float, kPostureDims, Eigen::Dynamic> postures_;
  std::vector<std::pair<float, Eigen::Index>> nearest_;
};

}  // namespace

std::unique_ptr<Reconstructor> MakeLiu2016(const ReconstructorOptions& options) {
  return std::make_unique<Liu2016>(options);
}

std::unique_ptr<Reconstructor> MakeFullGp(const ReconstructorOptions& options) {
  return std::make_unique<FullGp>(options);
}

std::unique_ptr<Reconstructor> MakeExemplar(const ReconstructorOptions& options) {
  return std::make_unique<Exemplar>(options);
}

}  // namespace ossa::recon
