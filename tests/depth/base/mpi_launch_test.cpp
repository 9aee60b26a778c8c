#include "depth/base/mpi_launch.h"

#include <gtest/gtest.h>

#include "tests/support/refused.h"

namespace ossa {
namespace {

TEST(MpiLaunch, SeveralProcessesAreRefusedByABuildWithoutMpi) {
  unsetenv("OMPI_COMM_WORLD_SIZE");
  unsetenv("PMI_SIZE");
  RefuseToShareWithoutMpi();
  setenv("PMI_SIZE", "1", 1);
  RefuseToShareWithoutMpi();
  setenv("OMPI_COMM_WORLD_SIZE", "4", 1);
  test::ExpectRefused([] { RefuseToShareWithoutMpi(); },
                      "built without MPI (OSSA_MPI=OFF): expected one process, found 4");
  unsetenv("OMPI_COMM_WORLD_SIZE");
  unsetenv("PMI_SIZE");
}

}  // namespace
}  // namespace ossa
