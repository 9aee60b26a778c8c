#pragma once

namespace ossa::recon {

// Constants: chosen on ten rendered scenes of validation subjects, from trusts of 0.01 to 0.3 and
// confidences of 0.25 to 1.

/// Properties of a sensor's skeletons that `best` depends on.
struct SensorTraits {
  /// Weight of an inferred joint, in [0, 1].
  double inferred_trust = 0.1;
  /// Confidence in (0, 1] above which an inferred joint is a good guess: a few frames of such
  /// guesses are nearer the truth than the prediction of a database or prior.
  double fair_confidence = 0.75;
  /// Joints were already refined at the depth image: its surface at them is no further evidence.
  bool surface_is_known = false;
  /// The sensor places joints that it does not see.
  bool places_hidden_joints = false;
  /// Weight of trunk joints when bone lengths are imposed, relative to the first joint of a limb, >
  /// 0. Most sensors define the trunk joints differently, so they move first.
  double trunk_firmness = 0.1;
};

/// `refined`: the joints come from the cascaded refinement at the depth image, which was trained to
/// place hidden joints and is most accurate at the trunk. `has_depth`: there is a depth image, and
/// inferred joints were checked against it (ReliabilityOptions::use_depth); without one, most
/// guesses of an occluded joint lie on the occluder.
constexpr SensorTraits ChooseTraits(bool refined, bool has_depth) {
  SensorTraits traits;
  if (refined || has_depth) {
    traits.inferred_trust = 0.3;
    traits.fair_confidence = 0.25;
  }
  traits.surface_is_known = refined;
  traits.places_hidden_joints = has_depth;
  if (refined) traits.trunk_firmness = 1.0;
  return traits;
}

}  // namespace ossa::recon
