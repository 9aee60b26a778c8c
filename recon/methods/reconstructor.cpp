#include "recon/methods/reconstructor.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "depth/base/error.h"
#include "recon/database/posture_database.h"
#include "recon/methods/level_internal.h"
#include "recon/methods/methods_internal.h"
#include "recon/models/learned_models.h"

namespace ossa::recon {
namespace {

struct Method {
  const char* name;
  bool needs_database;
  bool needs_learned;
  bool keeps_bones;
  std::unique_ptr<Reconstructor> (*make)(const ReconstructorOptions&);
};

constexpr std::array kMethods = {
    Method{"none", false, false, false, MakeNone},
    Method{"holt", false, false, false, MakeHolt},
    Method{"one-euro", false, false, false, MakeOneEuro},
    Method{"kalman", false, false, false, MakeKalman},
    Method{"shum-ho-2012", true, false, true, MakeShumHo2012},
    Method{"shum-2013", true, false, true, MakeShum2013},
    Method{"plantard-2016", true, false, true, MakePlantard2016},
    Method{"liu-2016", false, true, false, MakeLiu2016},
    Method{"full-gp", false, true, false, MakeFullGp},
    Method{"exemplar", false, true, false, MakeExemplar},
    Method{"best", false, false, true, MakeBest},
};

void CheckLocalPca(const LocalPcaOptions& o) {
  if (o.neighbours < 2 || o.dimensions < 1 || o.steps < 1 || o.samples < 1) {
    throw InputError(
        "reconstruction: neighbours (>= 2), dimensions, steps and samples must be positive");
  }
  if (o.solver != "stochastic" && o.solver != "ceres") {
    throw InputError("reconstruction: unknown solver '" + o.solver +
                     "', expected stochastic or ceres");
  }
}

/// A file may hold the correction of `best` alone.
bool Holds(const LearnedModels& learned, std::string_view method) {
  if (method == "liu-2016") {
    return std::any_of(learned.mixtures.begin(), learned.mixtures.end(),
                       [](const LocalMixture& mixture) { return !mixture.empty(); });
  }
  if (method == "full-gp") {
    return std::any_of(learned.full.begin(), learned.full.end(),
                       [](const GaussianProcess& process) { return process.size() > 0; });
  }
  return !learned.exemplars.empty();
}

void CheckLearned(const ReconstructorOptions& options) {
  const auto learned = LoadLearned(options);
  if (learned == nullptr) {
    throw InputError("reconstruction: method " + options.method +
                     " needs a learned file (.ossagp of `ossa learn`)");
  }
  if (Holds(*learned, options.method)) return;
  const std::string file = options.learned_file.empty() ? "reconstruction" : options.learned_file;
  throw InputError(file + ": expected what method " + options.method +
                   " has learned, found only what best uses (`ossa learn` without "
                   "--correction-only)");
}

void CheckBones(const BoneLengths& lengths_m, const Method& method) {
  if (!method.keeps_bones) {
    throw InputError(std::string("reconstruction: method ") + method.name +
                     " moves joints alone, it cannot keep bones");
  }
  for (size_t i = 1; i < kJointCount; ++i) {
    if (lengths_m[i] > 0.0 && lengths_m[i] < 10.0) continue;
    throw InputError("reconstruction: expected bones longer than 0 and shorter than 10 m, found " +
                     std::to_string(lengths_m[i]) + " m");
  }
}

}  // namespace

std::shared_ptr<const LearnedModels> LoadLearned(const ReconstructorOptions& options) {
  if (options.learned || options.learned_file.empty()) return options.learned;
  return std::make_shared<const LearnedModels>(LearnedModels::Load(options.learned_file));
}

const std::vector<std::string>& ReconstructionMethods() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const Method& method : kMethods) list.emplace_back(method.name);
    return list;
  }();
  return names;
}

bool NeedsDatabase(const std::string& method) {
  return std::any_of(kMethods.begin(), kMethods.end(),
                     [&](const Method& m) { return m.needs_database && m.name == method; });
}

bool NeedsLearned(const std::string& method) {
  return std::any_of(kMethods.begin(), kMethods.end(),
                     [&](const Method& m) { return m.needs_learned && m.name == method; });
}

bool KeepsBones(const std::string& method) {
  return std::any_of(kMethods.begin(), kMethods.end(),
                     [&](const Method& m) { return m.keeps_bones && m.name == method; });
}

std::unique_ptr<Reconstructor> MakeReconstructor(const ReconstructorOptions& options) {
  CheckLocalPca(options.local_pca);
  for (const Method& method : kMethods) {
    if (options.method != method.name) continue;
    if (method.needs_database && (!options.database || options.database->size() < 1)) {
      throw InputError("reconstruction: method " + options.method + " needs a posture database");
    }
    if (method.needs_learned) CheckLearned(options);
    if (options.bones_m) CheckBones(*options.bones_m, method);
    return MakeLevelled(method.make(options));
  }
  std::string known;
  for (const std::string& name : ReconstructionMethods())
    known += (known.empty() ? "" : ", ") + name;
  throw InputError("reconstruction: unknown method '" + options.method + "', expected one of " +
                   known);
}

}  // namespace ossa::recon
