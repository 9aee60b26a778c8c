// Conversion of ossa_options to TrackerOptions.
#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "depth/base/error.h"
#include "tools/tracker/c_interface_internal.h"
#include "tools/tracker/c_tracker_internal.h"

namespace ossa::tracker {
namespace {

// A file that the method does not read is an error, as in Python, instead of being ignored.
void CheckFilesAreRead(const ModelFiles& files, const std::string& method) {
  const recon::MethodInfo& info = recon::RequireMethod(method);
  const auto check = [&](const std::string& file, bool is_read, const char* member) {
    if (is_read || file.empty() || file == "none") return;
    throw InputError("ossa_options." + std::string(member) +
                     ": expected a method that reads it, found '" + method + "'");
  };
  check(files.learned, info.learned != recon::Reads::kNothing, "learned");
  check(files.prior, info.prior, "prior");
  check(files.database, info.database != recon::Reads::kNothing, "database");
}

/// The enumerator with the index of `given` in `names`. Throws InputError for others.
template <typename Choice, size_t N>
Choice ChoiceFrom(const std::array<std::string_view, N>& names, const std::string& given,
                  const char* member) {
  const auto known = std::find(names.begin(), names.end(), given);
  if (known != names.end()) return static_cast<Choice>(known - names.begin());
  std::string expected;
  for (const std::string_view name : names)
    expected.append(expected.empty() ? "" : ", ").append(name);
  throw InputError("ossa_options." + std::string(member) + ": expected " + expected + ", found '" +
                   given + "'");
}

Turn TurnFrom(const std::string& rotate) {
  constexpr std::array<std::string_view, 5> kNames = {"0", "90", "180", "270", "auto"};
  return ChoiceFrom<Turn>(kNames, rotate, "rotate");
}

Mount MountFrom(const std::string& mount) {
  constexpr std::array<std::string_view, 3> kNames = {"auto", "level", "ceiling"};
  return ChoiceFrom<Mount>(kNames, mount, "mount");
}

ModelFiles FilesFrom(const ossa_options& c) {
  ModelFiles files;
  files.forest = TextOr(c.model, "");
  files.refinement = TextOr(c.refinement, "");
  files.pose_network = TextOr(c.pose_network, "");
  files.surface = TextOr(c.surface, "");
  files.learned = TextOr(c.learned, "");
  files.prior = TextOr(c.prior, "");
  files.database = TextOr(c.database, "");
  return files;
}

std::map<int, recon::PersonShape> LoadPeople(const ossa_options& c, const ModelSet& models) {
  std::map<int, recon::PersonShape> people;
  for (int i = 0; i < OSSA_MAX_BODIES; ++i) {
    if (c.person[i] == nullptr) continue;
    if (!models.surface) {
      throw InputError("ossa_options.person: expected a body surface, found surface 'none'");
    }
    people[i + 1] = recon::PersonShape::Load(c.person[i], *models.surface);
  }
  return people;
}

}  // namespace

TrackerOptions OptionsFrom(const ossa_options& c) {
  TrackerOptions options;
  if (c.method != nullptr) options.method = c.method;
  const ModelFiles files = FilesFrom(c);
  CheckFilesAreRead(files, options.method);
  options.models = ModelSet::Load(files, options.method);
  options.shapes = LoadPeople(c, *options.models);
  if (c.smoothing != nullptr) options.smoothing = SmoothingPreset(c.smoothing);
  options.physics = c.physics != 0;
  if (c.scene != nullptr) options.scene = LoadScene(c.scene);
  options.near_range = c.near_range != 0;
  if (c.seated != 0) options.mode = TrackingMode::kSeated;
  if (c.max_users != 0) options.max_users = c.max_users;
  if (c.threads != 0) options.threads = c.threads;
  options.lag = c.lag;
  options.keep_parts = c.parts != 0;
  options.turn = TurnFrom(TextOr(c.rotate, "0"));
  options.mount = MountFrom(TextOr(c.mount, "auto"));
  return options;
}

}  // namespace ossa::tracker
