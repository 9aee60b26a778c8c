#include "tools/experiments/compare/joint_track.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "depth/base/statistics.h"
#include "tools/experiments/compare/absent_frames.h"

namespace ossa::tools {
namespace {

using recon::BodyRecord;
using recon::SkeletonFrame;
using recon::SkeletonSequence;

// Constants: chosen by hand, where nothing else is said.

constexpr double kLongestGap_s = 0.2;  // truth is not interpolated across more
constexpr double kSameTime_s = 2e-3;   // nearer than this, a time is the same time

double MedianStep_s(const std::vector<double>& time_s) {
  std::vector<double> steps;
  for (size_t i = 1; i < time_s.size(); ++i) steps.push_back(time_s[i] - time_s[i - 1]);
  if (steps.empty()) return 1.0 / 30.0;
  return Median(std::move(steps));
}

std::vector<SkeletonFrame> InOrder(std::vector<SkeletonFrame> frames) {
  std::stable_sort(
      frames.begin(), frames.end(),
      [](const SkeletonFrame& a, const SkeletonFrame& b) { return a.time_s < b.time_s; });
  return frames;
}

// Every person of a sequence as a track. Frames out of order are put in order; of frames with the
// same time the first counts.
std::map<int, JointTrack> CollectTracks(const SkeletonSequence& sequence) {
  std::map<int, JointTrack> tracks;
  for (const SkeletonFrame& frame : InOrder(sequence.frames)) {
    for (const BodyRecord& body : frame.bodies) {
      JointTrack& track = tracks[body.id];
      if (!track.time_s.empty() && track.time_s.back() == frame.time_s) continue;
      track.time_s.push_back(frame.time_s);
      track.postures.push_back(ToSparsePosture(body));
    }
  }
  return tracks;
}

// Without the joints that say not_tracked, wherever a method has put them.
std::vector<SkeletonFrame> FoundOnly(std::vector<SkeletonFrame> frames) {
  for (SkeletonFrame& frame : frames) {
    for (BodyRecord& body : frame.bodies) {
      for (auto& joint : body.joints) {
        if (joint && joint->state == recon::TrackingState::kNotTracked) joint.reset();
      }
    }
  }
  return frames;
}

// When any of them is there.
std::vector<double> CollectTimes(const std::map<int, JointTrack>& tracks) {
  std::set<double> times;
  for (const auto& [id, track] : tracks) times.insert(track.time_s.begin(), track.time_s.end());
  return {times.begin(), times.end()};
}

SparsePosture Between(const SparsePosture& a, const SparsePosture& b, double share) {
  SparsePosture between;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    between.present[j] = a.present[j] && b.present[j];
    between.position_m[j] = (1 - share) * a.position_m[j] + share * b.position_m[j];
    between.confidence[j] = std::min(a.confidence[j], b.confidence[j]);
  }
  return between;
}

std::optional<SparsePosture> At(const JointTrack& track, double time_s) {
  const auto& times = track.time_s;
  const auto next = static_cast<size_t>(
      std::lower_bound(times.begin(), times.end(), time_s - kSameTime_s) - times.begin());
  if (next == times.size()) return std::nullopt;
  if (std::abs(times[next] - time_s) <= kSameTime_s) return track.postures[next];
  if (next == 0) return std::nullopt;
  const double step_s = times[next] - times[next - 1];
  if (step_s > kLongestGap_s) return std::nullopt;
  return Between(track.postures[next - 1], track.postures[next],
                 (time_s - times[next - 1]) / step_s);
}

double MeanDistance(const SparsePosture& a, const SparsePosture& b) {
  double sum = 0;
  int count = 0;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    if (!a.present[j] || !b.present[j]) continue;
    sum += (a.position_m[j] - b.position_m[j]).norm();
    ++count;
  }
  return count > 0 ? sum / count : std::numeric_limits<double>::infinity();
}

bool FrameTimesAgree(const JointTrack& truth, const JointTrack& result) {
  const double tolerance_s = 0.25 * MedianStep_s(truth.time_s);
  size_t near = 0;
  for (const double time_s : result.time_s) {
    const auto next = std::lower_bound(truth.time_s.begin(), truth.time_s.end(), time_s);
    const bool after = next != truth.time_s.end() && *next - time_s <= tolerance_s;
    const bool before = next != truth.time_s.begin() && time_s - *(next - 1) <= tolerance_s;
    near += after || before ? 1 : 0;
  }
  // A recording may run on a little longer than the truth; one in ten frames without a twin.
  return 10 * near >= 9 * result.time_s.size();
}

