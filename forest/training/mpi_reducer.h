#pragma once
#include <memory>

#include "forest/training/reducer.h"

namespace ossa::forest {

/// The ranks of an MPI run: joins them on construction, leaves on destruction. Without mpirun, or
/// when ossa was built without MPI, the lone rank 0 of 1; such a build throws InputError where
/// mpirun started several.
std::unique_ptr<Reducer> MakeMpiReducer(int* argc, char*** argv);

/// True when this process was started by mpirun and ossa was built with MPI.
bool UnderMpi();

}  // namespace ossa::forest
