#pragma once
#include <memory>
#include <optional>

#include "recon/methods/best/prior_completion_internal.h"
#include "recon/methods/best/trust_internal.h"

namespace ossa::recon {

/// What doubtful joints are completed from.
struct CompletionInput {
  const PreparedPosture& prepared;
  const ReconstructionInput& observation;
  const SensorTraits& sensor;
  const JointWeights& trust;
  const JointArray<bool>& filter_corrects;  // left to the filter that learned the sensor's errors
  const std::optional<Posture>& before;     // camera space, the result of the previous frame
  const BoneLengths& lengths_m;             // the person's
};

/// Stage 3 of `best`: propagates doubtful joints along the chain of bones from observed ones, which
/// keep their positions. The offset of a doubtful joint from its parent depends on the sensor's
/// confidence in its guess. After good guesses it is that of the frame before (their mean is nearer
/// the truth than any database); after poor ones it is predicted by the pose prior, else by
/// plantard-2016 if there is a database, else kept.
class Completion {
 public:
  explicit Completion(const ReconstructorOptions& options);

  /// Finds joints that the sensor has provided before and that are absent in this frame. A sensor
  /// that places hidden joints has none.
  void FindMissing(const PreparedPosture& prepared, const SensorTraits& sensor);
  const JointArray<bool>& missing() const { return missing_; }
  /// The completed posture, camera space.
  Posture Complete(const CompletionInput& input);
  /// Whether enough joints are observed to predict a posture; else the last one is held.
  bool HasExpectation(const PreparedPosture& prepared) const;
  void Reset();

 private:
  bool IsInDoubt(const PreparedPosture& prepared, const JointWeights& trust);
  Posture Expect(const CompletionInput& input);
  void StretchToVisibleEnds(const JointWeights& seen, const Posture& propagated,
                            Posture& target) const;

  std::optional<PriorCompletion> prior_;     // if there is a prior
  std::unique_ptr<Reconstructor> plantard_;  // else, if there is a database
  JointArray<bool> had_{};                   // joints ever observed
  JointArray<bool> missing_{};               // of these: absent now
};

}  // namespace ossa::recon
