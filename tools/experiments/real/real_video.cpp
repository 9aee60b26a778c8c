// Recordings without truth: what can be said of a tracker without it.
#include <algorithm>
#include <cmath>
#include <deque>

#include "depth/image/camera.h"
#include "physics/anthropometry.h"
#include "tools/experiments/real/real_judge_internal.h"

namespace ossa::tools {
namespace {

// Constants: chosen by hand; they define the figures and are never tuned.
//
// A body of another number so near to where somebody was a frame ago is the same person.
constexpr double kSamePlace_m = 0.3;
// Windows in which a raw joint's halves have means so near to each other hold still.
constexpr size_t kWindow = 6;
constexpr double kStill_m = 0.01;
// A joint that is so much farther on a frame later leapt: no limb is moved so far between frames of
// 10 Hz.
constexpr double kLeap_m = 0.5;
// Clothes and hair stand off a capsule of the naked limb's mean radius by so much.
constexpr double kExplained_m = 0.05;
constexpr size_t kEveryPixel = 7;  // of a user's pixels that are held against the posed body

struct Sample {
  std::map<RealStage, StageJoints> joints;
};

struct Sums {
  std::map<RealStage, double> jitter_squares;
  std::map<RealStage, int64_t> jitter_count, leaps;
  std::map<RealStage, recon::JointArray<std::vector<double>>> bones_m;
  int64_t pixels = 0, explained = 0;
};

using Window = std::deque<Sample>;

bool HoldsStill(const Window& window, size_t j) {
  Eigen::Vector3d halves[2] = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  for (size_t k = 0; k < kWindow; ++k) {
    const auto& joint = window[k].joints.at(RealStage::kRaw)[j];
    if (!joint) return false;
    halves[2 * k / kWindow] += *joint / (kWindow / 2.0);
  }
  return (halves[0] - halves[1]).norm() < kStill_m;
}

void AddJitter(const Window& window, Sums& sums) {
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    if (!HoldsStill(window, j)) continue;
    for (const RealStage stage : kRealStages) {
      Eigen::Vector3d mean = Eigen::Vector3d::Zero();
      for (const Sample& sample : window) mean += *sample.joints.at(stage)[j] / double{kWindow};
      for (const Sample& sample : window) {
        sums.jitter_squares[stage] += (*sample.joints.at(stage)[j] - mean).squaredNorm();
        ++sums.jitter_count[stage];
      }
    }
  }
}

// Between the last two of somebody's samples. A joint that was not there cannot leap.
void AddLeaps(const Window& window, Sums& sums) {
  if (window.size() < 2) return;
  const Sample &now = window.back(), &before = window[window.size() - 2];
  for (const auto& [stage, joints] : now.joints) {
    for (size_t j = 0; j < recon::kJointCount; ++j) {
      const auto& was = before.joints.at(stage)[j];
      sums.leaps[stage] += joints[j] && was && (*joints[j] - *was).norm() > kLeap_m;
    }
  }
}

void AddBones(const Sample& sample, Sums& sums) {
  for (const auto& [stage, joints] : sample.joints) {
    for (size_t j = 1; j < recon::kJointCount; ++j) {
      const auto parent = recon::ParentOf(j);
      if (joints[j] && joints[parent]) {
        sums.bones_m[stage][j].push_back((*joints[j] - *joints[parent]).norm());
      }
    }
  }
}

double DistanceToSegment(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                         const Eigen::Vector3d& b) {
  const Eigen::Vector3d along = b - a;
  const double length2 = along.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - a).dot(along) / length2, 0.0, 1.0) : 0.0;
  return (p - a - t * along).norm();
}

// The final posture as capsules, against the pixels that are said to be this person's.
void AddExplained(const depth::DepthFrame& frame, const tracker::BodyFrame& answer,
                  const tracker::Body& body, const StageJoints& joints, Sums& sums) {
  recon::Posture posture;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    if (!joints[j]) return;
    posture.position_m[j] = *joints[j];
  }
  const physics::Segments segments = physics::ComputeSegments(recon::MeasureBoneLengths(posture));
  size_t nth = 0;
  for (size_t i = 0; i < answer.users.data.size(); ++i) {
    if (answer.users.data[i] != body.id || frame.depth_mm[i] == 0) continue;
    if (nth++ % kEveryPixel != 0) continue;
    const auto width = static_cast<size_t>(frame.camera.width);
    const Eigen::Vector3d point =
        depth::BackProject(frame.camera, static_cast<double>(i % width),
                           static_cast<double>(i / width), frame.depth_mm[i]);
    bool near = false;
    for (size_t j = 1; j < recon::kJointCount && !near; ++j) {
      const auto parent = recon::ParentOf(j);
      near = DistanceToSegment(point, posture.position_m[parent], posture.position_m[j]) <
             segments[j].radius_m + kExplained_m;
    }
    ++sums.pixels;
    sums.explained += near;
  }
}

