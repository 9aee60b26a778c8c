#pragma once
#include <memory>

#include "forest/training/reducer.h"

namespace ossa::forest {

/// The ranks of an MPI run: initialises MPI in the constructor, finalises it in the destructor.
/// Without mpirun, or if built without MPI, the only rank 0 of 1; such a build throws InputError if
/// mpirun started several processes.
std::unique_ptr<Reducer> MakeMpiReducer(int* argc, char*** argv);

/// Whether this process was started by mpirun and ossa was built with MPI.
bool UnderMpi();

}  // namespace ossa::forest
