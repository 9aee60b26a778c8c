// H. P. H. Shum, E. S. L. Ho, Y. Jiang, S. Takagi, Real-Time Posture Reconstruction for Microsoft
// Kinect, IEEE Trans. Cybernetics 2013.
#include <algorithm>

#include "recon/database/nearest.h"
#include "recon/methods/methods_internal.h"
#include "recon/methods/natural_posture_internal.h"
#include "recon/normalise.h"
#include "recon/orientation.h"

namespace ossa::recon {
namespace {

class Shum2013 : public NaturalPostureMethod {
 public:
  explicit Shum2013(const ReconstructorOptions& options)
      : NaturalPostureMethod(options), given_(database_) {
    TakeOwnCopy();
  }

  void Reset() override {
    NaturalPostureMethod::Reset();
    TakeOwnCopy();
  }

 private:
  void TakeOwnCopy() {
    if (!options_.extend_database) return;
    own_ = std::make_shared<PostureDatabase>(*given_);
    database_ = own_;
  }

  /// Sec. V-B: the K nearest of all postures under eq. 9.
  std::vector<int> Select(const EnergyInputs& energy, const PreparedPosture& prepared,
                          const ReconstructionInput& input, std::vector<int> hints) override {
    if (own_) Extend(prepared, input);
    std::vector<int> selected;
    for (const Neighbour& n : NearestPostures(*database_, energy.observed, energy.reliability,
                                              options_.neighbours, hints)) {
      selected.push_back(n.index);
    }
    return selected;
  }

  /// Sec. IX: adds a posture whose joints are all reliable and tracked, and which the database's
  /// own filter would keep, to the person's copy of the database.
  void Extend(const PreparedPosture& prepared, const ReconstructionInput& input) {
    constexpr int kMostAdded = 2000;   // by hand: a minute of entirely new postures
    constexpr double kReliable = 0.9;  // R_i, a share; by hand
    const bool good = std::all_of(prepared.reliability.begin(), prepared.reliability.end(),
                                  [](double r) { return r > kReliable; }) &&
                      std::all_of(input.observed.state.begin(), input.observed.state.end(),
                                  [](TrackingState s) { return s == TrackingState::kTracked; });
    if (!good || own_->size() >= given_->size() + kMostAdded) return;
    const Posture standard = Retargeted(prepared.normalised, own_->bone_lengths_m());
    const PostureVector vector = ToVector(standard);
    if (own_->Has(vector)) return;
    own_->Add(vector, ComputeOrientations(standard), "observed");
  }

  std::shared_ptr<const PostureDatabase> given_;  // without added postures
  std::shared_ptr<PostureDatabase> own_;  // with added postures; none if nothing may be added
};

}  // namespace

std::unique_ptr<Reconstructor> MakeShum2013(const ReconstructorOptions& options) {
  return std::make_unique<Shum2013>(options);
}

}  // namespace ossa::recon
