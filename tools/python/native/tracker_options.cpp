// The keywords of ossa.Tracker.
#include "tools/python/native/tracker_options.h"

#include <pybind11/stl.h>

#include <algorithm>

#include "depth/base/error.h"
#include "recon/methods/method_table.h"

namespace ossa::python {
namespace {

py::object TextOrNone(const py::dict& given, const char* key) {
  return given.contains(key) ? py::object(given[key]) : py::none();
}

}  // namespace

tracker::SmoothingOptions ReadSmoothing(const py::object& given, const std::string& method) {
  if (given.is_none()) return tracker::SmoothingPreset(recon::RequireMethod(method).smoothing);
  if (py::isinstance<py::str>(given)) return tracker::SmoothingPreset(given.cast<std::string>());
  const auto values = given.cast<py::dict>();
  const auto number = [&](const char* key) { return values[key].cast<double>(); };
  tracker::SmoothingOptions options;
  if (values.contains("min_cutoff_hz")) {
    options.kind = tracker::SmoothingKind::kOneEuro;
    options.one_euro.min_cutoff_hz = number("min_cutoff_hz");
    options.one_euro.beta_per_m = number("beta_per_m");
    return options;
  }
  options.holt.smoothing = number("smoothing");
  options.holt.correction = number("correction");
  options.holt.prediction = number("prediction");
  options.holt.jitter_radius_m = number("jitter_radius_m");
  options.holt.max_deviation_radius_m = number("max_deviation_radius_m");
  return options;
}

tracker::TrackerOptions ReadTrackerOptions(const py::dict& given) {
  tracker::TrackerOptions options;
  const auto flag = [&](const char* key) { return given[key].cast<bool>(); };
  options.method = given["method"].cast<std::string>();
  options.physics = flag("physics");
  if (!flag("fit")) options.fit.reset();
  options.mechanics = ReadMechanics(given["mechanics"].cast<py::dict>());
  const MethodOptions of_method = ReadMethodOptions(given["method_options"].cast<py::dict>());
  options.local_pca = of_method.local_pca;
  options.gaussian_process = of_method.gaussian_process;
  options.best = of_method.best;
  options.smoothing = ReadSmoothing(TextOrNone(given, "smoothing"), options.method);
  if (flag("seated")) options.mode = tracker::TrackingMode::kSeated;
  options.near_range = flag("near");
  options.lag = given["lag"].cast<int>();
  options.max_users = given["max_users"].cast<int>();
  options.threads = given["threads"].cast<int>();
  options.seed = given["seed"].cast<uint64_t>();
  options.keep_parts = flag("parts");
  options.keep_probabilities = flag("probabilities");
  options.keep_proposals = flag("proposals");
  for (const auto& [id, lengths] : given["bones_m"].cast<std::map<int, std::vector<double>>>()) {
    recon::BoneLengths bones{};
    std::copy_n(lengths.begin(), bones.size(), bones.begin());
    options.bones_m[id] = bones;
  }
  const auto mount = given["mount"].cast<std::string>();
  if (mount == "level") options.mount = tracker::Mount::kLevel;
  if (mount == "ceiling") options.mount = tracker::Mount::kCeiling;
  if (const auto scene = given["scene"].cast<std::string>(); !scene.empty()) {
    options.scene = tracker::LoadScene(scene);
    options.scene->people = options.mechanics;
  }
  return options;
}

std::map<int, recon::PersonShape> LoadPeople(const std::vector<std::string>& paths,
                                             const recon::BodySurface* surface) {
  if (!paths.empty() && surface == nullptr) {
    throw InputError("person: expected models with a body surface");
  }
  std::map<int, recon::PersonShape> people;
  int id = 0;
  for (const std::string& path : paths) people[++id] = recon::PersonShape::Load(path, *surface);
  return people;
}

}  // namespace ossa::python
