// Basin of convergence of the surface fit: started from the forest's joints, and from true joints
// with random errors.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <functional>

#include "depth/base/random.h"
#include "depth/base/statistics.h"
#include "tools/experiments/fit/track_person_internal.h"

namespace ossa::tools {
namespace {

using recon::Joint;
using recon::kJointCount;
using recon::Posture;

/// One frame of a clip as input of the fit, without knowledge of the person's shape.
struct Still {
  depth::DepthFrame depth;
  std::vector<int32_t> pixels;
  std::vector<uint8_t> parts;  // of the pixels
  recon::JointArray<std::optional<double>> confidence;
  Posture raw, refined, truth;

  recon::SurfaceFitInput From(const Posture& start_m, bool sure) const {
    recon::SurfaceFitInput input;
    input.joints_m = start_m;
    input.confidence = confidence;
    if (!sure) input.confidence.fill(std::nullopt);
    input.depth = &depth;
    input.pixels = input.samples = pixels;
    input.parts = parts;
    return input;
  }
};

Still StillOf(const LabelledFrame& frame, const tracker::BodyFrame& seen,
              const tracker::Body& body) {
  Still still;
  still.depth = frame.depth;
  for (size_t i = 0; i < seen.users.data.size(); ++i) {
    if (seen.users.data[i] != body.id) continue;
    still.pixels.push_back(static_cast<int32_t>(i));
    still.parts.push_back(seen.parts.data[i]);
  }
  for (size_t j = 0; j < kJointCount; ++j) {
    const bool found = body.raw.state[j] != recon::TrackingState::kNotTracked;
    still.confidence[j] = found ? body.raw.confidence[j] : 0.0;
  }
  still.raw = body.raw.posture;
  still.refined = *body.refined;
  still.truth = frame.bodies[0].joints_m;
  return still;
}

// Three of each sequence, a second apart.
void AddStills(const std::vector<LabelledFrame>& frames, const tracker::TrackerOptions& options,
               std::vector<Still>& stills) {
  constexpr size_t kFirst = 15, kApart = 30;  // by hand, frames
  tracker::Tracker tracker(options);
  for (size_t f = 0; f < frames.size(); ++f) {
    const tracker::BodyFrame seen = tracker.Track(frames[f].depth);
    const tracker::Body* body = PersonIn(seen, frames[f].bodies[0].joints_m);
    if (f % kApart == kFirst && body != nullptr) {
      stills.push_back(StillOf(frames[f], seen, *body));
    }
  }
}

/// The start of a fit.
struct Start {
  std::string name;
  std::function<Posture(const Still&, Random&)> joints_m;
};

Start NoisyStart(double sigma_m) {
  return {fmt::format("true ones, each {:.0f} cm an axis", 100 * sigma_m),
          [sigma_m](const Still& still, Random& random) {
            Posture start_m = still.truth;
            for (Eigen::Vector3d& at_m : start_m.position_m) {
              for (double& value : at_m) value += random.Normal(0.0, sigma_m);
            }
            return start_m;
          }};
}

Start Shifted(double by_m) {
  return {fmt::format("true ones, all {:.0f} cm aside", 100 * by_m),
          [by_m](const Still& still, Random& random) {
            const double way_rad = random.Uniform(0.0, 2.0 * M_PI);
            Posture start_m = still.truth;
            for (Eigen::Vector3d& at_m : start_m.position_m) {
              at_m += by_m * Eigen::Vector3d(std::cos(way_rad), 0.0, std::sin(way_rad));
            }
            return start_m;
          }};
}

Start Turned(double by_deg) {
  return {fmt::format("true ones, turned by {:.0f} degrees", by_deg),
          [by_deg](const Still& still, Random& random) {
            const double sign = random.Chance(0.5) ? 1.0 : -1.0;
            const Eigen::AngleAxisd turn(sign * by_deg * M_PI / 180.0, Eigen::Vector3d::UnitY());
            const Eigen::Vector3d& about_m = still.truth[Joint::kHipCenter];
            Posture start_m = still.truth;
            for (Eigen::Vector3d& at_m : start_m.position_m) {
              at_m = about_m + turn * (at_m - about_m);
            }
            return start_m;
          }};
}

std::vector<Start> Starts(const std::vector<Still>& stills) {
  const auto of_another = [&stills](const Still& still, Random& random) {
    const Posture& other = stills[random.Index(stills.size())].truth;
    Posture start_m = other;
    for (Eigen::Vector3d& at_m : start_m.position_m) {
      at_m += still.truth[Joint::kHipCenter] - other[Joint::kHipCenter];
    }
    return start_m;
  };
  return {{"the forest's", [](const Still& still, Random&) { return still.raw; }},
          {"the refined ones", [](const Still& still, Random&) { return still.refined; }},
          {"the true ones", [](const Still& still, Random&) { return still.truth; }},
          NoisyStart(0.03),
          NoisyStart(0.06),
          NoisyStart(0.1),
          NoisyStart(0.15),
          NoisyStart(0.2),
          Shifted(0.1),
          Shifted(0.2),
          Shifted(0.3),
          Turned(30.0),
          Turned(60.0),
          Turned(90.0),
          {"another's, at one's place", of_another}};
}

/// Results of the fits from one kind of start.
struct Ends {
  std::vector<double> start_cm, sure_cm, unsure_cm, explained;
  size_t retried = 0;
};

Ends FitFrom(const Start& start, const std::vector<Still>& stills,
             const recon::BodySurface& surface, uint64_t seed) {
  recon::SurfaceFitter fitter(surface);
  Ends ends;
  for (size_t i = 0; i < stills.size(); ++i) {
    const Still& still = stills[i];
    Random random(seed, i);
    const Posture start_m = start.joints_m(still, random);
    const auto sure = fitter.Fit(still.From(start_m, true));
    const auto unsure = fitter.Fit(still.From(start_m, false));
    if (!sure || !unsure) continue;
    ends.start_cm.push_back(100.0 * MeanError_m(start_m, still.truth));
    ends.sure_cm.push_back(100.0 * MeanError_m(sure->joints_m, still.truth));
    ends.unsure_cm.push_back(100.0 * MeanError_m(unsure->joints_m, still.truth));
    ends.explained.push_back(100.0 * sure->explained);
    ends.retried += sure->retried;
  }
  return ends;
}

void AddRows(const std::string& clothes, const std::vector<Still>& stills,
             const recon::BodySurface& surface, uint64_t seed, Table& table) {
  constexpr double kFound_cm = 5.0;  // by hand: mean of a body's joints
  for (const Start& start : Starts(stills)) {
    const Ends ends = FitFrom(start, stills, surface, seed);
    const double fits = static_cast<double>(ends.sure_cm.size());
    table.rows.push_back({clothes, start.name, std::to_string(ends.sure_cm.size()),
                          fmt::format("{:.1f}", MedianOrNan(ends.start_cm)),
                          fmt::format("{:.1f}", MedianOrNan(ends.sure_cm)),
                          Share(ends.sure_cm, kFound_cm), Share(ends.unsure_cm, kFound_cm),
                          fmt::format("{:.0f}", MedianOrNan(ends.explained)),
                          fmt::format("{:.0f}", 100.0 * static_cast<double>(ends.retried) / fits)});
  }
}

}  // namespace

std::vector<Table> FitStarts(ExperimentContext& context) {
  const FitSettings settings = ReadFitSettings(context.parameters);
  const PersonRenderer renderer(context, settings.start_people_per_height, settings.train_shapes);
  tracker::TrackerOptions options = TrackerOptionsOf(context);
  options.keep_parts = true;
  Table table{
      .title = "Where fits end, by where they begin: one image, nothing known of the shape",
      .columns = {"clothes", "begins with joints", "fits", "off at first, cm", "fitted, cm",
                  "within 5 cm, %", "unsure: within 5 cm, %", "explained, %", "second fit, %"},
      .rows = {},
      .note =
          "Mean distance of a body's 20 joints from the truth, medians over stills. The "
          "fit believes joints as much as the forest did; unsure: nothing is known of "
          "them, only the first posture comes from them. Second fit: of those from "
          "sure joints that were kept."};
  for (const bool loose : {false, true}) {
    std::vector<Still> stills;
    for (const RenderedPerson& person : renderer.people()) {
      context.ThrowIfInterrupted();
      AddStills(renderer.RenderClip(person, loose), options, stills);
    }
    AddRows(loose ? "loose" : "as they are", stills, *options.models->surface, context.seed, table);
  }
  return {table};
}

}  // namespace ossa::tools
