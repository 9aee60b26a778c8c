#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "recon/motion/sightings_internal.h"
#include "recon/skeleton_sequence.h"

namespace ossa::recon {

/// An interval in which a person has at least one joint. Point formats represent an unseen person
/// as a body without joints.
struct PresenceInterval {
  double from_s = 0.0;
  std::optional<double> end_s;  // first frame without the person; none: present to the end
};

/// The sightings of all people of a recording, for formats whose header depends on the whole
/// recording.
class PeopleLog {
 public:
  /// `folder`: its disk holds the bulk of the data.
  explicit PeopleLog(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Throws DiskFull.
  void Append(const SkeletonFrame& frame);

  /// Ids in order of appearance. Bodies without a joint in any frame are left out: their postures
  /// would be invented.
  const std::vector<int>& ids() const { return ids_; }
  /// Start time of all people's files: that of the first frame of the recording.
  double begin_s() const { return times_s_.front(); }
  const std::vector<PresenceInterval>& StaysOf(int id) const { return presence_.at(id); }
  int64_t frame_count() const { return static_cast<int64_t>(times_s_.size()); }
  /// The log of the first `frames` frames, at least one, in memory.
  PeopleLog First(int64_t frames) const;
  /// Moves everything into memory and frees the disk space.
  void LoadIntoMemory();
  const SightingLog& SightingsOf(int id) const { return seen_.at(id); }

 private:
  void UpdatePresence(const SkeletonFrame& frame);
  std::vector<PresenceInterval> PresenceUntil(int id, double end_s) const;

  std::filesystem::path folder_;
  std::vector<double> times_s_;  // frame times
  std::vector<int> ids_;
  std::map<int, SightingLog> seen_;
  std::map<int, std::vector<PresenceInterval>> presence_;
};

/// After a full disk: calls `write` with the first frames, as many as fit, to within a quarter.
/// Returns their number; 0: nothing was written.
int64_t WriteWhatFits(PeopleLog& people, const std::function<void(const PeopleLog&)>& write);

}  // namespace ossa::recon
