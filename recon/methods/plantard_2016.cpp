// P. Plantard, H. P. H. Shum, F. Multon, Filtered pose graph for efficient Kinect pose
// reconstruction, Multimedia Tools and Applications 2016, section 6. The graph of section 4 is in
// recon/database. Reliability is that of Shum 2013, which section 5 reviews. Departure: eq. 3 as
// printed, one minus the mean cosine, calls a joint that moves straight on unreliable; the angle of
// the text is taken.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "recon/methods/methods_internal.h"
#include "recon/methods/natural_posture_internal.h"

namespace ossa::recon {
namespace {

// Departure: the reliability is Shum 2013's (eqs. 1-8 there), which sec. 5 reviews. Its eq. 3, one
// minus the mean angle, has neither floor nor roof nor a unit; in radians it would call every joint
// wrong that turns by 57 degrees between two frames. Its eq. 4 lets one bone count for more than 1.
// Departure: eqs. 6, 8 and 9 print differences of positions where a norm or a square was meant:
// signs would cancel. The energies are read as the squares of [37] (Shum 2013), which the paper
// says it takes them from; eq. 8 is a mean where Shum's eq. 10 is a sum. Read as distances, eq. 8
// lets a whole leg go where that keeps the other joints in place, and eq. 9 holds the posture to
// one neighbour.
LocalPcaOptions WithMeanControl(LocalPcaOptions options) {
  options.control /= kJointCount;
  return options;
}

class Plantard2016 : public NaturalPostureMethod {
 public:
  explicit Plantard2016(const ReconstructorOptions& options) : NaturalPostureMethod(options) {
    options_ = WithMeanControl(options_);
  }

 private:
  /// Sec. 6.2: the K best of the nodes connected to those used last (each is connected to itself,
  /// algorithm 3); all nodes when there is no last frame, or when the best of those no longer
  /// resembles what is seen.
  std::vector<int> Select(const EnergyInputs& energy, const PreparedPosture& prepared,
                          const ReconstructionInput&, std::vector<int> before) override {
    std::optional<PostureVector> predicted = energy.last;
    if (energy.last && energy.before_last) {
      const auto share = static_cast<float>(prepared.dt_s / last_dt_s_);
      *predicted += (*energy.last - *energy.before_last) * share;
    }
    last_dt_s_ = prepared.dt_s;
    std::vector<int> candidates = before;
    if (!before.empty()) {
      for (const int node : before) {
        const auto near = database_->neighbours(node);
        candidates.insert(candidates.end(), near.begin(), near.end());
      }
      std::sort(candidates.begin(), candidates.end());
      candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
      // Lost: the graph's neighbourhood is a whole edge farther off than a node of the graph can
      // be from any posture it covers. Departure: the paper searches fully on the first frame only.
      const double lost_m = 0.5 * database_->edge_threshold_m() + 0.1;
      if (KeepBest(candidates, energy, predicted) < lost_m) return candidates;
    }
    candidates.resize(static_cast<size_t>(database_->size()));
    std::iota(candidates.begin(), candidates.end(), 0);
    KeepBest(candidates, energy, predicted);
    return candidates;
  }

  /// Keeps the K of lowest score S = Ss + Sc (eqs. 6-7); returns the similarity Ss of the best in
  /// metres per unit of reliability. Eqs. 6 and Sc are read as mean weighted distances.
  double KeepBest(std::vector<int>& candidates, const EnergyInputs& energy,
                  const std::optional<PostureVector>& predicted) const {
    JointArray<float> r;
    float trust = 1e-6F;
    for (size_t i = 0; i < kJointCount; ++i) {
      r[i] = static_cast<float>(energy.reliability[i]);
      trust += r[i];
    }
    std::vector<std::pair<float, int>> scored;
    scored.reserve(candidates.size());
    float best_similarity = std::numeric_limits<float>::max();
    for (const int node : candidates) {
      const float* p = database_->postures().data() + static_cast<size_t>(node) * kPostureDims;
      float similar = 0.0F, continuous = 0.0F;
      for (size_t i = 0; i < kJointCount; ++i) {
        const Eigen::Map<const Eigen::Vector3f> joint(p + 3 * i);
        const auto at = FirstCoordinate(i);
        if (r[i] > 0.0F) similar += r[i] * (energy.observed.segment<3>(at) - joint).norm();
        if (predicted && r[i] < 1.0F) {
          continuous += (1.0F - r[i]) * (predicted->segment<3>(at) - joint).norm();
        }
      }
      best_similarity = std::min(best_similarity, similar / trust);
      scored.emplace_back((similar + continuous) / kJointCount, node);
    }
    const size_t keep = std::min(scored.size(), static_cast<size_t>(options_.neighbours));
    std::partial_sort(scored.begin(), scored.begin() + static_cast<ptrdiff_t>(keep), scored.end());
    candidates.clear();
    for (size_t k = 0; k < keep; ++k) candidates.push_back(scored[k].second);
    return static_cast<double>(best_similarity);
  }

  double last_dt_s_ = 1.0 / 30.0;
};

}  // namespace

std::unique_ptr<Reconstructor> MakePlantard2016(const ReconstructorOptions& options) {
  return std::make_unique<Plantard2016>(options);
}

}  // namespace ossa::recon
