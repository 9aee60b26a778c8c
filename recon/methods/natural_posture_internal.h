#pragma once
#include "recon/methods/posture_space_internal.h"
#include "recon/methods/prepared_posture_internal.h"

namespace ossa::recon {

/// The common part of shum-2013 and plantard-2016: reconstruction in the natural posture space of
/// selected database postures (Shum 2013 secs. V-B, VI, VII-B). They differ in the selection.
class NaturalPostureMethod : public Reconstructor {
 public:
  explicit NaturalPostureMethod(const ReconstructorOptions& options)
      : options_(options.local_pca),
        database_(options.database),
        seed_(options.seed),
        person_({}, options.bones_m) {}

  ReconstructedPosture Step(const ReconstructionInput& input) override;
  std::optional<BoneLengths> Bones() const override { return person_.size().Latest(); }
  void Reset() override;

 protected:
  /// The postures that span the space, most similar first, given those of the previous frame.
  virtual std::vector<int> Select(const EnergyInputs& energy, const PreparedPosture& prepared,
                                  const ReconstructionInput& input,
                                  std::vector<int> selected_before) = 0;

  LocalPcaOptions options_;
  std::shared_ptr<const PostureDatabase> database_;

 private:
  EnergyInputs Inputs(const PreparedPosture& prepared) const;
  SearchResult Search(const PostureSpace& space, const EnergyInputs& energy) const;

  uint64_t seed_;
  Person person_;
  std::optional<PostureVector> last_, before_last_;  // p_{x-1}, p_{x-2}
  std::vector<int> selected_;
  uint64_t frame_ = 0;
};

}  // namespace ossa::recon
