#pragma once
#include <memory>

#include "recon/methods/reconstructor.h"

namespace ossa::recon {

/// The models in options.learned or options.learned_file; null if neither is given.
std::shared_ptr<const LearnedModels> LoadLearned(const ReconstructorOptions& options);

/// As LoadLearned, for a method that requires it: throws InputError if `holds` is false for the
/// models, such as for a file with only the correction of `best`.
std::shared_ptr<const LearnedModels> LearnedThatHolds(const ReconstructorOptions& options,
                                                      bool (*holds)(const LearnedModels&));

// One maker per method, in the file of its row.
#define OSSA_METHOD(file, maker, ...) \
  std::unique_ptr<Reconstructor> maker(const ReconstructorOptions& options);
#include "recon/methods/methods.inc"
#undef OSSA_METHOD

}  // namespace ossa::recon