// Speed of every joint at evenly spaced times, and where it is known. speed[joint][time]. Joints
// are kept apart: their sum over a whole body is nearly constant in many motions and would say
// little about time.
struct Speeds {
  recon::JointArray<std::vector<double>> speed;
  recon::JointArray<std::vector<bool>> known;
};

Speeds ComputeSpeeds(const JointTrack& track, double start_s, double step_s, size_t count) {
  constexpr double kHalf_s = 0.05;  // speeds over a tenth of a second: above the sensor's jitter
  Speeds speeds;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    speeds.speed[j].assign(count, 0.0);
    speeds.known[j].assign(count, false);
  }
  for (size_t i = 0; i < count; ++i) {
    const double time_s = start_s + static_cast<double>(i) * step_s;
    const auto before = At(track, time_s - kHalf_s);
    const auto after = At(track, time_s + kHalf_s);
    for (size_t j = 0; before && after && j < recon::kJointCount; ++j) {
      if (!before->present[j] || !after->present[j]) continue;
      speeds.known[j][i] = true;
      speeds.speed[j][i] = (after->position_m[j] - before->position_m[j]).norm();
    }
  }
  return speeds;
}

// Pearson's correlation of a(t) with b(t - shift), covariances and variances summed over the
// joints. Only times that both know count, else the ends of a clip would pull the peak to zero.
// Fewer shared times than `fewest` give no correlation: short overlaps fit anything.
double Correlation(const Speeds& a, const Speeds& b, long shift, long fewest) {
  const auto count = static_cast<long>(a.speed[0].size());
  double covariance = 0;
  double variance_a = 0;
  double variance_b = 0;
  long shared = 0;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    double n = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;
    for (long i = std::max(0L, shift); i < count + std::min(0L, shift); ++i) {
      const auto at_a = static_cast<size_t>(i);
      const auto at_b = static_cast<size_t>(i - shift);
      if (!a.known[j][at_a] || !b.known[j][at_b]) continue;
      const double u = a.speed[j][at_a];
      const double v = b.speed[j][at_b];
      ++n;
      x += u;
      y += v;
      xx += u * u;
      yy += v * v;
      xy += u * v;
    }
    if (n < 2) continue;
    covariance += xy - x * y / n;
    variance_a += xx - x * x / n;
    variance_b += yy - y * y / n;
    shared = std::max(shared, static_cast<long>(n));
  }
  const double variance = std::sqrt(variance_a * variance_b);
  return shared >= fewest && variance > 0 ? covariance / variance : 0.0;
}

// Half of the shorter recording must overlap.
long FewestShared(const Speeds& a, const Speeds& b) {
  const auto longest = [](const Speeds& speeds) {
    long most = 0;
    for (const auto& known : speeds.known) {
      most = std::max(most, static_cast<long>(std::count(known.begin(), known.end(), true)));
    }
    return most;
  };
  return std::max(2L, std::min(longest(a), longest(b)) / 2);
}

void AlignRigidly(PairedTracks& pair) {
  std::vector<Eigen::Vector3d> from;
  std::vector<Eigen::Vector3d> to;
  for (size_t f = 0; f < pair.truth.size(); ++f) {
    for (size_t j = 0; j < recon::kJointCount; ++j) {
      if (!pair.truth[f].present[j] || !pair.result[f].present[j]) continue;
      from.push_back(pair.result[f].position_m[j]);
      to.push_back(pair.truth[f].position_m[j]);
    }
  }
  if (from.size() < 3) return;
  const auto points = static_cast<Eigen::Index>(from.size());
  const Eigen::Matrix4d transform =
      RigidTransform(Eigen::Map<const Eigen::Matrix3Xd>(from[0].data(), 3, points),
                     Eigen::Map<const Eigen::Matrix3Xd>(to[0].data(), 3, points));
  for (SparsePosture& posture : pair.result) {
    for (Eigen::Vector3d& position : posture.position_m) {
      position = (transform * position.homogeneous()).head<3>();
    }
  }
}

