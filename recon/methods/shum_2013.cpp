// H. P. H. Shum, E. S. L. Ho, Y. Jiang, S. Takagi, Real-Time Posture Reconstruction for Microsoft
// Kinect, IEEE Trans. Cybernetics 2013.
#include <algorithm>

#include "recon/database/nearest.h"
#include "recon/methods/bone_turns_internal.h"
#include "recon/methods/methods_internal.h"
#include "recon/methods/person_internal.h"
#include "recon/methods/posture_space_internal.h"

namespace ossa::recon {
namespace {

class Shum2013 : public Reconstructor {
 public:
  explicit Shum2013(const ReconstructorOptions& options)
      : options_(options.local_pca), seed_(options.seed), database_(options.database) {}

  ReconstructedPosture Step(const ReconstructionInput& input) override {
    const PreparedPosture prepared = person_.Prepare(input);
    if (prepared.restarted) last_.reset(), before_last_.reset();
    EnergyInputs energy = Inputs(prepared);
    if (options_.extend_database) Extend(energy, input);
    FindNeighbours(energy);
    const PostureSpace space = MakePostureSpace(*database_, hints_, options_.dimensions);
    // Sec. VI-E: start from the posture made last, so that postures like it are always explored.
    const Eigen::VectorXf start =
        last_ ? space.Project(*last_) : Eigen::VectorXf(space.neighbours.col(0));
    const SearchResult found =
        options_.solver == "ceres"
            ? SearchCeres(space, energy, options_, start)
            : SearchStochastic(space, energy, options_, EnergyForm::kSumOfSquares, start,
                               seed_ + frame_);
    ++frame_;
    before_last_ = last_;
    last_ = space.Posture(found.q);
    ReconstructedPosture out{person_.InCamera(PostureOf(*last_), prepared), prepared.reliability};
    const auto weights = InverseDistances(*database_, hints_, *last_);
    out.orientation =
        TurnedOntoBones(*database_, hints_, weights, out.posture, prepared.placement.yaw_rad);
    person_.Remember(out.posture, prepared);
    return out;
  }

  void Reset() override {
    person_.Reset();
    last_.reset();
    before_last_.reset();
    hints_.clear();
    frame_ = 0;
  }

 private:
  EnergyInputs Inputs(const PreparedPosture& prepared) const {
    EnergyInputs energy;
    energy.observed = VectorOf(prepared.normalised);
    // Method B of the paper: all joints seen count alike.
    energy.reliability = options_.use_reliability ? prepared.reliability : prepared.present;
    energy.lengths_m = database_->bone_lengths_m();
    energy.last = last_;
    energy.before_last = before_last_;
    return energy;
  }

  void FindNeighbours(const EnergyInputs& energy) {
    const auto nearest = NearestPostures(*database_, energy.observed, energy.reliability,
                                         options_.neighbours, hints_);
    hints_.clear();
    for (const Neighbour& n : nearest) hints_.push_back(n.index);
  }

  /// Sec. IX: a posture of which every joint is reliable and tracked, and which the database does
  /// not have, joins a private copy of it.
  void Extend(const EnergyInputs& energy, const ReconstructionInput& input) {
    constexpr int kMostAdded = 2000;
    constexpr double kReliable = 0.9;
    const bool good = std::all_of(energy.reliability.begin(), energy.reliability.end(),
                                  [](double r) { return r > kReliable; }) &&
                      std::all_of(input.observed.state.begin(), input.observed.state.end(),
                                  [](TrackingState s) { return s == TrackingState::kTracked; });
    if (!good || added_ >= kMostAdded) return;
    const auto nearest = NearestPostures(*database_, energy.observed, energy.reliability, 1);
    const double threshold = database_->options().threshold_m;
    if (nearest[0].distance < threshold * threshold) return;
    database_ = std::make_shared<PostureDatabase>(database_->With(energy.observed, "observed"));
    ++added_;
  }

  LocalPcaOptions options_;
  uint64_t seed_;
  std::shared_ptr<const PostureDatabase> database_;
  Person person_;
  std::optional<PostureVector> last_, before_last_;
  std::vector<int> hints_;  // the last frame's neighbours
  uint64_t frame_ = 0;
  int added_ = 0;
};

}  // namespace

std::unique_ptr<Reconstructor> MakeShum2013(const ReconstructorOptions& options) {
  return std::make_unique<Shum2013>(options);
}

}  // namespace ossa::recon
