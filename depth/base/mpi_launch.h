#pragma once
#include <cstdlib>
#include <initializer_list>
#include <string>

#include "depth/base/error.h"

namespace ossa {

/// Processes that mpirun or srun started together with this one, by what they tell each; 1 of one
/// that was started alone.
inline int CountLaunchedProcesses() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"}) {
    const char* size = std::getenv(name);
    if (size != nullptr && std::atoi(size) > 1) return std::atoi(size);
  }
  return 1;
}

/// Of a build without MPI: throws InputError where several processes were started for one piece of
/// work, each of which would do all of it and write the same files.
inline void RefuseToShareWithoutMpi() {
  const int processes = CountLaunchedProcesses();
  if (processes == 1) return;
  throw InputError("this ossa was built without MPI (OSSA_MPI=OFF): expected one process, found " +
                   std::to_string(processes) + " that would each do the whole work");
}

}  // namespace ossa
