#pragma once
#include <optional>

#include "recon/bone_lengths.h"
#include "recon/normalise.h"

namespace ossa::recon {

// Constants: by hand, from anthropometry where it is named; weights and shares where no unit is.

/// When bones are measured, and what a measured length may be. Frames are a thirtieth of a second;
/// checked on UI-PRMD (`ossa experiment sdk`) and rendered clips.
struct BodySizeOptions {
  /// Bones may be as far from the standard ones as they like; a foot may end in the ankle where a
  /// sensor has only one of the two.
  bool as_measured = false;
  // Another size, by that share, for so long is another person.
  double other_size = 0.25;
  int other_size_frames = 30;
  // Judged bones are the mean of so many: of 30 they are as near to the truth on rendered people,
  // and move for longer.
  int settling_frames = 3;
  int first_review_frames = 105;  // sooner, a pose is taken for a body
  double other_length = 0.05;     // share: the median of that many frames errs by no more than 1 %
  int growing_frames = 15;        // a bone that grew at once would throw its joints
  double trusted = 0.5;           // weight from which on a joint is measured, [0, 1]
  int whole_body = 12, fewest = 4;  // trusted joints that fix bones for good, that fix the size
  // Lengths over the standard ones at the person's size. Where trunk joints lie is each sensor's
  // own definition; limbs differ between people only (anthropometry: by less than a quarter).
  double shortest_trunk = 0.5, shortest_limb = 0.75, longest_limb = 1.25, longest = 2.0;
  double shortest_measured = 0.1;  // of any bone, as_measured
};

/// The person's bone lengths, kept constant from the first good frame on: the standing or T-posed
/// person that tracking starts with (Shum 2013 fig. 2), left and right averaged. Where a network
/// judges them in each frame (recon/refine/bone_estimation.h), they settle in the first three, and
/// later only those grow that are others. Measured anew when the body has another size for a
/// second, which is another person; and, at reviews that become rarer, when the bones seen until
/// then are typically others: to these they grow in half a second. Bones that are known stay.
class BodySize {
 public:
  BodySize() = default;
  explicit BodySize(const BodySizeOptions& options) : options_(options) {}
  /// Bones are expected in these proportions to the standard ones (0: nothing is expected): the
  /// lengths taken lie between what is measured, in one frame, and what the body's size tells.
  /// `share`: of what the size tells, in [0, 1].
  void Expect(const BoneLengths& proportions, double share) {
    proportions_ = proportions;
    expected_ = share;
  }
  /// `expected_scale`: what the proportions are multiplied with; 0: the measured size. `judged`:
  /// the bones as a network judges them in this frame, which goes before what lies between joints.
  void Observe(const Posture& in_camera, const JointWeights& trust, double expected_scale = 0.0,
               const std::optional<BoneLengths>& judged = std::nullopt);
  /// The person's bones were measured before: these stay, whatever is observed.
  void Know(const BoneLengths& lengths_m);
  const BoneLengths& lengths_m() const { return lengths_m_; }
  /// What would be taken now, by all that was observed: lengths_m() changes rarely.
  BoneLengths Latest() const { return known_ ? lengths_m_ : Choose(); }
  bool locked() const { return locked_; }
  /// Over the standard body, as a whole.
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
