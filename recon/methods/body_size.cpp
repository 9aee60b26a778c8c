#include "recon/methods/body_size_internal.h"

#include <algorithm>
#include <cmath>

namespace ossa::recon {

void BodySize::AddTypical(const BoneLengths& measured, const JointWeights& trust) {
  ++typical_frames_;
  for (size_t i = 1; i < kJointCount; ++i) {
    const double both = std::min(trust[i], trust[ParentOf(i)]);
    if (std::isfinite(measured[i]) && both > options_.trusted) typical_.Add(i, measured[i]);
  }
}

void BodySize::Observe(const Posture& in_camera, const JointWeights& trust, double expected_scale,
                       const std::optional<BoneLengths>& judged) {
  if (known_) return;
  const auto good =
      std::count_if(trust.begin(), trust.end(), [this](double t) { return t > options_.trusted; });
  const BoneLengths measured = MeasureBoneLengths(in_camera);
  const double scale = EstimateBodyScale(measured, trust);
  expected_scale_ = expected_scale;
  if (locked_) {
    Grow();
    const bool other_size =
        good >= options_.whole_body && std::abs(scale / scale_ - 1.0) > options_.other_size;
    other_size_frames_ = other_size ? other_size_frames_ + 1 : 0;
    if (other_size_frames_ < options_.other_size_frames) {
      if (good < options_.whole_body || other_size) return;
      AddTypical(measured, trust);
      if (judged) judged_.Add(*judged);
      Review();
      return;
    }
    judged_ = BoneLengthEstimator(
        BoneLengthOptions::ForNetworkEstimates());  // measurements so far were of another person
  }
  scale_ = good >= options_.fewest ? scale : 1.0;
  typical_ = BoneLengthEstimator(BoneLengthOptions::ForJointDistances());
  typical_frames_ = 0;
  next_review_ = options_.first_review_frames;
  AddTypical(measured, trust);
  if (judged) judged_.Add(*judged);
  lengths_m_ = Choose();
  grown_frames_ = options_.growing_frames;
  locked_ = good >= options_.whole_body;
  other_size_frames_ = 0;
}

void BodySize::Know(const BoneLengths& lengths_m) {
  JointWeights all;
  all.fill(1.0);
  lengths_m_ = lengths_m;
  scale_ = EstimateBodyScale(lengths_m, all);
  grown_frames_ = options_.growing_frames;
  known_ = locked_ = true;
}

// Estimated lengths settle in the first frames. After 3.5, 7, 14, ... seconds, bones whose median
// differs from the current length are replaced; if lengths are measured between joints, all others
// are, too, because such errors affect the whole body alike. A body whose bones are as observed is
// not changed.
void BodySize::Review() {
  const bool settles = IsJudged() && judged_.measurements(1) <= options_.settling_frames;
  const bool reviews = typical_frames_ >= next_review_;
  if (!settles && !reviews) return;
  if (reviews) next_review_ *= 2;
  const BoneLengths chosen = Choose();
  if (settles) {
    lengths_m_ = chosen;
    return;
  }
  BoneLengths others_m = lengths_m_;
  bool grows = false;
  for (size_t i = 1; i < kJointCount; ++i) {
    if (std::abs(chosen[i] / lengths_m_[i] - 1.0) <= options_.other_length) continue;
    others_m[i] = chosen[i];
    grows = true;
  }
  if (!grows) return;
  grow_from_m_ = lengths_m_;
  grow_to_m_ = IsJudged() ? others_m : chosen;
  grown_frames_ = 0;
}

void BodySize::Grow() {
  if (grown_frames_ == options_.growing_frames) return;
  ++grown_frames_;
  const double part = static_cast<double>(grown_frames_) / options_.growing_frames;
  const double share = part * part * (3.0 - 2.0 * part);  // smoothstep
  for (size_t i = 0; i < kJointCount; ++i) {
    lengths_m_[i] = (1.0 - share) * grow_from_m_[i] + share * grow_to_m_[i];
  }
}

/// Lengths from the network's estimates; without any, the medians of the measurements.
BoneLengths BodySize::Choose() const {
  BoneLengths lengths = ScaledBoneLengths(scale_);
  for (size_t i = 1; i < kJointCount; ++i) {
    double length = typical_.measurements(i) > 0 ? typical_.length_m(i) : lengths[i];
    if (IsJudged()) {
      length = judged_.length_m(i);
    } else if (proportions_[i] > 0.0) {
      const double size = expected_scale_ > 0.0 ? expected_scale_ : scale_;
      const double expected_m = size * proportions_[i] * StandardBoneLengths()[i];
      length += expected_ * (expected_m - length);
    }
    // Bones ending in shoulders and hips belong to the trunk.
    const bool trunk = i <= Index(Joint::kShoulderLeft) || i == Index(Joint::kShoulderRight) ||
                       i == Index(Joint::kHipLeft) || i == Index(Joint::kHipRight);
    const double shortest = options_.as_measured ? options_.shortest_measured
                            : trunk              ? options_.shortest_trunk
                                                 : options_.shortest_limb;
    const double longest = options_.as_measured || trunk ? options_.longest : options_.longest_limb;
    lengths[i] = std::clamp(length, shortest * lengths[i], longest * lengths[i]);
  }
  return lengths;
}

}  // namespace ossa::recon
