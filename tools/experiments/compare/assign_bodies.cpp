#include "tools/experiments/compare/assign_bodies.h"

#include <algorithm>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

#include "tools/experiments/compare/rigid_transform.h"
#include "tools/experiments/compare/select_evenly.h"

namespace ossa::tools {
namespace {

// Constants: chosen by hand.

constexpr size_t kMostMoments = 200;  // evaluated, evenly spaced; for speed
constexpr size_t kMostIds = 8;        // of a result, those in most frames; for speed
constexpr double kMissed_m = 1.0;     // cost of a person without a body, or with a farther one

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

bool HasChoice(const Moment& moment) {
  return !moment.bodies.empty() && (moment.truths.size() > 1 || moment.bodies.size() > 1);
}

std::vector<int> FrequentIds(const std::vector<const Moment*>& moments) {
  std::map<int, size_t> frames_of;
  for (const Moment* moment : moments) {
    for (const int id : moment->ids) ++frames_of[id];
  }
  std::vector<std::pair<int, size_t>> by_frames(frames_of.begin(), frames_of.end());
  std::stable_sort(by_frames.begin(), by_frames.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  by_frames.resize(std::min(by_frames.size(), kMostIds));
  std::vector<int> ids;
  for (const auto& [id, frames] : by_frames) ids.push_back(id);
  return ids;
}

// The transform that aligns the body with the person; empty if they share too few joints.
std::optional<Eigen::Matrix4d> TransformOnto(const std::vector<const Moment*>& moments,
                                             size_t person, int id) {
  CommonJoints common;
  for (const Moment* moment : moments) {
    const auto found = std::find(moment->ids.begin(), moment->ids.end(), id);
    if (found == moment->ids.end() || !moment->truths[person]) continue;
    common.Add(moment->bodies[static_cast<size_t>(found - moment->ids.begin())],
               *moment->truths[person]);
  }
  return common.Align();
}

// Mean distance of people from their assigned bodies.
double MeanMiss_m(const std::vector<const Moment*>& moments, const Eigen::Matrix4d& transform) {
  double sum_m = 0.0, people = 0.0;
  for (const Moment* moment : moments) {
    Moment moved = *moment;
    for (SparsePosture& body : moved.bodies) body = Moved(transform, std::move(body));
    const auto taken = AssignBodies(moved);
    for (size_t t = 0; t < taken.size(); ++t) {
      if (!moved.truths[t]) continue;
      sum_m += std::min(kMissed_m, MeanDistance(*moved.truths[t], taken[t]));
      people += 1.0;
    }
  }
  return people > 0.0 ? sum_m / people : 0.0;
}

}  // namespace

std::vector<SparsePosture> AssignBodies(const Moment& moment) {
  const auto& [time_s, truths, bodies, ids] = moment;
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

Eigen::Matrix4d FindCommonTransform(const std::vector<Moment>& moments) {
  Eigen::Matrix4d best = Eigen::Matrix4d::Identity();
  if (std::none_of(moments.begin(), moments.end(), HasChoice)) return best;
  std::vector<const Moment*> all;
  for (const Moment& moment : moments) all.push_back(&moment);
  const auto some = SelectEvenly(std::move(all), kMostMoments);
  double least_m = MeanMiss_m(some, best);
  for (const int id : FrequentIds(some)) {
    for (size_t person = 0; person < moments.front().truths.size(); ++person) {
      const auto transform = TransformOnto(some, person, id);
      if (!transform) continue;
      const double miss_m = MeanMiss_m(some, *transform);
      if (miss_m >= least_m) continue;
      least_m = miss_m;
      best = *transform;
    }
  }
  return best;
}

void MoveBodies(const Eigen::Matrix4d& transform, std::vector<Moment>& moments) {
  for (Moment& moment : moments) {
    for (SparsePosture& body : moment.bodies) body = Moved(transform, std::move(body));
  }
}

SparsePosture Moved(const Eigen::Matrix4d& transform, SparsePosture posture) {
  for (Eigen::Vector3d& position_m : posture.position_m) {
    position_m = (transform * position_m.homogeneous()).head<3>();
  }
  return posture;
}

}  // namespace ossa::tools
