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

/// A time in which somebody was somewhere: formats of points keep who is not seen as a body without
/// a joint.
struct Stay {
  double from_s = 0.0;
  std::optional<double> gone_s;  // of the first frame without them; none: here to the end
};

/// Everybody's sightings of a recording, for formats whose head needs all of it.
class PeopleLog {
 public:
  /// `folder`: on whose disk most of it is.
  explicit PeopleLog(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Throws DiskFull.
  void Append(const SkeletonFrame& frame);

  /// Those who were somewhere, as they appeared: of a body that has no joint in any frame a posture
  /// would be made up.
  const std::vector<int>& ids() const { return ids_; }
  /// The first frame's time, whoever is in it; of a recording that goes back, a person's first.
  double BeginFor(int id) const;
  const std::vector<Stay>& StaysOf(int id) const { return stays_.at(id); }
  int64_t frame_count() const { return static_cast<int64_t>(times_s_.size()); }
  /// The log of the first so many frames, one at least, in memory.
  PeopleLog First(int64_t frames) const;
  /// Takes all into memory: what it took on the disk is free.
  void LeaveDisk();
  const SightingLog& SightingsOf(int id) const { return seen_.at(id); }

 private:
  void NoteStays(const SkeletonFrame& frame);
  std::vector<Stay> StaysUntil(int id, double end_s) const;

  std::filesystem::path folder_;
  std::vector<double> times_s_;  // of the frames
  std::vector<int> ids_;
  std::map<int, SightingLog> seen_;
  std::map<int, std::vector<Stay>> stays_;
};

/// After a full disk: what `write` makes of the first frames, of as many as fit, within a quarter.
/// Returns how many; 0: it made nothing.
int64_t WriteWhatFits(PeopleLog& people, const std::function<void(const PeopleLog&)>& write);

}  // namespace ossa::recon