void FindOffset(const JointTrack& truth, const JointTrack& result, const PairOptions& options,
                PairedTracks& pair) {
  pair.same_clock = options.time == TimeAlignment::kNone ||
                    (options.time == TimeAlignment::kAuto && FrameTimesAgree(truth, result));
  if (options.time == TimeAlignment::kFixed) {
    pair.offset_s = options.offset_s;
  } else if (!pair.same_clock) {
    // Different clocks may differ by anything: the beginnings are laid together first.
    const double start_s = truth.time_s.front() - result.time_s.front();
    JointTrack moved = result;
    for (double& time_s : moved.time_s) time_s += start_s;
    pair.offset_s = start_s + TimeOffset_s(truth, moved, options.max_offset_s);
  }
}

// The person a file is about when it should be one: the one with the most frames.
const JointTrack* MainTrack(const std::map<int, JointTrack>& tracks) {
  const JointTrack* main = nullptr;
  for (const auto& [id, track] : tracks) {
    if (main == nullptr || track.time_s.size() > main->time_s.size()) main = &track;
  }
  return main;
}

// The one person of a result in all its frames, also those in which nobody is seen: of several
// bodies the one with the most frames, else the first, for a changed id is still the same person.
JointTrack OnlyTrack(const SkeletonSequence& result) {
  std::map<int, size_t> frames_of;
  for (const SkeletonFrame& frame : result.frames) {
    for (const BodyRecord& body : frame.bodies) ++frames_of[body.id];
  }
  JointTrack only;
  for (const SkeletonFrame& frame : InOrder(result.frames)) {
    if (!only.time_s.empty() && frame.time_s <= only.time_s.back()) continue;
    const auto main = std::max_element(frame.bodies.begin(), frame.bodies.end(),
                                       [&](const BodyRecord& a, const BodyRecord& b) {
                                         return frames_of.at(a.id) < frames_of.at(b.id);
                                       });
    only.time_s.push_back(frame.time_s);
    only.postures.push_back(main == frame.bodies.end() ? SparsePosture{} : ToSparsePosture(*main));
  }
  return only;
}

// One clock for all. Who of several people is whom is told by places at the same time, so that
// times are taken as they are unless something else is asked for; those seen most are then taken
// for the same person.
PairedTracks AlignClock(const std::map<int, JointTrack>& truths, const SkeletonSequence& result,
                        const PairOptions& options) {
  PairedTracks clock;
  if (result.frames.empty()) return clock;
  if (truths.size() == 1) {
    FindOffset(truths.begin()->second, OnlyTrack(result), options, clock);
    return clock;
  }
  const auto results = CollectTracks(result);
  const JointTrack* main = MainTrack(results);
  if (options.time == TimeAlignment::kAuto || main == nullptr) return clock;
  FindOffset(*MainTrack(truths), *main, options, clock);
  return clock;
}

using Postures = std::vector<std::optional<SparsePosture>>;

// Each true person takes the nearest body nobody nearer took, so that identities do not matter here
// (identity switches are the tracker's own table). Postures without joints where none is left.
std::vector<SparsePosture> TakenBodies(const Postures& truths,
                                       const std::vector<SparsePosture>& bodies) {
  struct Candidate {
    double distance_m;
    size_t truth, body;
  };
  std::vector<Candidate> candidates;
  for (size_t t = 0; t < truths.size(); ++t) {
    for (size_t b = 0; truths[t] && b < bodies.size(); ++b) {
      candidates.push_back({MeanDistance(*truths[t], bodies[b]), t, b});
    }
  }
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return std::tie(a.distance_m, a.truth, a.body) < std::tie(b.distance_m, b.truth, b.body);
  });
  std::vector<SparsePosture> taken(truths.size());
  std::vector<bool> served(truths.size(), false);
  std::vector<bool> used(bodies.size(), false);
  for (const Candidate& c : candidates) {
    if (served[c.truth] || used[c.body]) continue;
    served[c.truth] = used[c.body] = true;
    taken[c.truth] = bodies[c.body];
  }
  return taken;
}

