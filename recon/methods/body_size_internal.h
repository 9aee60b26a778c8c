#pragma once
#include <optional>

#include "recon/bone_lengths.h"
#include "recon/normalise.h"

namespace ossa::recon {

// Constants: by hand, from anthropometry where it is named; weights and shares where no unit is.

/// When bones are measured, and the limits of their lengths. Frames are a thirtieth of a second;
/// checked on UI-PRMD (`ossa experiment sdk`) and rendered clips.
struct BodySizeOptions {
  /// No limits relative to the standard bones; a foot may coincide with the ankle if a sensor
  /// provides only one of the two.
  bool as_measured = false;
  // A size that differs by this share for this long is another person's.
  double other_size = 0.25;
  int other_size_frames = 30;
  // Number of estimates that are averaged: on rendered people the mean of 30 is no more accurate,
  // and moves for longer.
  int settling_frames = 3;
  int first_review_frames = 105;    // sooner, a pose would pass for a body shape
  double other_length = 0.05;       // share; the median of that many frames is accurate to 1 %
  int growing_frames = 15;          // over which a bone changes: gradually
  double trusted = 0.5;             // weight from which a joint is used, [0, 1]
  int whole_body = 12, fewest = 4;  // trusted joints that fix all bones; the size
  // Limits of lengths relative to the standard ones at the person's size. Trunk joints are a
  // convention of each sensor; limbs differ only between people (anthropometry: by less than a
  // quarter).
  double shortest_trunk = 0.5, shortest_limb = 0.75, longest_limb = 1.25, longest = 2.0;
  double shortest_measured = 0.1;  // lower limit of any bone with as_measured
};

/// The person's bone lengths, constant from the first good frame on: tracking starts with a
/// standing or T-posed person (Shum 2013 fig. 2), whose left and right sides are averaged. If a
/// network estimates them in each frame (recon/refine/bone_estimation.h), they settle in the first
/// three frames, and later only bones that differ change. All are measured again if the body has
/// another size for a second, which is another person. At reviews of decreasing frequency they
/// change, over half a second, to the medians observed so far if these differ. Known bones never
/// change.
class BodySize {
 public:
  BodySize() = default;
  explicit BodySize(const BodySizeOptions& options) : options_(options) {}
  /// Expected proportions of bones to the standard ones (0: none): lengths then are a mean of the
  /// measured ones, in one frame, and those expected from the body's size. `share`: weight of the
  /// latter, in [0, 1].
  void Expect(const BoneLengths& proportions, double share) {
    proportions_ = proportions;
    expected_ = share;
  }
  /// `expected_scale`: factor of the proportions; 0: the measured size. `judged`: a network's
  /// estimate of the bones in this frame, which takes precedence over distances between joints.
  void Observe(const Posture& in_camera, const JointWeights& trust, double expected_scale = 0.0,
               const std::optional<BoneLengths>& judged = std::nullopt);
  /// Sets known bone lengths, which never change.
  void Know(const BoneLengths& lengths_m);
  const BoneLengths& lengths_m() const { return lengths_m_; }
  /// The best lengths from all observations so far: lengths_m() changes rarely.
  BoneLengths Latest() const { return known_ ? lengths_m_ : Choose(); }
  bool locked() const { return locked_; }
  /// Size relative to the standard body.
  double scale() const { return scale_; }

 private:
  void AddTypical(const BoneLengths& measured, const JointWeights& trust);
  void Review();
  void Grow();
  BoneLengths Choose() const;
  bool IsJudged() const { return judged_.measurements(1) > 0; }

  BodySizeOptions options_;
  bool known_ = false;
  BoneLengths lengths_m_ = StandardBoneLengths();
  BoneLengths grow_from_m_{}, grow_to_m_{};
  int grown_frames_ = options_.growing_frames;
  BoneLengthEstimator typical_{BoneLengthOptions::ForJointDistances()};
  int typical_frames_ = 0;
  BoneLengthEstimator judged_{BoneLengthOptions::ForNetworkEstimates()};
  BoneLengths proportions_{};
  double expected_ = 0.0;
  double expected_scale_ = 0.0;
  double scale_ = 1.0;
  bool locked_ = false;
  int other_size_frames_ = 0;
  int next_review_ = options_.first_review_frames;
};

}  // namespace ossa::recon
