#pragma once
#include <cstdlib>
#include <initializer_list>
#include <string>

#include "depth/base/error.h"

namespace ossa {

/// Number of processes that mpirun or srun started together, from their environment; 1 for a single
/// process.
inline int CountLaunchedProcesses() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"}) {
    const char* size = std::getenv(name);
    if (size != nullptr && std::atoi(size) > 1) return std::atoi(size);
  }
  return 1;
}

/// For builds without MPI: throws InputError if several processes were started together, because
/// each would do all the work and write the same files.
inline void RefuseToShareWithoutMpi() {
  const int processes = CountLaunchedProcesses();
  if (processes == 1) return;
  throw InputError("this ossa was built without MPI (OSSA_MPI=OFF): expected one process, found " +
                   std::to_string(processes) + " that would each do the whole work");
}

}  // namespace ossa
