#pragma once
#include <memory>
#include <optional>

#include "recon/methods/best/prior_completion_internal.h"
#include "recon/methods/best/trust_internal.h"

namespace ossa::recon {

/// What a frame's joints in doubt are completed from.
struct CompletionInput {
  const PreparedPosture& prepared;
  const ReconstructionInput& observation;
  const SensorTraits& sensor;
  const JointWeights& trust;
  const JointArray<bool>& filter_corrects;  // left to a filter that learned the sensor's errors
  const std::optional<Posture>& before;     // camera space, what was made of the frame before
  const BoneLengths& lengths_m;             // of the person
};

/// Stage 3 of `best`: joints in doubt are propagated along the chain of bones from those that are
/// seen, which stay. How a joint in doubt lies to its parent is a matter of the sensor's own
/// confidence in its guess: after fair guesses as it did a frame before (their mean is nearer the
/// truth than any database), after poor ones as is to be expected of what is seen: by the pose
/// prior, else as plantard-2016 has it where there is a database, else as before.
class Completion {
 public:
  explicit Completion(const ReconstructorOptions& options);

  /// Finds the joints that the sensor has had but that are absent in this frame. Of a sensor that
  /// places hidden joints none is.
  void FindMissing(const PreparedPosture& prepared, const SensorTraits& sensor);
  const JointArray<bool>& missing() const { return missing_; }
  /// The posture, camera space, with every joint where it is to be believed.
  Posture Complete(const CompletionInput& input);
  /// Whether enough is seen to expect a posture of it; else the last one is held.
  bool HasExpectation(const PreparedPosture& prepared) const;
  void Reset();

 private:
  bool IsInDoubt(const PreparedPosture& prepared, const JointWeights& trust);
  Posture Expect(const CompletionInput& input);
  void StretchToSeenEnds(const JointWeights& seen, const Posture& propagated,
                         Posture& target) const;

  std::optional<PriorCompletion> prior_;     // where there is a prior
  std::unique_ptr<Reconstructor> plantard_;  // else, where there is a database
  JointArray<bool> had_{};                   // joints that were ever seen
  JointArray<bool> missing_{};               // of those: absent now
};

}  // namespace ossa::recon
