// H. P. H. Shum, E. S. L. Ho, Y. Jiang, S. Takagi, Real-Time Posture Reconstruction for Microsoft
// Kinect, IEEE Trans. Cybernetics 2013.
#include <algorithm>

#include "recon/database/nearest.h"
#include "recon/methods/methods_internal.h"
#include "recon/methods/natural_posture_internal.h"
#include "recon/orientation.h"

namespace ossa::recon {
namespace {

class Shum2013 : public NaturalPostureMethod {
 public:
  explicit Shum2013(const ReconstructorOptions& options)
      : NaturalPostureMethod(options), given_(database_) {}

  void Reset() override {
    NaturalPostureMethod::Reset();
    database_ = given_;
    added_ = 0;
  }

 private:
  /// Sec. V-B: the K nearest of all postures under eq. 9.
  std::vector<int> Select(const EnergyInputs& energy, const PreparedPosture&,
                          const ReconstructionInput& input, std::vector<int> hints) override {
    if (options_.extend_database) Extend(energy, input);
    std::vector<int> selected;
    for (const Neighbour& n : NearestPostures(*database_, energy.observed, energy.reliability,
                                              options_.neighbours, hints)) {
      selected.push_back(n.index);
    }
    return selected;
  }

  /// Sec. IX: a posture of which every joint is reliable and tracked, and which the database does
  /// not have, joins a private copy of it.
  void Extend(const EnergyInputs& energy, const ReconstructionInput& input) {
    constexpr int kMostAdded = 2000;   // by hand: a copy of the database per posture
    constexpr double kReliable = 0.9;  // R_i, a share; by hand
    const bool good = std::all_of(energy.reliability.begin(), energy.reliability.end(),
                                  [](double r) { return r > kReliable; }) &&
                      std::all_of(input.observed.state.begin(), input.observed.state.end(),
                                  [](TrackingState s) { return s == TrackingState::kTracked; });
    if (!good || added_ >= kMostAdded) return;
    const auto nearest = NearestPostures(*database_, energy.observed, energy.reliability, 1);
    const double threshold = database_->options().threshold_m;
    if (nearest[0].distance < threshold * threshold) return;
    database_ = std::make_shared<PostureDatabase>(database_->With(
        energy.observed, ComputeOrientations(ToPosture(energy.observed)), "observed"));
    ++added_;
  }

  std::shared_ptr<const PostureDatabase> given_;  // without what was added
  int added_ = 0;
};

}  // namespace

std::unique_ptr<Reconstructor> MakeShum2013(const ReconstructorOptions& options) {
  return std::make_unique<Shum2013>(options);
}

}  // namespace ossa::recon
