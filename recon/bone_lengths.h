#pragma once
#include <cstddef>
#include <vector>

#include "recon/posture.h"

namespace ossa::recon {

/// How a bone's length is estimated from its measurements.
enum class BoneStatistic {
  kMean,           // mean, in effect of the latest `memory` measurements
  kExponential,    // each measurement moves the length by `share` of the difference
  kRunningMedian,  // Robbins and Monro 1951: each moves it a step up or down, the n-th by 1/n;
                   // robust against almost half of the measurements
  kMedian          // exact median of all measurements, which are kept
};

/// How bone lengths are estimated from one posture after another.
struct BoneLengthOptions {
  BoneStatistic statistic = BoneStatistic::kMean;
  int memory = 600;          // measurements after which older ones fade, > 0; by hand: 20 s, 30 Hz
  double share = 0.1;        // weight of kExponential, in (0, 1]; by hand
  bool sides_alike = false;  // left and right have the same length

  /// For eq. 5 of Shum 2013 before any reference posture: the first second.
  static BoneLengthOptions BeforeReference() { return {BoneStatistic::kMean, 30}; }
  /// ... and once there was one: the mean of some ten reference postures.
  static BoneLengthOptions ForReferencePostures() {
    return {BoneStatistic::kExponential, 600, 0.1};
  }
  /// For the bone network's estimates of single frames (recon/refine/bone_estimation.h).
  static BoneLengthOptions ForNetworkEstimates() { return {BoneStatistic::kMean, 600}; }
  /// For distances of joints, which are wrong for one side of a body that is seen from the side.
  static BoneLengthOptions ForJointDistances() {
    return {BoneStatistic::kRunningMedian, 600, 0.1, true};
  }
  /// For a whole recording.
  static BoneLengthOptions ForWholeRecording() { return {BoneStatistic::kMedian}; }
};

/// Estimates a person's bone lengths, metres, from measurements; the caller decides which ones
/// count.
class BoneLengthEstimator {
 public:
  explicit BoneLengthEstimator(const BoneLengthOptions& options = {});
  /// One measurement of the bone that ends in the joint, metres, finite, > 0.
  void Add(size_t bone, double length_m);
  /// One measurement of every bone.
  void Add(const BoneLengths& lengths_m);
  /// Initial length of a bone, until the first measurement.
  void Start(size_t bone, double length_m);
  void Start(const BoneLengths& lengths_m) { lengths_m_ = lengths_m; }
  /// Initial lengths with the weight of a full memory: later measurements hardly move them.
  void StartKnown(const BoneLengths& lengths_m);
  /// 0 for bones without a measurement or an initial length.
  double length_m(size_t bone) const;
  BoneLengths lengths_m() const;
  /// Measurements that count, up to the memory.
  int measurements(size_t bone) const { return counts_[PlaceOf(bone)]; }

 private:
  /// The bone itself or, where sides are alike, the left one.
  size_t PlaceOf(size_t bone) const;

  BoneLengthOptions options_;
  BoneLengths lengths_m_{};
  JointArray<int> counts_{};
  JointArray<std::vector<double>> kept_m_;  // of kMedian
};

}  // namespace ossa::recon
