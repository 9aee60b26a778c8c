#pragma once
#include <memory>

#include "recon/methods/reconstructor.h"

namespace ossa::recon {

/// What options.learned or options.learned_file hold; null when neither is given.
std::shared_ptr<const LearnedModels> LoadLearned(const ReconstructorOptions& options);

// One maker a method; each lives in the file of its name.
std::unique_ptr<Reconstructor> MakeNone(const ReconstructorOptions& options);
std::unique_ptr<Reconstructor> MakeHolt(const ReconstructorOptions& options);
std::unique_ptr<Reconstructor> MakeOneEuro(const ReconstructorOptions& options);
std::unique_ptr<Reconstructor> MakeKalman(const ReconstructorOptions& options);
std::unique_ptr<Reconstructor> MakeShumHo2012(const ReconstructorOptions& options);
std::unique_ptr<Reconstructor> MakeShum2013(const ReconstructorOptions& options);
std::unique_ptr<Reconstructor> MakePlantard2016(const ReconstructorOptions& options);
std::unique_ptr<Reconstructor> MakeLiu2016(const ReconstructorOptions& options);
std::unique_ptr<Reconstructor> MakeFullGp(const ReconstructorOptions& options);
std::unique_ptr<Reconstructor> MakeExemplar(const ReconstructorOptions& options);
std::unique_ptr<Reconstructor> MakeBest(const ReconstructorOptions& options);

}  // namespace ossa::recon
