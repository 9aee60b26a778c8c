#include "recon/methods/reconstructor.h"

#include <string>

#include "depth/base/error.h"
#include "recon/database/posture_database.h"
#include "recon/methods/level_internal.h"
#include "recon/methods/methods_internal.h"
#include "recon/models/learned_models.h"

namespace ossa::recon {
namespace {

using Maker = std::unique_ptr<Reconstructor> (*)(const ReconstructorOptions&);

#define OSSA_METHOD(file, maker, ...) maker,
constexpr Maker kMakers[] = {
// in the order of MethodTable
#include "recon/methods/methods.inc"
};
#undef OSSA_METHOD

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

void CheckLearned(const ReconstructorOptions& options) {
  if (options.learned || !options.learned_file.empty()) return;
  throw InputError("reconstruction: method " + options.method +
                   " needs a learned file (.ossagp of `ossa learn`)");
}

void CheckBones(const BoneLengths& lengths_m, const MethodInfo& method) {
  if (!method.keeps_bones) {
    throw InputError("reconstruction: method " + std::string(method.name) +
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

std::shared_ptr<const LearnedModels> LearnedThatHolds(const ReconstructorOptions& options,
                                                      bool (*holds)(const LearnedModels&)) {
  auto learned = LoadLearned(options);
  if (learned != nullptr && holds(*learned)) return learned;
  const std::string file = options.learned_file.empty() ? "reconstruction" : options.learned_file;
  throw InputError(file + ": expected what method " + options.method +
                   " has learned, found only what best uses (`ossa learn` without "
                   "--correction-only)");
}

std::unique_ptr<Reconstructor> MakeReconstructor(const ReconstructorOptions& options) {
  CheckLocalPca(options.local_pca);
  const MethodInfo& method = RequireMethod(options.method);
  if (method.database == Reads::kRequired && (!options.database || options.database->size() < 1)) {
    throw InputError("reconstruction: method " + options.method + " needs a posture database");
  }
  if (method.learned == Reads::kRequired) CheckLearned(options);
  if (options.bones_m) CheckBones(*options.bones_m, method);
  return MakeLevelled(kMakers[&method - MethodTable().data()](options));
}

}  // namespace ossa::recon
