#pragma once

namespace ossa::tools {

/// The processes that share a job under mpirun; a single one without mpirun or MPI. MPI is only
/// initialised if the environment shows a launcher, because that takes 0.1 s.
class Ranks {
 public:
  Ranks();
  ~Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  int rank() const { return rank_; }
  int size() const { return size_; }
  /// Waits for every rank; true if `mine` is true on all.
  bool All(bool mine) const;

 private:
  bool started_ = false;
  int rank_ = 0;
  int size_ = 1;
};

}  // namespace ossa::tools
