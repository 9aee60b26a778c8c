#pragma once

namespace ossa::tools {

/// The processes that share a job under mpirun; one process without it, or without MPI. MPI is only
/// started when a launcher's environment says so: its start costs a tenth of a second.
class Ranks {
 public:
  Ranks();
  ~Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  int rank() const { return rank_; }
  int size() const { return size_; }
  /// Waits for every rank; true when all said true.
  bool All(bool mine) const;

 private:
  bool started_ = false;
  int rank_ = 0;
  int size_ = 1;
};

}  // namespace ossa::tools
