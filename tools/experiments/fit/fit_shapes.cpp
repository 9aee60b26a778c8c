// People fitted with the person file of another person: the effect of a wrong shape on joints and
// stature.
#include <fmt/format.h>

#include <cmath>

#include "depth/base/statistics.h"
#include "tools/experiments/fit/track_person_internal.h"

namespace ossa::tools {
namespace {

// The person's shape scaled to another stature, with the same covariance.
recon::PersonShape ShiftStature(const recon::PersonShape& person, double by_m,
                                const recon::BodySurface& surface) {
  const recon::ShapeVector& stature = surface.stature_by_shape_m;
  const recon::ShapeVector more = by_m / stature.squaredNorm() * stature;
  recon::PersonShape other = person;
  other.shape += more;
  other.vote += person.information * more;
  return other;
}

struct Wrong {
  std::string name;
  std::optional<double> by_m;  // empty: no person file
};

void AddRow(const Wrong& wrong, const std::vector<Outcome>& outcomes, Table& table) {
  std::vector<double> fitted_cm, final_cm, stature_cm, normalised;
  for (const Outcome& outcome : outcomes) {
    for (const double error_m : outcome.fitted_m) fitted_cm.push_back(100.0 * error_m);
    for (const double error_m : outcome.final_m) final_cm.push_back(100.0 * error_m);
    if (!outcome.estimated) continue;
    const double off_m = outcome.estimated->stature_m - outcome.stature_m;
    stature_cm.push_back(100.0 * std::abs(off_m));
    normalised.push_back(off_m / outcome.estimated->sigma_m);
  }
  table.rows.push_back({wrong.name, std::to_string(stature_cm.size()),
                        fmt::format("{:.1f}", MedianOrNan(fitted_cm)),
                        fmt::format("{:.1f}", MedianOrNan(final_cm)),
                        fmt::format("{:.1f}", MedianOrNan(stature_cm)), Share(normalised, 2.0)});
}

}  // namespace

std::vector<Table> FitWrongShapes(ExperimentContext& context) {
  const FitSettings settings = ReadFitSettings(context.parameters);
  const PersonRenderer renderer(context, settings.shape_people_per_height, settings.train_shapes);
  const tracker::TrackerOptions options = TrackerOptionsOf(context);
  Table table{.title = "Rendered people with a person file, their own and others'",
              .columns = {"file of", "people", "fitted joints off, cm", "final joints off, cm",
                          "stature off, cm", "within 2 sigma, %"},
              .rows = {},
              .note =
                  "Medians; 3 s each. The file is what 3 s of the same motion told, moved along "
                  "stature."};
  // By hand: differences within a family, and between a child and an adult.
  const std::vector<Wrong> wrongs = {{"nobody", {}},          {"themselves", 0.0},
                                     {"5 cm taller", 0.05},   {"10 cm taller", 0.1},
                                     {"10 cm shorter", -0.1}, {"30 cm taller", 0.3}};
  std::vector<std::vector<Outcome>> outcomes(wrongs.size());
  for (const RenderedPerson& person : renderer.people()) {
    context.ThrowIfInterrupted();
    const std::vector<LabelledFrame> frames = renderer.RenderClip(person, false);
    for (size_t k = 0; k < wrongs.size(); ++k) {
      tracker::TrackerOptions with = options;
      const auto& known = k > 0 ? outcomes[0].back().shape : std::nullopt;
      if (known) with.shapes[1] = ShiftStature(*known, *wrongs[k].by_m, *options.models->surface);
      outcomes[k].push_back(TrackPerson(person, frames, with));
    }
    if (context.progress) {
      context.progress(static_cast<double>(outcomes[0].size()),
                       static_cast<double>(renderer.people().size()), "wrong shapes");
    }
  }
  for (size_t k = 0; k < wrongs.size(); ++k) AddRow(wrongs[k], outcomes[k], table);
  return {table};
}

}  // namespace ossa::tools
