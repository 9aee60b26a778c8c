// Rendered people of known stature: errors of the surface fit and its own estimate of them.
#include <fmt/format.h>

#include <cmath>
#include <map>

#include "depth/base/statistics.h"
#include "tools/experiments/fit/track_person_internal.h"

namespace ossa::tools {
namespace {

/// A variant of the fit, run on each person.
struct Trial {
  std::string name;
  bool loose = false;
};

void AddStature(const std::string& name, const std::string& height,
                const std::vector<const Outcome*>& outcomes, Table& table) {
  std::vector<double> off_cm, absolute_cm, sigma_cm, normalised;
  for (const Outcome* outcome : outcomes) {
    if (!outcome->estimated) continue;
    off_cm.push_back(100.0 * (outcome->estimated->stature_m - outcome->stature_m));
    absolute_cm.push_back(std::abs(off_cm.back()));
    sigma_cm.push_back(100.0 * outcome->estimated->sigma_m);
    normalised.push_back(off_cm.back() / sigma_cm.back());
  }
  if (off_cm.empty()) return;
  table.rows.push_back({name, height, fmt::format("{} of {}", off_cm.size(), outcomes.size()),
                        fmt::format("{:.1f}", MedianOrNan(absolute_cm)),
                        fmt::format("{:+.1f}", Mean(off_cm)),
                        fmt::format("{:.1f}", MedianOrNan(sigma_cm)), Share(normalised, 1.0),
                        Share(normalised, 2.0)});
}

void AddStatures(const Trial& trial, const std::vector<Outcome>& outcomes, bool by_height,
                 Table& table) {
  std::map<std::string, std::vector<const Outcome*>> groups;
  std::vector<const Outcome*> all;
  for (const Outcome& outcome : outcomes) {
    groups[fmt::format("{:.1f} m", outcome.target_m)].push_back(&outcome);
    all.push_back(&outcome);
  }
  for (const auto& [height, group] : groups) {
    if (by_height) AddStature(trial.name, height, group, table);
  }
  AddStature(trial.name, "all", all, table);
}

struct JointGroup {
  const char* name;
  std::vector<recon::Joint> joints;
};

std::vector<JointGroup> JointGroups() {
  using J = recon::Joint;
  return {{"trunk", {J::kHipCenter, J::kSpine, J::kShoulderCenter}},
          {"head", {J::kHead}},
          {"shoulders", {J::kShoulderLeft, J::kShoulderRight}},
          {"elbows", {J::kElbowLeft, J::kElbowRight}},
          {"wrists", {J::kWristLeft, J::kWristRight}},
          {"hands", {J::kHandLeft, J::kHandRight}},
          {"hips", {J::kHipLeft, J::kHipRight}},
          {"knees", {J::kKneeLeft, J::kKneeRight}},
          {"ankles", {J::kAnkleLeft, J::kAnkleRight}},
          {"feet", {J::kFootLeft, J::kFootRight}}};
}

void AddJointErrors(const Trial& trial, const std::vector<Outcome>& outcomes, Table& table) {
  constexpr double kInner = 3.506,
                   kOuter = 7.815;  // by definition, chi-square of 3 degrees: 68, 95 %
  std::vector<double> all2, all_error, all_sigma;
  const auto add = [&](const std::string& name, const std::vector<double>& chi2,
                       const std::vector<double>& error_m, const std::vector<double>& sigma_m) {
    table.rows.push_back({trial.name, name, fmt::format("{:.1f}", 100 * MedianOrNan(error_m)),
                          fmt::format("{:.1f}", 100 * MedianOrNan(sigma_m)),
                          fmt::format("{:.2f}", MedianOrNan(chi2)), Share(chi2, kInner),
                          Share(chi2, kOuter)});
  };
  for (const JointGroup& group : JointGroups()) {
    std::vector<double> chi2, error_m, sigma_m;
    for (const Outcome& outcome : outcomes) {
      for (const recon::Joint joint : group.joints) {
        const auto append = [](auto& to, const auto& from) {
          to.insert(to.end(), from.begin(), from.end());
        };
        append(chi2, outcome.normalised2[joint]), append(all2, outcome.normalised2[joint]);
        append(error_m, outcome.error_m[joint]), append(all_error, outcome.error_m[joint]);
        append(sigma_m, outcome.sigma_m[joint]), append(all_sigma, outcome.sigma_m[joint]);
      }
    }
    add(group.name, chi2, error_m, sigma_m);
  }
  add("all", all2, all_error, all_sigma);
}

}  // namespace

std::vector<Table> FitPeople(ExperimentContext& context) {
  const FitSettings settings = ReadFitSettings(context.parameters);
  const PersonRenderer renderer(context, settings.people_per_height, settings.train_shapes);
  const tracker::TrackerOptions options = TrackerOptionsOf(context);
  Table stature{.title = "Stature of rendered people after 3 s",
                .columns = {"what", "stature", "people", "off, median, cm", "mean, cm",
                            "estimated sigma, cm", "within 1 sigma, %", "within 2 sigma, %"},
                .rows = {},
                .note = "Right error bars hold 68 and 95 %."};
  Table joints{.title = "Fitted joints of rendered people and their error bars",
               .columns = {"what", "joints", "off, median, cm", "estimated, median, cm",
                           "chi-square, median", "within 68 %, %", "within 95 %, %"},
               .rows = {},
               .note =
                   "chi-square: squared error by the joint's covariance; of a right one the "
                   "median is 2.37, 68 and 95 % lie within its ellipsoids of that share. "
                   "Neighbouring frames are wrong alike: shares are of frames."};
  for (const Trial& trial : {Trial{"as they are", false}, Trial{"loose clothes", true}}) {
    std::vector<Outcome> outcomes;
    for (const RenderedPerson& person : renderer.people()) {
      context.ThrowIfInterrupted();
      outcomes.push_back(TrackPerson(person, renderer.RenderClip(person, trial.loose), options));
      if (context.progress) {
        context.progress(static_cast<double>(outcomes.size()),
                         static_cast<double>(renderer.people().size()), trial.name);
      }
    }
    AddStatures(trial, outcomes, !trial.loose, stature);
    AddJointErrors(trial, outcomes, joints);
  }
  return {stature, joints};
}

}  // namespace ossa::tools
