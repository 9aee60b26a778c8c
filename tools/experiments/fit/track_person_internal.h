#pragma once
#include <optional>
#include <string>
#include <vector>

#include "recon/fit/surface_fit.h"
#include "tools/experiments/fit/person_renderer_internal.h"
#include "tools/tracker/tracker.h"

namespace ossa::tools {

/// Results of the tracker for one rendered person.
struct Outcome {
  double target_m = 0.0, stature_m = 0.0;
  std::optional<recon::PersonShape> shape;  // after the last frame
  std::optional<recon::Stature> said;       // by that
  // Of fitted joints, one of each frame: squared distance in standard deviations (3 in the mean
  // where covariances are right), what they say that they may be off by, and what they are.
  recon::JointArray<std::vector<double>> normalised2, sigma_m, error_m;
  std::vector<double> fitted_m, final_m;  // mean error of a frame's joints
};

/// The shipped models, or those of the command line.
tracker::TrackerOptions TrackerOptionsOf(const ExperimentContext& context);
Outcome TrackPerson(const RenderedPerson& person, const std::vector<LabelledFrame>& frames,
                    const tracker::TrackerOptions& options);

/// The fitted body at these joints; null where there is none.
const tracker::Body* PersonIn(const tracker::BodyFrame& seen, const recon::Posture& truth);
double MeanError_m(const recon::Posture& a, const recon::Posture& truth);

/// Of several frames or people: the median and the mean, NaN of none; how many are within a bound,
/// as a text in percent.
double Middle(const std::vector<double>& values);
double Mean(const std::vector<double>& values);
std::string Share(const std::vector<double>& values, double within);

}  // namespace ossa::tools
