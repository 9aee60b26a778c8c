#include "tools/experiments/real/steadiness_internal.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace ossa::tools {
namespace {

// Constants: chosen by hand; they define the figures and are never tuned.
//
// Joints whose mean raw positions over the two halves of a window are nearer than this rest.
constexpr size_t kWindow = 6;
constexpr double kStill_m = 0.01;
// A joint that moves farther than this between two frames leaps: no limb moves so far in 0.1 s.
constexpr double kLeap_m = 0.5;

bool IsThroughout(const std::deque<BodyStages>& window, RealStage stage, size_t j) {
  return std::all_of(window.begin(), window.end(),
                     [&](const BodyStages& body) { return body.at(stage)[j].has_value(); });
}

bool IsStill(const std::deque<BodyStages>& window, size_t j) {
  if (!IsThroughout(window, RealStage::kRaw, j)) return false;
  Eigen::Vector3d halves[2] = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  for (size_t k = 0; k < kWindow; ++k) {
    halves[2 * k / kWindow] += *window[k].at(RealStage::kRaw)[j] / (kWindow / 2.0);
  }
  return (halves[0] - halves[1]).norm() < kStill_m;
}

// Percent of the mean, averaged over the bones with a length in two frames or more.
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

}  // namespace

void Steadiness::Add(const std::map<int, BodyStages>& bodies) {
  ++frames_;
  std::map<int, Window> next;
  for (const auto& [id, body] : bodies) {
    AddBones(body);
    Window& window = next[id] = std::move(windows_[id]);
    window.push_back(body);
    if (window.size() > kWindow) window.pop_front();
    AddLeaps(window);
    if (window.size() == kWindow) AddJitter(window);
  }
  windows_ = std::move(next);
}

void Steadiness::AddJitter(const Window& window) {
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    if (!IsStill(window, j)) continue;
    for (const RealStage stage : kRealStages) {
      if (!IsThroughout(window, stage, j)) continue;
      Eigen::Vector3d mean = Eigen::Vector3d::Zero();
      for (const BodyStages& body : window) mean += *body.at(stage)[j] / double{kWindow};
      for (const BodyStages& body : window) {
        jitter_squares_[stage] += (*body.at(stage)[j] - mean).squaredNorm();
        ++jitter_count_[stage];
      }
    }
  }
}

// A joint without a position a frame before cannot leap.
void Steadiness::AddLeaps(const Window& window) {
  if (window.size() < 2) return;
  const BodyStages& before = window[window.size() - 2];
  for (const auto& [stage, joints] : window.back()) {
    for (size_t j = 0; j < recon::kJointCount; ++j) {
      const auto& was = before.at(stage)[j];
      leaps_[stage] += joints[j] && was && (*joints[j] - *was).norm() > kLeap_m;
    }
  }
}

void Steadiness::AddBones(const BodyStages& body) {
  for (const auto& [stage, joints] : body) {
    for (size_t j = 1; j < recon::kJointCount; ++j) {
      const auto parent = recon::ParentOf(j);
      if (joints[j] && joints[parent]) {
        bones_m_[stage][j].push_back((*joints[j] - *joints[parent]).norm());
      }
    }
  }
}

std::map<RealStage, double> Steadiness::MeasureJitter() const {
  std::map<RealStage, double> jitter_mm;
  for (const auto& [stage, count] : jitter_count_) {
    jitter_mm[stage] = 1000 * std::sqrt(jitter_squares_.at(stage) / static_cast<double>(count));
  }
  return jitter_mm;
}

std::map<RealStage, double> Steadiness::MeasureBoneVariation() const {
  std::map<RealStage, double> variation;
  for (const auto& [stage, bones_m] : bones_m_) variation[stage] = MeasureVariation(bones_m);
  return variation;
}

std::map<RealStage, double> Steadiness::CountLeaps() const {
  std::map<RealStage, double> leaps;
  for (const auto& [stage, count] : leaps_) {
    leaps[stage] = 100.0 * static_cast<double>(count) / static_cast<double>(frames_);
  }
  return leaps;
}

}  // namespace ossa::tools
