#include "tools/experiments/compare/metrics.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "depth/base/statistics.h"

namespace ossa::tools {
namespace {

constexpr double kCentimetres = 100.0;   // in a metre, by definition
constexpr double kGrossError_cm = 20.0;  // Plantard 2016, section 8.2
constexpr double kHit_cm = 10.0;         // Shotton 2011, section 4

struct Mean {
  double sum = 0;
  int64_t count = 0;
  void Add(double value) {
    sum += value;
    ++count;
  }
  std::optional<double> Value() const {
    if (count == 0) return std::nullopt;
    return sum / static_cast<double>(count);
  }
};

bool Both(const PairedTracks& pair, size_t frame, size_t joint) {
  return pair.truth[frame].present[joint] && pair.result[frame].present[joint];
}

double Error_cm(const PairedTracks& pair, size_t frame, size_t joint) {
  return kCentimetres *
         (pair.result[frame].position_m[joint] - pair.truth[frame].position_m[joint]).norm();
}

// One term of eq. 18: |(p1 - p1') - (p2 - p2')|, the primes the parent.
std::optional<double> RelativeError_cm(const PairedTracks& pair, size_t frame, size_t joint) {
  if (!Both(pair, frame, joint)) return std::nullopt;
  if (joint == 0) return std::nullopt;
  size_t p = recon::ParentOf(joint);
  while (p != 0 && !Both(pair, frame, p)) p = recon::ParentOf(p);
  if (!Both(pair, frame, p)) return std::nullopt;
  const SparsePosture& truth = pair.truth[frame];
  const SparsePosture& result = pair.result[frame];
  return kCentimetres * ((result.position_m[joint] - result.position_m[p]) -
                         (truth.position_m[joint] - truth.position_m[p]))
                            .norm();
}

std::optional<double> Percentile(std::vector<double> values, double share) {
  if (values.empty()) return std::nullopt;
  // Linear between the neighbouring order statistics, as numpy's default.
  const double place = share * static_cast<double>(values.size() - 1);
  const auto low = static_cast<size_t>(place);
  const double below = SelectRank(values, low);
  if (low + 1 == values.size()) return below;
  const double above =
      *std::min_element(values.begin() + static_cast<std::ptrdiff_t>(low) + 1, values.end());
  return below + (place - static_cast<double>(low)) * (above - below);
}

void MeasureErrors(const PairedTracks& pair, ClipMetrics& metrics) {
  Mean all;
  recon::JointArray<Mean> by_joint;
  Mean relative;
  Mean within;
  Mean missing;
  for (size_t f = 0; f < pair.truth.size(); ++f) {
    bool any = false;
    for (size_t j = 0; j < recon::kJointCount; ++j) {
      if (!pair.truth[f].present[j]) continue;
      missing.Add(pair.result[f].present[j] ? 0.0 : 1.0);
      if (!pair.result[f].present[j]) {
        within.Add(0.0);
        continue;
      }
      any = true;
      const double error_cm = Error_cm(pair, f, j);
      all.Add(error_cm);
      by_joint[j].Add(error_cm);
      within.Add(error_cm <= kHit_cm ? 1.0 : 0.0);
      if (const auto error = RelativeError_cm(pair, f, j)) relative.Add(*error);
    }
    metrics.frames += any ? 1 : 0;
  }
  metrics.mean_joint_error_cm = all.Value();
  metrics.parent_relative_error_cm = relative.Value();
  metrics.fraction_joints_within_10cm = within.Value();
  metrics.fraction_joints_missing = missing.Value();
  for (size_t j = 0; j < recon::kJointCount; ++j) metrics.per_joint_cm[j] = by_joint[j].Value();
}

void MeasureOffsetRemoved(const PairedTracks& pair, ClipMetrics& metrics) {
  Mean all;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    std::vector<Eigen::Vector3d> differences;
    for (size_t f = 0; f < pair.truth.size(); ++f) {
      if (!Both(pair, f, j)) continue;
      differences.push_back(pair.result[f].position_m[j] - pair.truth[f].position_m[j]);
      sum += differences.back();
    }
    for (const Eigen::Vector3d& difference : differences) {
      all.Add(kCentimetres * (difference - sum / static_cast<double>(differences.size())).norm());
    }
  }
  metrics.offset_removed_error_cm = all.Value();
}

// Second differences need three frames without a gap: a step no longer than one and a half times
// the clip's usual one.
void MeasureAcceleration(const PairedTracks& pair, ClipMetrics& metrics) {
  if (pair.time_s.size() < 3) return;
  std::vector<double> steps;
  for (size_t f = 1; f < pair.time_s.size(); ++f) {
    steps.push_back(pair.time_s[f] - pair.time_s[f - 1]);
  }
  const double longest_s = 1.5 * *Percentile(steps, 0.5);
  Mean all;
  for (size_t f = 2; f < pair.time_s.size(); ++f) {
    if (steps[f - 1] > longest_s || steps[f - 2] > longest_s) continue;
    for (size_t j = 0; j < recon::kJointCount; ++j) {
      if (!Both(pair, f, j) || !Both(pair, f - 1, j) || !Both(pair, f - 2, j)) continue;
      const auto difference = [&](size_t frame) -> Eigen::Vector3d {
        return pair.result[frame].position_m[j] - pair.truth[frame].position_m[j];
      };
      all.Add(kCentimetres * (difference(f) - 2 * difference(f - 1) + difference(f - 2)).norm());
    }
  }
  metrics.acceleration_error_cm_per_frame2 = all.Value();
}

void MeasureBones(const PairedTracks& pair, ClipMetrics& metrics) {
  Mean variation;
  for (size_t j = 1; j < recon::kJointCount; ++j) {
    const auto parent = recon::ParentOf(j);
    std::vector<double> lengths;
    for (const SparsePosture& posture : pair.result) {
      if (!posture.present[j] || !posture.present[parent]) continue;
      lengths.push_back((posture.position_m[j] - posture.position_m[parent]).norm());
    }
    if (lengths.size() < 2) continue;
    double mean = 0;
    for (const double length : lengths) mean += length / static_cast<double>(lengths.size());
    double squares = 0;
    for (const double length : lengths) squares += (length - mean) * (length - mean);
    if (mean <= 0) continue;
    variation.Add(100 * std::sqrt(squares / static_cast<double>(lengths.size())) / mean);
  }
  metrics.bone_length_variation_percent = variation.Value();
}

// Area under precision over recall; detections are ranked by confidence, equal confidences
// together. Every true joint counts in recall.
std::optional<double> AveragePrecision(const PairedTracks& pair, size_t joint) {
  std::vector<std::pair<double, bool>> found;
  int64_t wanted = 0;
  for (size_t f = 0; f < pair.truth.size(); ++f) {
    wanted += pair.truth[f].present[joint] ? 1 : 0;
    if (Both(pair, f, joint)) {
      found.emplace_back(pair.result[f].confidence[joint], Error_cm(pair, f, joint) <= kHit_cm);
    }
  }
  if (wanted == 0) return std::nullopt;
  std::sort(found.begin(), found.end(),
            [](const auto& a, const auto& b) { return a.first > b.first; });
  double area = 0;
  int64_t hits = 0;
  for (size_t i = 0; i < found.size();) {
    const int64_t before = hits;
    const double confidence = found[i].first;
    for (; i < found.size() && found[i].first == confidence; ++i) hits += found[i].second ? 1 : 0;
    const double precision = static_cast<double>(hits) / static_cast<double>(i);
    area += precision * static_cast<double>(hits - before) / static_cast<double>(wanted);
  }
  return area;
}

// Mirrors at x = 0; the plane does not matter for errors relative to a parent.
SparsePosture Mirrored(const SparsePosture& posture) {
  SparsePosture mirrored;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    const size_t other = recon::kMirroredJoint[j];
    mirrored.position_m[j] = posture.position_m[other].cwiseProduct(Eigen::Vector3d(-1, 1, 1));
    mirrored.present[j] = posture.present[other];
    mirrored.confidence[j] = posture.confidence[other];
  }
  return mirrored;
}

}  // namespace

