#include "tools/commands/fit_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "tools/commands/command.h"
#include "tools/commands/method_options.h"
#include "tools/tracker/shipped.h"

namespace ossa::commands {
namespace {

// Whether there are joints that a surface fit starts from: refined ones, or those of the forest for
// ceilings.
bool HasJointsToFit(const FitNeeds& needs) {
  const tracker::ModelFiles& files = needs.files;
  const bool has_shipped = tracker::FindShippedRefinement(files) != nullptr;
  const bool is_ceilings_forest = has_shipped && !tracker::IsShippedForest(files);
  if (needs.mount == "ceiling" || (needs.mount == "auto" && is_ceilings_forest)) return true;
  if (!files.refinement.empty()) return files.refinement != "none";
  return has_shipped && RequireMethodInfo(needs.method).refined;
}

}  // namespace

void AddFitOptions(CLI::App& app, FitArguments& arguments) {
  app.add_option("--fit", arguments.fit,
                 "fit a body's surface to the depth image, starting from the refined joints: on or "
                 "off (default: on if there are refined joints)")
      ->check(CLI::IsMember({"on", "off"}));
  app.add_option("--person", arguments.people,
                 "FILE.ossaperson of --save-person: body shape of the first person who comes into "
                 "view (id 1); given again, of the next one")
      ->allow_extra_args(false);
}

void CheckFit(const FitArguments& arguments, const FitNeeds& needs) {
  if (arguments.is_off()) throw Contradiction("--posture fitted: expected --fit on, found off");
  if (needs.files.surface == "none") {
    throw Contradiction(
        "--fit on: expected --surface FILE.ossasurface of 'ossa surface' with it, found none");
  }
  if (!HasJointsToFit(needs)) {
    throw Contradiction(
        "--fit on: expected --refinement FILE.ossarefine of 'ossa refine' with it, found none");
  }
}

// --person and --save-person need a surface fit.
void CheckPeople(const FitArguments& arguments, const std::string& save_person,
                 const FitNeeds& needs) {
  const bool has_any = !arguments.people.empty() || !save_person.empty();
  const char* option = arguments.people.empty() ? "--save-person" : "--person";
  if (has_any && arguments.is_off()) {
    throw Contradiction(fmt::format("{}: expected a surface fit, found --fit off", option));
  }
  if (has_any && needs.files.surface == "none") {
    throw Contradiction(fmt::format("{}: expected a body surface, found --surface none", option));
  }
  if (has_any && !HasJointsToFit(needs)) {
    throw Contradiction(fmt::format(
        "{}: expected refined joints, to which a body is fitted (--method best, or --refinement "
        "FILE.ossarefine of 'ossa refine'), found none",
        option));
  }
  const auto most = static_cast<size_t>(needs.max_users);
  if (arguments.people.size() > most) {
    throw Contradiction(
        fmt::format("--person: expected at most {} files, as --users says, found {}", most,
                    arguments.people.size()));
  }
}

std::map<int, recon::PersonShape> ReadPeople(const FitArguments& arguments,
                                             const tracker::ModelSet& models) {
  std::map<int, recon::PersonShape> shapes;
  for (const std::string& file : arguments.people) {
    const int id = static_cast<int>(shapes.size()) + 1;
    shapes[id] = recon::PersonShape::Load(file, *models.surface);
  }
  return shapes;
}

}  // namespace ossa::commands
