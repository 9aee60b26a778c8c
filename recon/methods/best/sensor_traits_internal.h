#pragma once

namespace ossa::recon {

// Constants: chosen on ten rendered scenes of validation subjects, of trusts of 0.01 to 0.3 and
// confidences of 0.25 to 1.

/// What a sensor's skeletons are like, as far as `best` treats sensors differently.
struct SensorTraits {
  /// Weight of a joint that the sensor only infers, in [0, 1].
  double inferred_trust = 0.1;
  /// Confidence, in (0, 1], from which on an inferred joint is a fair guess: where a few frames of
  /// guesses lie is nearer the truth than what a database or a prior expects.
  double fair_confidence = 0.75;
  /// The surface at each joint has been looked at already: whether one lies there says no more.
  bool surface_is_known = false;
  /// A joint that the sensor does not see has been placed by it all the same.
  bool places_hidden_joints = false;
  /// Weight of the joints of the trunk when bones get their lengths, over that of a limb's first
  /// joint, > 0. Where inside the trunk its joints lie is a matter of definition for most sensors:
  /// they give way first.
  double trunk_firmness = 0.1;
};

/// `refined`: the joints come from the cascaded refinement at the depth image, which was learned to
/// say where hidden joints are and knows the trunk best. `has_depth`: there is a depth image, and
/// inferred joints were held against it (ReliabilityOptions::use_depth); without one most guesses
/// of a joint behind something are where that thing is.
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
