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
  std::optional<recon::Stature> estimated;  // of that shape
  // Fitted joints, one entry per frame: squared Mahalanobis distance from the truth (3 on average
  // if the covariances are right), estimated standard deviation, and error.
  recon::JointArray<std::vector<double>> normalised2, sigma_m, error_m;
  std::vector<double> fitted_m, final_m;  // mean error of a frame's joints
};

/// Options with the models of the command line, else the shipped ones.
tracker::TrackerOptions TrackerOptionsOf(const ExperimentContext& context);
Outcome TrackPerson(const RenderedPerson& person, const std::vector<LabelledFrame>& frames,
                    const tracker::TrackerOptions& options);

/// The fitted body within 0.6 m of the true joints (mean distance); null if there is none.
const tracker::Body* PersonIn(const tracker::BodyFrame& seen, const recon::Posture& truth);
double MeanError_m(const recon::Posture& a, const recon::Posture& truth);

/// Mean (NaN of no values), and the percentage of values within a bound, as text.
double Mean(const std::vector<double>& values);
std::string Share(const std::vector<double>& values, double within);

}  // namespace ossa::tools
