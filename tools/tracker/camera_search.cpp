#include "tools/tracker/camera_search.h"

#include <algorithm>
#include <array>
#include <utility>

namespace ossa::tracker {
namespace {

using recon::Joint;

// Of whoever is seen, these are; where limbs are says little of their size.
constexpr std::array kTrunk = {Joint::kHead,          Joint::kShoulderCenter, Joint::kShoulderLeft,
                               Joint::kShoulderRight, Joint::kSpine,          Joint::kHipCenter,
                               Joint::kHipLeft,       Joint::kHipRight};

double MeasureSurety(const Body& body) {
  double sum = 0.0;
  for (const Joint joint : kTrunk) sum += body.joints[joint].confidence;
  return sum / static_cast<double>(kTrunk.size());
}

TrackerOptions OptionsOfStills(TrackerOptions options) {
  options.method = "none";
  options.physics = options.keep_parts = options.trace = false;
  options.keep_probabilities = options.keep_proposals = false;
  options.scene.reset();
  options.fit.reset();
  options.smoothing.reset();
  options.bones_m.clear();
  options.shapes.clear();
  options.lag = 0;
  return options;
}

}  // namespace

CameraSearch::CameraSearch(std::vector<depth::Camera> cameras, TrackerOptions options)
    : cameras_(std::move(cameras)),
      surety_(cameras_.size(), 0.0),
      tracker_(OptionsOfStills(std::move(options))) {}

void CameraSearch::Look(depth::DepthFrame frame) {
  constexpr double kAnybody = 0.3;  // surety, no unit; by hand: less is no part of anybody
  std::vector<double> surety(cameras_.size(), 0.0);
  for (size_t c = 0; c < cameras_.size(); ++c) {
    frame.camera = cameras_[c];
    tracker_.Reset();
    for (const Body& body : tracker_.Track(frame).bodies) {
      surety[c] = std::max(surety[c], MeasureSurety(body));
    }
  }
  if (*std::max_element(surety.begin(), surety.end()) < kAnybody) return;
  for (size_t c = 0; c < cameras_.size(); ++c) surety_[c] += surety[c];
  ++looks_;
}

size_t CameraSearch::Best() const {
  // Mean surety, no unit, by hand: real people seen by the right camera differ by less than 0.05
  // from the same seen by one of a view 1.44 times narrower, and by 0.17 to 1 the other way round.
  constexpr double kMuchSurer = 0.15;
  const auto best = std::max_element(surety_.begin(), surety_.end());
  return *best > surety_.front() + kMuchSurer * looks_ ? static_cast<size_t>(best - surety_.begin())
                                                       : 0;
}

}  // namespace ossa::tracker
