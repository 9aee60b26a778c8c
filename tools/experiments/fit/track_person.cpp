#include "tools/experiments/fit/track_person_internal.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "depth/base/statistics.h"
#include "tools/experiments/context_models.h"

namespace ossa::tools {
namespace {

using recon::kJointCount;

double Chi2(const Eigen::Vector3d& off_m, const Eigen::Matrix3d& covariance_m2) {
  return off_m.dot(covariance_m2.inverse() * off_m);
}

void AddFit(const tracker::Body& body, const recon::Posture& truth, Outcome& outcome) {
  for (size_t j = 0; j < kJointCount; ++j) {
    const Eigen::Vector3d off_m = body.fit->joints_m.position_m[j] - truth.position_m[j];
    outcome.normalised2[j].push_back(Chi2(off_m, body.fit->covariance_m2[j]));
    outcome.sigma_m[j].push_back(std::sqrt(body.fit->covariance_m2[j].trace()));
    outcome.error_m[j].push_back(off_m.norm());
  }
  outcome.fitted_m.push_back(MeanError_m(body.fit->joints_m, truth));
  outcome.final_m.push_back(MeanError_m(tracker::ToPosture(body), truth));
  outcome.shape = body.shape;
}

}  // namespace

tracker::TrackerOptions TrackerOptionsOf(const ExperimentContext& context) {
  tracker::TrackerOptions options;
  options.models = LoadModels(context, options.method);
  options.threads = context.threads;
  return options;
}

double MeanError_m(const recon::Posture& a, const recon::Posture& truth) {
  double sum = 0.0;
  for (size_t j = 0; j < kJointCount; ++j) sum += (a.position_m[j] - truth.position_m[j]).norm();
  return sum / kJointCount;
}

const tracker::Body* PersonIn(const tracker::BodyFrame& seen, const recon::Posture& truth) {
  constexpr double kReach_m = 0.6;  // by hand: farther bodies are other people
  for (const tracker::Body& body : seen.bodies) {
    if (body.fit && MeanError_m(tracker::ToPosture(body), truth) < kReach_m) return &body;
  }
  return nullptr;
}

Outcome TrackPerson(const RenderedPerson& person, const std::vector<LabelledFrame>& frames,
                    const tracker::TrackerOptions& options) {
  tracker::Tracker tracker(options);
  Outcome outcome;
  outcome.target_m = person.target_m;
  outcome.stature_m = person.stature_m;
  for (const LabelledFrame& frame : frames) {
    const tracker::BodyFrame seen = tracker.Track(frame.depth);
    const tracker::Body* body = PersonIn(seen, frame.bodies[0].joints_m);
    if (body != nullptr) AddFit(*body, frame.bodies[0].joints_m, outcome);
  }
  if (outcome.shape) outcome.estimated = MeasureStature(*outcome.shape, *options.models->surface);
  return outcome;
}

double Mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

std::string Share(const std::vector<double>& values, double within) {
  const auto count = std::count_if(values.begin(), values.end(),
                                   [&](double value) { return std::abs(value) <= within; });
  return fmt::format("{:.0f}",
                     100.0 * static_cast<double>(count) / static_cast<double>(values.size()));
}

}  // namespace ossa::tools
