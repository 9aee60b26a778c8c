#include "tools/experiments/sdk/gross_failures.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "depth/base/statistics.h"

namespace ossa::tools {
namespace {

using recon::BodyRecord;
using recon::kJointCount;

// Constants: chosen by hand unless stated otherwise.

// 25 cm in a thirtieth of a second is 7.5 m/s about the next joint: a boxer's fist, in no exercise.
constexpr double kJump_m = 0.25;
constexpr double kApart_m = 0.25, kTogether_m = 0.10;
constexpr double kWrongBone = 0.4;  // share of its length
constexpr double kLongestStep_s = 0.1;
constexpr std::array<std::pair<size_t, size_t>, 2> kHandsAndWrists = {{{7, 11}, {6, 10}}};

std::optional<Eigen::Vector3d> At(const BodyRecord& body, size_t joint) {
  const auto& record = body.joints[joint];
  if (!record || !recon::HasPlace(*record)) return std::nullopt;
  return record->position_m;
}

/// From joint a to joint b, where both are there.
std::optional<Eigen::Vector3d> Between(const BodyRecord& body, size_t a, size_t b) {
  const auto from = At(body, a), to = At(body, b);
  if (!from || !to) return std::nullopt;
  return *to - *from;
}

const BodyRecord* BodyOf(const recon::SkeletonFrame& frame, int id) {
  const auto found = std::find_if(frame.bodies.begin(), frame.bodies.end(),
                                  [id](const BodyRecord& body) { return body.id == id; });
  return found == frame.bodies.end() ? nullptr : &*found;
}

bool AfterAGap(const recon::SkeletonSequence& sequence, size_t frame) {
  return sequence.frames[frame].time_s - sequence.frames[frame - 1].time_s > kLongestStep_s;
}

/// What a method said of the frames before and after a jump.
struct Verdicts {
  const recon::SkeletonFrame& before;
  const recon::SkeletonFrame& now;

  bool IsInDoubt(int id, std::initializer_list<size_t> joints) const {
    return std::any_of(joints.begin(), joints.end(), [&](size_t j) {
      return IsDoubted(BodyOf(before, id), j) || IsDoubted(BodyOf(now, id), j);
    });
  }
  static bool IsDoubted(const BodyRecord* body, size_t j) {
    return body != nullptr && body->joints[j] && body->joints[j]->reliability.value_or(1.0) < 0.5;
  }
};

/// Median length of every bone; 0 where it was never seen.
recon::JointArray<double> MedianBones_m(const recon::SkeletonSequence& sequence) {
  recon::JointArray<double> medians{};
  for (size_t j = 1; j < kJointCount; ++j) {
    std::vector<double> lengths;
    for (const auto& frame : sequence.frames) {
      for (const BodyRecord& body : frame.bodies) {
        const auto bone = Between(body, recon::ParentOf(j), j);
        if (bone) lengths.push_back(bone->norm());
      }
    }
    if (lengths.empty()) continue;
    medians[j] = Median(std::move(lengths));
  }
  return medians;
}

void CountDoubts(const BodyRecord* judged, GrossFailures& out) {
  for (size_t j = 0; judged != nullptr && j < kJointCount; ++j) {
    if (!At(*judged, j)) continue;
    ++out.joints;
    out.doubted += Verdicts::IsDoubted(judged, j) ? 1 : 0;
  }
}

void CountJumps(const BodyRecord& now, const BodyRecord& before, const Verdicts& judged,
                GrossFailures& out) {
  for (size_t j = 1; j < kJointCount; ++j) {
    const auto parent = recon::ParentOf(j);
    const auto here = Between(now, parent, j), there = Between(before, parent, j);
    if (!here || !there || (*here - *there).norm() < kJump_m) continue;
    ++out.jumps;
    out.noticed += judged.IsInDoubt(now.id, {j, parent}) ? 1 : 0;
  }
}

void CountSnaps(const BodyRecord& now, const BodyRecord& before, const Verdicts& judged,
                GrossFailures& out) {
  for (const auto& [left, right] : kHandsAndWrists) {
    const auto here = Between(now, left, right), there = Between(before, left, right);
    if (!here || !there) continue;
    if (here->norm() < kTogether_m && there->norm() > kApart_m) {
      ++out.snaps;
      out.noticed += judged.IsInDoubt(now.id, {left, right}) ? 1 : 0;
    }
    return;  // wrists only where there are no hands
  }
}

}  // namespace

GrossFailures& GrossFailures::operator+=(const GrossFailures& other) {
  const auto n = static_cast<double>(std::max<int64_t>(1, frames + other.frames));
  jitter_cm = (jitter_cm * static_cast<double>(frames) +
               other.jitter_cm * static_cast<double>(other.frames)) /
              n;
  frames += other.frames;
  jumps += other.jumps;
  snaps += other.snaps;
  wrong_bones += other.wrong_bones;
  noticed += other.noticed;
  joints += other.joints;
  doubted += other.doubted;
  return *this;
}

GrossFailures CountGrossFailures(const recon::SkeletonSequence& sequence,
                                 const recon::SkeletonSequence& judged,
                                 const recon::SkeletonSequence& recording) {
  GrossFailures out;
  const auto medians = MedianBones_m(recording);
  double jitter_sum_m = 0.0, jitter_count = 0.0;
  for (size_t f = 0; f < sequence.frames.size(); ++f) {
    const auto& frame = sequence.frames[f];
    const auto verdict = [&](size_t frame) -> const recon::SkeletonFrame& {
      return judged.frames[std::min(frame, judged.frames.size() - 1)];
    };
    for (const BodyRecord& now : frame.bodies) {
      ++out.frames;
      CountDoubts(BodyOf(verdict(f), now.id), out);
      for (size_t j = 1; j < kJointCount; ++j) {
        const auto bone = Between(now, recon::ParentOf(j), j);
        if (bone && medians[j] > 0.0 &&
            std::abs(bone->norm() - medians[j]) > kWrongBone * medians[j]) {
          ++out.wrong_bones;
        }
      }
      if (f == 0 || AfterAGap(sequence, f)) continue;
      const BodyRecord* before = BodyOf(sequence.frames[f - 1], now.id);
      if (before == nullptr) continue;
      const Verdicts verdicts{verdict(f - 1), verdict(f)};
      CountJumps(now, *before, verdicts, out);
      CountSnaps(now, *before, verdicts, out);
      const BodyRecord* older =
          f < 2 || AfterAGap(sequence, f - 1) ? nullptr : BodyOf(sequence.frames[f - 2], now.id);
      for (size_t j = 0; j < kJointCount && older != nullptr; ++j) {
        const auto a = At(now, j), b = At(*before, j), c = At(*older, j);
        if (!a || !b || !c) continue;
        jitter_sum_m += (*a - 2.0 * *b + *c).norm();
        jitter_count += 1.0;
      }
    }
  }
  out.jitter_cm = jitter_count > 0.0 ? 100.0 * jitter_sum_m / jitter_count : 0.0;
  return out;
}

}  // namespace ossa::tools