std::optional<double> MirroredRelativeError_cm(PairedTracks pair) {
  for (SparsePosture& posture : pair.result) posture = Mirrored(posture);
  Mean relative;
  for (size_t f = 0; f < pair.truth.size(); ++f) {
    for (size_t j = 0; j < recon::kJointCount; ++j) {
      if (const auto error = RelativeError_cm(pair, f, j)) relative.Add(*error);
    }
  }
  return relative.Value();
}

FrameErrors ErrorsByFrame(const PairedTracks& pair) {
  FrameErrors errors;
  for (size_t f = 0; f < pair.truth.size(); ++f) {
    Mean absolute;
    Mean relative;
    for (size_t j = 0; j < recon::kJointCount; ++j) {
      if (Both(pair, f, j)) absolute.Add(Error_cm(pair, f, j));
      if (const auto error = RelativeError_cm(pair, f, j)) relative.Add(*error);
    }
    errors.mean_joint_cm.push_back(absolute.Value());
    errors.parent_relative_cm.push_back(relative.Value());
  }
  return errors;
}

std::vector<double> JointErrors_cm(const PairedTracks& pair) {
  std::vector<double> errors;
  for (size_t f = 0; f < pair.truth.size(); ++f) {
    for (size_t j = 0; j < recon::kJointCount; ++j) {
      if (Both(pair, f, j)) errors.push_back(Error_cm(pair, f, j));
    }
  }
  return errors;
}

