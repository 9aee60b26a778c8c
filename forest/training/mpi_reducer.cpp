#include "forest/training/mpi_reducer.h"

#include <algorithm>
#include <cstdlib>
#include <exception>

#include "depth/base/mpi_launch.h"

#ifdef OSSA_HAVE_MPI
#define OMPI_SKIP_MPICXX 1
#include <mpi.h>
#endif

namespace ossa::forest {

#ifdef OSSA_HAVE_MPI

namespace {

class MpiReducer final : public Reducer {
 public:
  MpiReducer(int* argc, char*** argv) {
    int provided = 0;  // only one thread communicates
    MPI_Init_thread(argc, argv, MPI_THREAD_FUNNELED, &provided);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
  }
  // If a rank exits by an exception, MPI_Finalize is not called, so that mpirun terminates the
  // others, which would wait forever.
  ~MpiReducer() override {
    if (std::uncaught_exceptions() == exceptions_) MPI_Finalize();
  }
  MpiReducer(const MpiReducer&) = delete;
  MpiReducer& operator=(const MpiReducer&) = delete;

  int rank() const override { return rank_; }
  int size() const override { return size_; }
  void Sum(std::span<uint32_t> values) const override { SumAs(values, MPI_UINT32_T); }
  void Sum(std::span<int64_t> values) const override { SumAs(values, MPI_INT64_T); }

 private:
  template <typename T>
  static void SumAs(std::span<T> values, MPI_Datatype type) {
    constexpr size_t kMost = size_t{1} << 28U;  // counts are int in MPI-3; a bound
    for (size_t first = 0; first < values.size(); first += kMost) {
      const size_t count = std::min(kMost, values.size() - first);
      MPI_Allreduce(MPI_IN_PLACE, values.data() + first, static_cast<int>(count), type, MPI_SUM,
                    MPI_COMM_WORLD);
    }
  }

  int rank_ = 0;
  int size_ = 1;
  int exceptions_ = std::uncaught_exceptions();
};

}  // namespace

bool UnderMpi() { return std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr; }

std::unique_ptr<Reducer> MakeMpiReducer(int* argc, char*** argv) {
  if (!UnderMpi()) return std::make_unique<Reducer>();
  return std::make_unique<MpiReducer>(argc, argv);
}

#else

bool UnderMpi() { return false; }

std::unique_ptr<Reducer> MakeMpiReducer(int*, char***) {
  RefuseToShareWithoutMpi();
  return std::make_unique<Reducer>();
}

#endif

}  // namespace ossa::forest