int64_t CountBreaks(const tracker::BodyFrame& before, const tracker::BodyFrame& now) {
  const auto has = [](const tracker::BodyFrame& frame, int id) {
    return std::any_of(frame.bodies.begin(), frame.bodies.end(),
                       [&](const tracker::Body& body) { return body.id == id; });
  };
  int64_t breaks = 0;
  for (const tracker::Body& body : now.bodies) {
    if (has(before, body.id)) continue;
    breaks += std::any_of(before.bodies.begin(), before.bodies.end(), [&](const auto& old) {
      return !has(now, old.id) && (old.position_m - body.position_m).norm() < kSamePlace_m;
    });
  }
  return breaks;
}

// Per cent of the mean, averaged over the bones that were seen in two frames or more.
double MeasureVariation(const recon::JointArray<std::vector<double>>& bones_m) {
  double sum = 0;
  int count = 0;
  for (const std::vector<double>& lengths : bones_m) {
    if (lengths.size() < 2) continue;
    double mean = 0, squares = 0;
    for (const double l : lengths) mean += l / static_cast<double>(lengths.size());
    for (const double l : lengths) squares += (l - mean) * (l - mean);
    if (mean <= 0) continue;
    sum += 100 * std::sqrt(squares / static_cast<double>(lengths.size() - 1)) / mean;
    ++count;
  }
  return count == 0 ? 0.0 : sum / count;
}

void Finish(const Sums& sums, bool stills, VideoScore& score) {
  for (const auto& [stage, leaps] : sums.leaps) {
    score.leaps[stage] = 100.0 * static_cast<double>(leaps) / static_cast<double>(score.frames);
  }
  for (const RealStage stage : kRealStages) {
    const auto count = sums.jitter_count.find(stage);
    if (count != sums.jitter_count.end()) {
      score.jitter_mm[stage] =
          1000 * std::sqrt(sums.jitter_squares.at(stage) / static_cast<double>(count->second));
    }
    const auto bones = sums.bones_m.find(stage);
    if (!stills && bones != sums.bones_m.end())
      score.bone_variation[stage] = MeasureVariation(bones->second);
  }
  if (sums.pixels > 0) {
    score.explained = static_cast<double>(sums.explained) / static_cast<double>(sums.pixels);
  }
}

void CountAlone(const RealVideo& video, tracker::Tracker& tracker, VideoScore& score) {
  for (const depth::DepthFrame& frame : video.frames) {
    tracker.Reset();
    const size_t bodies = tracker.Track(frame).bodies.size();
    score.one_alone += bodies == 1;
    score.nobody_alone += bodies == 0;
  }
}

}  // namespace

VideoScore JudgeVideo(const RealVideo& video, tracker::Tracker& tracker) {
  VideoScore score;
  Sums sums;
  std::map<int, Window> windows;  // by body
  tracker::BodyFrame before;
  const auto judge = [&](const depth::DepthFrame& frame, tracker::BodyFrame answer) {
    ++score.frames;
    score.bodies += static_cast<int64_t>(answer.bodies.size());
    score.one_body += answer.bodies.size() == 1;
    if (!video.stills) score.identity_breaks += CountBreaks(before, answer);
    std::map<int, Window> next;
    for (const tracker::Body& body : answer.bodies) {
      Sample sample;
      for (const RealStage stage : kRealStages) sample.joints[stage] = JointsAtStage(body, stage);
      AddBones(sample, sums);
      AddExplained(frame, answer, body, sample.joints.at(RealStage::kFinal), sums);
      Window& window = next[body.id] = std::move(windows[body.id]);
      window.push_back(std::move(sample));
      if (window.size() > kWindow) window.pop_front();
      if (video.stills) continue;
      AddLeaps(window, sums);
      if (window.size() == kWindow) AddJitter(window, sums);
    }
    windows = std::move(next);
    before = std::move(answer);
  };
  std::deque<const depth::DepthFrame*> waiting;  // for their bodies, which are late by the lag
  const auto judge_first = [&](tracker::BodyFrame answer) {
    judge(*waiting.front(), std::move(answer));
    waiting.pop_front();
  };
  tracker.Reset();
  for (const depth::DepthFrame& frame : video.frames) {
    if (video.stills) {
      tracker.Reset();
      judge(frame, tracker.Track(frame));
      continue;
    }
    waiting.push_back(&frame);
    if (auto answer = tracker.TrackWithLag(frame)) judge_first(std::move(*answer));
  }
  while (auto held = tracker.DrainLag()) judge_first(std::move(*held));
  CountAlone(video, tracker, score);
  Finish(sums, video.stills, score);
  return score;
}

}  // namespace ossa::tools
