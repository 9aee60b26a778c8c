#pragma once
#include <memory>

#include "recon/methods/reconstructor.h"

namespace ossa::recon {

/// What options.learned or options.learned_file hold; null when neither is given.
std::shared_ptr<const LearnedModels> LoadLearned(const ReconstructorOptions& options);

/// The same, for a method that works by it: throws InputError where `holds` is false of it, as of a
/// file that holds the correction of `best` alone.
std::shared_ptr<const LearnedModels> LearnedThatHolds(const ReconstructorOptions& options,
                                                      bool (*holds)(const LearnedModels&));

// One maker a method; each lives in the file that its row names.
#define OSSA_METHOD(file, maker, ...) \
  std::unique_ptr<Reconstructor> maker(const ReconstructorOptions& options);
#include "recon/methods/methods.inc"
#undef OSSA_METHOD

}  // namespace ossa::recon
