#include "tools/nite2/gestures.h"

#include <algorithm>
#include <cmath>

namespace ossa::nite2 {
namespace {

Eigen::Vector3d ArmOf(const HandSample& sample) { return sample.hand_m - sample.shoulder_m; }

}  // namespace

std::optional<NiteGestureState> GestureDetector::Step(const HandSample& sample) {
  complete_ = false;
  bool under_way = false;
  if (type_ == NITE_GESTURE_WAVE) under_way = IsWaving(sample);
  if (type_ == NITE_GESTURE_CLICK) under_way = IsClicking(sample);
  if (type_ == NITE_GESTURE_HAND_RAISE) under_way = IsRaising(sample);
  if (complete_) {
    begun_ = false;
    return NITE_GESTURE_STATE_COMPLETED;
  }
  const bool was_begun = begun_;
  begun_ = under_way;
  if (!under_way) return std::nullopt;
  return was_begun ? NITE_GESTURE_STATE_IN_PROGRESS : NITE_GESTURE_STATE_NEW;
}

// Wave: the hand moves back and forth above the elbow.
bool GestureDetector::IsWaving(const HandSample& sample) {
  const double side_m = sample.hand_m.x() - sample.shoulder_m.x();
  if (sample.hand_m.y() < sample.elbow_m.y()) {
    turns_s_.clear();
    way_ = 0;
    return false;
  }
  if (way_ == 0) {
    way_ = 1;
    extreme_m_ = side_m;
  }
  if (way_ * (side_m - extreme_m_) > 0) extreme_m_ = side_m;
  if (way_ * (extreme_m_ - side_m) >= options_.swing_m) {
    turns_s_.push_back(sample.time_s);
    way_ = -way_;
    extreme_m_ = side_m;
  }
  while (!turns_s_.empty() && sample.time_s - turns_s_.front() > options_.wave_s) {
    turns_s_.pop_front();
  }
  complete_ = static_cast<int>(turns_s_.size()) >= options_.swings;
  if (complete_) turns_s_.clear();
  return turns_s_.size() >= 2;
}

// Click: the hand moves quickly away from the shoulder, roughly towards the sensor, and back.
bool GestureDetector::IsClicking(const HandSample& sample) {
  past_.push_back(sample);
  while (sample.time_s - past_.front().time_s > options_.push_s) past_.pop_front();
  if (!pushed_) {
    for (const HandSample& before : past_) {
      if (!IsPush(before, sample)) continue;
      pushed_ = {ArmOf(before), ArmOf(sample) - ArmOf(before), sample.time_s};
      return true;
    }
    return false;
  }
  const Eigen::Vector3d way_m = ArmOf(sample) - pushed_->from_m;
  if (way_m.norm() > pushed_->way_m.norm()) {
    pushed_->way_m = way_m;
    pushed_->end_s = sample.time_s;
  }
  complete_ = way_m.dot(pushed_->way_m.normalized()) <= 0.5 * pushed_->way_m.norm();
  if (complete_ || sample.time_s - pushed_->end_s > options_.push_s) {
    pushed_.reset();
    past_.clear();
  }
  return pushed_.has_value();
}

bool GestureDetector::IsPush(const HandSample& before, const HandSample& now) const {
  const Eigen::Vector3d arm = ArmOf(now).normalized();
  const Eigen::Vector3d way_m = ArmOf(now) - ArmOf(before);
  const double along_m = way_m.dot(arm);
  const double aside_m = (way_m - along_m * arm).norm();
  return -arm.z() >= options_.towards && along_m >= options_.push_m && aside_m <= options_.aside_m;
}

// Raise: the hand moves above the shoulder and stays there for a moment; reported once per raise.
bool GestureDetector::IsRaising(const HandSample& sample) {
  const double above_m = sample.hand_m.y() - sample.shoulder_m.y();
  if (above_m < options_.raise_m) raised_s_.reset();
  if (above_m < -options_.raise_m) told_ = false;  // a hand that merely dips is not raised again
  if (above_m < options_.raise_m) return false;
  if (!raised_s_) raised_s_ = sample.time_s;
  complete_ = !told_ && sample.time_s - *raised_s_ >= options_.raise_s;
  told_ = told_ || complete_;
  return !told_;
}

}  // namespace ossa::nite2