ClipMetrics Measure(const PairedTracks& pair) {
  ClipMetrics metrics;
  metrics.name = pair.name;
  metrics.offset_s = pair.offset_s;
  metrics.same_clock = pair.same_clock;
  MeasureErrors(pair, metrics);
  MeasureOffsetRemoved(pair, metrics);
  MeasureAcceleration(pair, metrics);
  MeasureBones(pair, metrics);
  const auto errors = JointErrors_cm(pair);
  metrics.p95_cm = Percentile(errors, 0.95);
  metrics.p99_cm = Percentile(errors, 0.99);
  Mean over;
  for (const auto& error : ErrorsByFrame(pair).parent_relative_cm) {
    if (error) over.Add(*error >= kGrossError_cm ? 1.0 : 0.0);
  }
  metrics.fraction_frames_over_20cm = over.Value();
  Mean precision;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    metrics.ap_10cm[j] = AveragePrecision(pair, j);
    if (metrics.ap_10cm[j]) precision.Add(*metrics.ap_10cm[j]);
  }
  metrics.map_10cm = precision.Value();
  return metrics;
}

ClipMetrics MeanOverClips(const std::string& name, const std::vector<ClipMetrics>& clips) {
  ClipMetrics mean;
  mean.name = name;
  const auto average = [&](auto member) {
    Mean values;
    for (const ClipMetrics& clip : clips) {
      if (clip.*member) values.Add(*(clip.*member));
    }
    mean.*member = values.Value();
  };
  for (const auto member :
       {&ClipMetrics::mean_joint_error_cm, &ClipMetrics::parent_relative_error_cm,
        &ClipMetrics::fraction_frames_over_20cm, &ClipMetrics::fraction_joints_within_10cm,
        &ClipMetrics::map_10cm, &ClipMetrics::acceleration_error_cm_per_frame2,
        &ClipMetrics::offset_removed_error_cm, &ClipMetrics::bone_length_variation_percent,
        &ClipMetrics::p95_cm, &ClipMetrics::p99_cm, &ClipMetrics::fraction_joints_missing}) {
    average(member);
  }
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    Mean error;
    Mean precision;
    for (const ClipMetrics& clip : clips) {
      if (clip.per_joint_cm[j]) error.Add(*clip.per_joint_cm[j]);
      if (clip.ap_10cm[j]) precision.Add(*clip.ap_10cm[j]);
    }
    mean.per_joint_cm[j] = error.Value();
    mean.ap_10cm[j] = precision.Value();
  }
  for (const ClipMetrics& clip : clips) {
    mean.frames += clip.frames;
    mean.same_clock = mean.same_clock && clip.same_clock;
    mean.offset_s += clip.offset_s / static_cast<double>(clips.size());
  }
  return mean;
}

std::vector<double> Values(const std::vector<ClipMetrics>& clips,
                           std::optional<double> ClipMetrics::*member) {
  std::vector<double> values;
  for (const ClipMetrics& clip : clips) {
    if (clip.*member) values.push_back(*(clip.*member));
  }
  return values;
}

std::vector<std::vector<double>> SharedValues(const std::vector<std::vector<ClipMetrics>>& clips,
                                              std::optional<double> ClipMetrics::*member) {
  std::map<std::string, size_t> holders;
  for (const auto& of_result : clips) {
    for (const ClipMetrics& clip : of_result) holders[clip.name] += clip.*member ? 1u : 0u;
  }
  std::vector<std::vector<double>> values(clips.size());
  for (size_t r = 0; r < clips.size(); ++r) {
    for (const ClipMetrics& clip : clips[r]) {
      if (holders[clip.name] == clips.size()) values[r].push_back(*(clip.*member));
    }
  }
  return values;
}

}  // namespace ossa::tools
