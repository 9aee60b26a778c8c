// Measures of recordings without truth.
#include <algorithm>
#include <deque>

#include "depth/image/camera.h"
#include "physics/anthropometry.h"
#include "tools/experiments/real/real_evaluation_internal.h"
#include "tools/experiments/real/steadiness_internal.h"

namespace ossa::tools {
namespace {

// Constants: chosen by hand; they define the figures and are never tuned.
//
// A body with a new id nearer than this to a body of the previous frame is the same person.
constexpr double kSamePlace_m = 0.3;
// Distance of clothes and hair from a capsule with the naked limb's mean radius.
constexpr double kExplained_m = 0.05;
constexpr size_t kEveryPixel = 7;  // every 7th pixel of a user is compared with the posed body

struct Explained {
  int64_t pixels = 0, near = 0;
};

double DistanceToSegment(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                         const Eigen::Vector3d& b) {
  const Eigen::Vector3d along = b - a;
  const double length2 = along.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - a).dot(along) / length2, 0.0, 1.0) : 0.0;
  return (p - a - t * along).norm();
}

// The final posture as capsules, compared with the pixels of this person.
void AddExplained(const depth::DepthFrame& frame, const tracker::BodyFrame& answer,
                  const tracker::Body& body, const StageJoints& joints, Explained& explained) {
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
    ++explained.pixels;
    explained.near += near;
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

void CountAlone(const RealVideo& video, tracker::Tracker& tracker, VideoScore& score) {
  for (const depth::DepthFrame& frame : video.frames) {
    tracker.Reset();
    const size_t bodies = tracker.Track(frame).bodies.size();
    score.one_alone += bodies == 1;
    score.nobody_alone += bodies == 0;
  }
}

// Stills are evaluated independently, without measures of motion.
class VideoEvaluator {
 public:
  explicit VideoEvaluator(bool stills) : stills_(stills) {}

  void AddFrame(const depth::DepthFrame& frame, tracker::BodyFrame answer) {
    ++score_.frames;
    score_.bodies += static_cast<int64_t>(answer.bodies.size());
    score_.one_body += answer.bodies.size() == 1;
    std::map<int, BodyStages> bodies;
    for (const tracker::Body& body : answer.bodies) {
      BodyStages& stages = bodies[body.id];
      for (const RealStage stage : kRealStages) stages[stage] = JointsAtStage(body, stage);
      AddExplained(frame, answer, body, stages.at(RealStage::kFinal), explained_);
    }
    if (stills_) return;
    score_.identity_breaks += CountBreaks(before_, answer);
    steadiness_.Add(bodies);
    before_ = std::move(answer);
  }

  VideoScore Score() const {
    VideoScore score = score_;
    score.jitter_mm = steadiness_.MeasureJitter();
    score.bone_variation = steadiness_.MeasureBoneVariation();
    score.leaps = steadiness_.CountLeaps();
    if (explained_.pixels > 0) {
      score.explained =
          static_cast<double>(explained_.near) / static_cast<double>(explained_.pixels);
    }
    return score;
  }

 private:
  bool stills_;
  VideoScore score_;
  Explained explained_;
  Steadiness steadiness_;
  tracker::BodyFrame before_;
};

void EvaluateStills(const RealVideo& video, tracker::Tracker& tracker, VideoEvaluator* evaluator) {
  for (const depth::DepthFrame& frame : video.frames) {
    tracker.Reset();
    evaluator->AddFrame(frame, tracker.Track(frame));
  }
}

void EvaluateMotion(const RealVideo& video, tracker::Tracker& tracker, VideoEvaluator* evaluator) {
  std::deque<const depth::DepthFrame*> waiting;  // for their bodies, which lag behind
  const auto add_first = [&](tracker::BodyFrame answer) {
    evaluator->AddFrame(*waiting.front(), std::move(answer));
    waiting.pop_front();
  };
  tracker.Reset();
  for (const depth::DepthFrame& frame : video.frames) {
    waiting.push_back(&frame);
    if (auto answer = tracker.TrackWithLag(frame)) add_first(std::move(*answer));
  }
  while (auto held = tracker.DrainLag()) add_first(std::move(*held));
}

}  // namespace

VideoScore EvaluateVideo(const RealVideo& video, tracker::Tracker& tracker) {
  VideoEvaluator evaluator(video.stills);
  (video.stills ? EvaluateStills : EvaluateMotion)(video, tracker, &evaluator);
  VideoScore score = evaluator.Score();
  CountAlone(video, tracker, score);
  return score;
}

}  // namespace ossa::tools
