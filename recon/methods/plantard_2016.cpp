// P. Plantard, H. P. H. Shum, F. Multon, Filtered pose graph for efficient Kinect pose
// reconstruction, Multimedia Tools and Applications 2016, section 6.
#include <algorithm>
#include <cmath>
#include <limits>

#include "recon/methods/bone_turns_internal.h"
#include "recon/methods/methods_internal.h"
#include "recon/methods/person_internal.h"
#include "recon/methods/posture_space_internal.h"

namespace ossa::recon {
namespace {

class Plantard2016 : public Reconstructor {
 public:
  explicit Plantard2016(const ReconstructorOptions& options)
      : options_(options.local_pca), seed_(options.seed), database_(options.database) {}

  ReconstructedPosture Step(const ReconstructionInput& input) override {
    const PreparedPosture prepared = person_.Prepare(input);
    if (prepared.restarted) Forget();
    EnergyInputs energy;
    energy.observed = VectorOf(prepared.normalised);
    energy.reliability = options_.use_reliability ? prepared.reliability : prepared.present;
    energy.lengths_m = database_->bone_lengths_m();
    energy.last = last_;
    energy.before_last = before_last_;
    Select(energy, prepared.dt_s);

    const PostureSpace space = MakePostureSpace(*database_, selected_, options_.dimensions);
    const Eigen::VectorXf start =
        last_ ? space.Project(*last_) : Eigen::VectorXf(space.neighbours.col(0));
    const SearchResult found =
        SearchStochastic(space, energy, options_, EnergyForm::kMeanDistance, start, seed_ + frame_);
    ++frame_;
    before_last_ = last_;
    last_ = space.Posture(found.q);
    last_dt_s_ = prepared.dt_s;
    ReconstructedPosture out{person_.InCamera(PostureOf(*last_), prepared), prepared.reliability};
    const auto weights = InverseDistances(*database_, selected_, *last_);
    out.orientation =
        TurnedOntoBones(*database_, selected_, weights, out.posture, prepared.placement.yaw_rad);
    person_.Remember(out.posture, prepared);
    return out;
  }

  void Reset() override {
    person_.Reset();
    Forget();
    frame_ = 0;
  }

 private:
  void Forget() {
    last_.reset();
    before_last_.reset();
    selected_.clear();
  }

  /// Sec. 6.2: the K best of the nodes connected to those used last; all nodes when there is no
  /// last frame, or when the best of those no longer resembles what is seen.
  void Select(const EnergyInputs& energy, double dt_s) {
    PostureVector predicted = PostureVector::Zero();
    if (last_) predicted = *last_;
    if (last_ && before_last_) {
      predicted += (*last_ - *before_last_) * static_cast<float>(dt_s / last_dt_s_);
    }
    std::vector<int> candidates;
    if (!selected_.empty()) {
      candidates = selected_;
      for (const int node : selected_) {
        const auto near = database_->neighbours(node);
        candidates.insert(candidates.end(), near.begin(), near.end());
      }
      std::sort(candidates.begin(), candidates.end());
      candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
      double best = KeepBest(candidates, energy, predicted);
      // Lost: the graph's neighbourhood is a whole edge farther off than a node of the graph can
      // be from any posture it covers. Departure: the paper searches fully on the first frame only.
      const double lost_m = 0.5 * database_->edge_threshold_m() + 0.1;
      if (best < lost_m) return;
    }
    candidates.resize(static_cast<size_t>(database_->size()));
    for (size_t i = 0; i < candidates.size(); ++i) candidates[i] = static_cast<int>(i);
    KeepBest(candidates, energy, predicted);
  }

  /// Keeps the K of lowest score S = Ss + Sc (eqs. 6-7); returns the similarity Ss of the best in
  /// metres per unit of reliability. Eqs. 6 and Sc are read as mean weighted distances.
  double KeepBest(std::vector<int>& candidates, const EnergyInputs& energy,
                  const PostureVector& predicted) {
    std::array<float, kJointCount> r;
    float trust = 1e-6F;
    for (size_t i = 0; i < kJointCount; ++i) {
      r[i] = static_cast<float>(energy.reliability[i]);
      trust += r[i];
    }
    const bool continuity = last_.has_value();
    std::vector<std::pair<float, int>> scored;
    scored.reserve(candidates.size());
    float best_similarity = std::numeric_limits<float>::max();
    for (const int node : candidates) {
      const float* p = database_->postures().data() + static_cast<size_t>(node) * kPostureDims;
      float similar = 0.0F, continuous = 0.0F;
      for (size_t i = 0; i < kJointCount; ++i) {
        const Eigen::Map<const Eigen::Vector3f> joint(p + 3 * i);
        const auto at = static_cast<Eigen::Index>(3 * i);
        if (r[i] > 0.0F) similar += r[i] * (energy.observed.segment<3>(at) - joint).norm();
        if (continuity && r[i] < 1.0F) {
          continuous += (1.0F - r[i]) * (predicted.segment<3>(at) - joint).norm();
        }
      }
      best_similarity = std::min(best_similarity, similar / trust);
      scored.emplace_back((similar + continuous) / kJointCount, node);
    }
    const size_t keep = std::min(scored.size(), static_cast<size_t>(options_.neighbours));
    std::partial_sort(scored.begin(), scored.begin() + static_cast<ptrdiff_t>(keep), scored.end());
    selected_.clear();
    for (size_t k = 0; k < keep; ++k) selected_.push_back(scored[k].second);
    return static_cast<double>(best_similarity);
  }

  LocalPcaOptions options_;
  uint64_t seed_;
  std::shared_ptr<const PostureDatabase> database_;
  Person person_;
  std::optional<PostureVector> last_, before_last_;
  double last_dt_s_ = 1.0 / 30.0;
  std::vector<int> selected_;  // the nodes used in the last frame
  uint64_t frame_ = 0;
};

}  // namespace

std::unique_ptr<Reconstructor> MakePlantard2016(const ReconstructorOptions& options) {
  return std::make_unique<Plantard2016>(options);
}

}  // namespace ossa::recon