// Frame by frame; of frames with the same time the first counts.
void PairFrames(const std::map<int, JointTrack>& truths, const std::vector<SkeletonFrame>& frames,
                std::vector<PairedTracks>& pairs) {
  std::optional<double> last_s;
  for (const SkeletonFrame& frame : frames) {
    if (last_s && frame.time_s <= *last_s) continue;
    last_s = frame.time_s;
    Postures there;
    for (const auto& [id, track] : truths) there.push_back(At(track, frame.time_s));
    std::vector<SparsePosture> bodies;
    for (const BodyRecord& body : frame.bodies) bodies.push_back(ToSparsePosture(body));
    const auto taken = TakenBodies(there, bodies);
    for (size_t t = 0; t < there.size(); ++t) {
      if (!there[t]) continue;
      pairs[t].time_s.push_back(frame.time_s);
      pairs[t].truth.push_back(*there[t]);
      pairs[t].result.push_back(taken[t]);
    }
  }
}

}  // namespace

SparsePosture ToSparsePosture(const BodyRecord& body) {
  SparsePosture sparse;
  const recon::TrackedPosture tracked = recon::ToTrackedPosture(body);
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    sparse.present[j] = body.joints[j] && recon::HasPlace(*body.joints[j]);
    sparse.position_m[j] = tracked.posture.position_m[j];
    sparse.confidence[j] = tracked.confidence[j];
  }
  return sparse;
}

Eigen::Matrix4d RigidTransform(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to) {
  const Eigen::Vector3d from_mean = from.rowwise().mean();
  const Eigen::Vector3d to_mean = to.rowwise().mean();
  const Eigen::Matrix3d covariance =
      (to.colwise() - to_mean) * (from.colwise() - from_mean).transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs = Eigen::Vector3d::Ones();
  // A mirror image fits better than any rotation for some data; a body is never mirrored.
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0) signs.z() = -1;
  const Eigen::Matrix3d rotation = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  Eigen::Matrix4d transform = Eigen::Matrix4d::Identity();
  transform.topLeftCorner<3, 3>() = rotation;
  transform.topRightCorner<3, 1>() = to_mean - rotation * from_mean;
  return transform;
}

double TimeOffset_s(const JointTrack& truth, const JointTrack& result, double max_offset_s) {
  if (truth.time_s.size() < 3 || result.time_s.size() < 3) return 0.0;
  constexpr double kStep_s = 0.01;
  const double start_s = std::min(truth.time_s.front(), result.time_s.front());
  const double end_s = std::max(truth.time_s.back(), result.time_s.back());
  const auto count = static_cast<size_t>(std::min((end_s - start_s) / kStep_s + 1, 2e5));
  const Speeds a = ComputeSpeeds(truth, start_s, kStep_s, count);
  const Speeds b = ComputeSpeeds(result, start_s, kStep_s, count);
  const long reach = std::lround(max_offset_s / kStep_s);
  std::vector<double> score;
  const long fewest = FewestShared(a, b);
  for (long shift = -reach; shift <= reach; ++shift) {
    score.push_back(Correlation(a, b, shift, fewest));
  }
  // Of equal peaks the smallest offset: someone who stands still gives no reason to move the clock.
  size_t best = static_cast<size_t>(reach);
  for (size_t i = 0; i < score.size(); ++i) {
    if (score[i] > score[best] + 1e-9) best = i;
  }
  double shift = static_cast<double>(best) - static_cast<double>(reach);
  if (best > 0 && best + 1 < score.size()) {
    const double curvature = score[best - 1] - 2 * score[best] + score[best + 1];
    if (curvature < -1e-12) shift += 0.5 * (score[best - 1] - score[best + 1]) / curvature;
  }
  return shift * kStep_s;
}

std::vector<PairedTracks> PairUp(const SkeletonSequence& truth, const SkeletonSequence& result,
                                 const PairOptions& options) {
  const auto truths = CollectTracks(truth);
  if (truths.empty()) return {};
  const PairedTracks clock = AlignClock(truths, result, options);
  std::vector<SkeletonFrame> frames = InOrder(result.frames);
  if (options.found_only) frames = FoundOnly(std::move(frames));
  for (SkeletonFrame& frame : frames) frame.time_s += clock.offset_s;
  AddAbsentFrames({CollectTimes(truths), kLongestGap_s, clock.same_clock}, &frames);
  std::vector<PairedTracks> pairs(truths.size(), clock);
  PairFrames(truths, frames, pairs);
  for (size_t t = 0; const auto& [id, track] : truths) {
    // One person needs no name: methods that see more people than there are would give it others.
    if (truths.size() > 1) pairs[t].name = "body " + std::to_string(id);
    if (options.rigid) AlignRigidly(pairs[t]);
    ++t;
  }
  return pairs;
}

}  // namespace ossa::tools
