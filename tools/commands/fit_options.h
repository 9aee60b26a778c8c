#pragma once
#include <map>
#include <string>
#include <vector>

#include "recon/fit/surface_fit.h"
#include "tools/tracker/model_set.h"

namespace CLI {
class App;
}

namespace ossa::commands {

/// Whether a body's surface is fitted to people, and to whose shape, of commands that track.
struct FitArguments {
  std::string fit;                  // "on" or "off"; "": where there are joints that it starts from
  std::vector<std::string> people;  // person files, of the ids from 1 on

  bool is_off() const { return fit == "off"; }
};

/// --fit and --person.
void AddFitOptions(CLI::App& app, FitArguments& arguments);

/// The other options that a surface fit depends on.
struct FitNeeds {
  const tracker::ModelFiles& files;
  const std::string& method;
  const std::string& mount;  // as --mount
  int max_users = 0;
};

/// Of a fit that was asked for, by --fit on or otherwise: throws UsageError where there is none.
void CheckFit(const FitArguments& arguments, const FitNeeds& needs);
/// Of people who were named, and of whose shape is to be saved in a file of that name: likewise.
void CheckPeople(const FitArguments& arguments, const std::string& save_person,
                 const FitNeeds& needs);

/// By body id the shapes that are known (tracker::TrackerOptions::shapes). Throws InputError.
std::map<int, recon::PersonShape> ReadPeople(const FitArguments& arguments,
                                             const tracker::ModelSet& models);

}  // namespace ossa::commands
