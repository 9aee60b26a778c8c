#include "tools/synth/ranks.h"

#ifdef OSSA_HAVE_MPI
#include <mpi.h>

#include <cstdlib>
#include <exception>
#include <initializer_list>

namespace ossa::tools {

Ranks::Ranks() {
  bool launched = false;
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK"}) {
    launched = launched || std::getenv(name) != nullptr;
  }
  if (!launched) return;
  MPI_Init(nullptr, nullptr);
  started_ = true;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &size_);
}

Ranks::~Ranks() {
  if (!started_) return;
  // A failed rank must not wait for the others: it exits without MPI_Finalize, and mpirun ends
  // them.
  if (std::uncaught_exceptions() == 0) MPI_Finalize();
}

bool Ranks::All(bool mine) const {
  if (!started_) return mine;
  int all = mine ? 1 : 0;
  MPI_Allreduce(MPI_IN_PLACE, &all, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
  return all != 0;
}

}  // namespace ossa::tools

#else

#include "depth/base/mpi_launch.h"

namespace ossa::tools {

Ranks::Ranks() { RefuseToShareWithoutMpi(); }
Ranks::~Ranks() = default;
bool Ranks::All(bool mine) const { return mine; }

}  // namespace ossa::tools

#endif
