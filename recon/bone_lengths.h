#pragma once
#include <cstddef>
#include <vector>

#include "recon/posture.h"

namespace ossa::recon {

/// How a bone's length follows from the lengths measured of it.
enum class BoneStatistic {
  kMean,           // of the measurements, the latest `memory` of them in effect
  kExponential,    // each measurement moves the length by `share` of the difference
  kRunningMedian,  // Robbins and Monro 1951: each moves it a step up or down, the n-th by 1/n; half
                   // of the measurements may be wrong without moving it far
  kMedian          // exact, of all measurements, which are kept
};

/// How bone lengths are estimated from one posture after another.
struct BoneLengthOptions {
  BoneStatistic statistic = BoneStatistic::kMean;
  int memory = 600;          // measurements until what is older fades, > 0; by hand: 20 s at 30 Hz
  double share = 0.1;        // weight of kExponential, in (0, 1]; by hand
  bool sides_alike = false;  // left and right are one bone

  /// Of eq. 5 of Shum 2013 before any reference posture: the first second.
  static BoneLengthOptions BeforeReference() { return {BoneStatistic::kMean, 30}; }
  /// ... and once there was one: the mean of some ten reference postures.
  static BoneLengthOptions ForReferencePostures() {
    return {BoneStatistic::kExponential, 600, 0.1};
  }
  /// Of what the network for bones judges frame by frame (recon/refine/bone_estimation.h).
  static BoneLengthOptions ForNetworkEstimates() { return {BoneStatistic::kMean, 600}; }
  /// Of what lies between joints, which is wrong for half of a body that is seen from the side.
  static BoneLengthOptions ForJointDistances() {
    return {BoneStatistic::kRunningMedian, 600, 0.1, true};
  }
  /// Of a whole recording.
  static BoneLengthOptions ForWholeRecording() { return {BoneStatistic::kMedian}; }
};

/// Lengths of a person's bones from measurements, metres; which measurements count is the caller's
/// matter.
class BoneLengthEstimator {
 public:
  explicit BoneLengthEstimator(const BoneLengthOptions& options = {});
  /// One measurement of the bone that ends in the joint, metres, finite, > 0.
  void Add(size_t bone, double length_m);
  /// One measurement of every bone.
  void Add(const BoneLengths& lengths_m);
  /// What is said of a bone until something is measured.
  void Start(size_t bone, double length_m);
  void Start(const BoneLengths& lengths_m) { lengths_m_ = lengths_m; }
  /// Lengths that later measurements hardly move: known as well as if the memory were full.
  void StartKnown(const BoneLengths& lengths_m);
  /// 0 of bones of which nothing is known.
  double length_m(size_t bone) const;
  BoneLengths lengths_m() const;
  /// Measurements that count, up to the memory.
  int measurements(size_t bone) const { return counts_[PlaceOf(bone)]; }

 private:
  /// Of bones that count as one, the left one.
  size_t PlaceOf(size_t bone) const;

  BoneLengthOptions options_;
  BoneLengths lengths_m_{};
  JointArray<int> counts_{};
  JointArray<std::vector<double>> kept_m_;  // of kMedian
};

}  // namespace ossa::recon
