#include "tools/learning/pair_recordings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "depth/base/error.h"
#include "recon/methods/recorded_pairs.h"
#include "tools/experiments/compare/comparison.h"
#include "tools/experiments/compare/median_offset.h"

namespace ossa::tools {
namespace {

/// Numbers people by the file and the folder in it that their recordings are from.
class People {
 public:
  int NumberOf(const std::string& observed_path, const std::string& clip) {
    const std::string name = observed_path + "\n" + clip.substr(0, clip.find('/'));
    return numbers_.try_emplace(name, static_cast<int>(numbers_.size())).first->second;
  }

 private:
  std::map<std::string, int> numbers_;
};

using Clips = std::vector<recon::SkeletonClip>;

// The true clip of each observed one, by name; single clips on both sides are paired whatever their
// names. Null: none.
std::vector<const recon::SkeletonClip*> FindTruth(const Clips& observed, const Clips& truth) {
  if (observed.size() == 1 && truth.size() == 1) return {&truth[0]};
  std::map<std::string, const recon::SkeletonClip*> by_name;
  for (const auto& clip : truth) by_name[clip.name] = &clip;
  std::vector<const recon::SkeletonClip*> found;
  for (const auto& clip : observed) {
    const auto it = by_name.find(clip.name);
    found.push_back(it == by_name.end() ? nullptr : it->second);
  }
  return found;
}

// Warns if some have no truth; throws if all have none.
void WarnOfUnpaired(const std::string& observed_path, const std::string& truth_path,
                    const std::vector<const recon::SkeletonClip*>& truth, Clips& observed) {
  const auto without = std::count(truth.begin(), truth.end(), nullptr);
  if (without == 0 || without == std::ssize(truth)) return;
  const auto first =
      static_cast<size_t>(std::find(truth.begin(), truth.end(), nullptr) - truth.begin());
  observed[0].sequence.warnings.push_back(
      fmt::format("{}: {} of its {} recordings, the first {}, have none of their name in {}: "
                  "nothing is learned of them",
                  observed_path, without, truth.size(), observed[first].name, truth_path));
}

// Shifts the times of recordings by the offsets of their clocks from the truth's.
void AlignClocks(const std::string& observed_path,
                 const std::vector<const recon::SkeletonClip*>& truth,
                 const PairRecordingsOptions& options, Clips& observed) {
  if (options.clock.time == TimeAlignment::kNone) return;
  for (size_t i = 0; i < observed.size(); ++i) {
    if (truth[i] == nullptr) continue;
    recon::SkeletonSequence& sequence = observed[i].sequence;
    const auto pairs = PairUp(truth[i]->sequence, sequence, options.clock);
    const double offset_s = pairs.empty() ? 0.0 : pairs.front().offset_s;
    if (std::lround(1000.0 * offset_s) == 0) continue;  // of less than half a millisecond
    for (int64_t number = -1; recon::SkeletonFrame & frame : sequence.frames) {
      frame.time_s += offset_s;
      frame.frame = number--;  // the truth's numbers count another clock's frames
    }
    if (!options.note || options.clock.time == TimeAlignment::kFixed) continue;
    const std::string& name = observed[i].name;
    options.note(fmt::format("{}{}{}: {:+.3f} s added to its times", observed_path,
                             name.empty() ? "" : "#", name, offset_s));
  }
}

// What to do about an offset that is left.
std::string DescribeRemedy(const PairOptions& clock, double more_s) {
  if (clock.time == TimeAlignment::kFixed) {
    return fmt::format("check --time {:g} (--time {:.3f} adds that, too)", clock.offset_s,
                       clock.offset_s + more_s);
  }
  if (clock.time == TimeAlignment::kCorrelate) return "check --max-offset";
  return "if their clocks differ, align them (--time correlate)";
}

// Of another moment of the truth a correction would learn the movement between. Warns of the first
// of a file, and once of a small offset on which recordings agree.
class ClockWarnings {
 public:
  explicit ClockWarnings(const PairOptions& clock) : clock_(clock) {}

  void WarnOf(const std::string& observed_path, const std::string& truth_path,
              const std::vector<const recon::SkeletonClip*>& truth, Clips& observed) {
    for (size_t i = 0; i < observed.size(); ++i) {
      if (truth[i] == nullptr) continue;
      recon::SkeletonSequence& sequence = observed[i].sequence;
      const auto pairs = PairUp(truth[i]->sequence, sequence, as_they_are_);
      if (const auto found = FindClockDifference(pairs)) {
        sequence.warnings.push_back(fmt::format("{}{}{} is far nearer to {} {}: {}", observed_path,
                                                observed[i].name.empty() ? "" : "#",
                                                observed[i].name, truth_path, Describe(*found),
                                                DescribeRemedy(clock_, found->offset_s)));
        return;
      }
      for (const PairedTracks& pair : pairs) offsets_.Add(pair, clock_.stop);
    }
    WarnOfMedian(observed_path, observed);
  }

 private:
  // Correlated recordings are aligned as well as can be measured.
  void WarnOfMedian(const std::string& observed_path, Clips& observed) {
    if (observed.empty() || has_warned_ || clock_.time == TimeAlignment::kCorrelate) return;
    const auto found = offsets_.FindEvident();
    if (!found) return;
    has_warned_ = true;
    const double by_s = clock_.time == TimeAlignment::kFixed ? clock_.offset_s : 0.0;
    observed[0].sequence.warnings.push_back(fmt::format(
        "{}: the times are {:+.3f} s off the truth's, {:.1f} frames (standard error {:.3f} s, "
        "median of {} pieces of recordings): if that is no lag of the sensor, which is learned, "
        "add --time {:.3f}",
        observed_path, -found->offset_s, std::abs(found->offset_s) / found->frame_s,
        found->standard_error_s, found->pieces, by_s + found->offset_s));
  }

  PairOptions clock_, as_they_are_{.time = TimeAlignment::kNone};
  OffsetOfPieces offsets_;
  bool has_warned_ = false;
};

void AddClips(const std::string& observed_path, const Clips& observed,
              const std::vector<const recon::SkeletonClip*>& truth, People& people,
              std::vector<recon::PosturePair>& pairs) {
  for (size_t i = 0; i < observed.size(); ++i) {
    if (truth[i] == nullptr) continue;
    const std::string& name = observed[i].name;
    recon::AddPairs(observed[i].sequence, truth[i]->sequence, pairs,
                    people.NumberOf(observed_path, name));
  }
}

}  // namespace

std::vector<recon::PosturePair> PairRecordings(const std::vector<std::string>& observed,
                                               const std::vector<std::string>& truth,
                                               const PairRecordingsOptions& options) {
  if (observed.size() != truth.size()) {
    throw InputError("observed and truth: expected as many files of one as of the other, found " +
                     std::to_string(observed.size()) + " and " + std::to_string(truth.size()));
  }
  std::vector<recon::PosturePair> pairs;
  People people;
  ClockWarnings clocks(options.clock);
  for (size_t i = 0; i < observed.size(); ++i) {
    Clips seen = recon::ReadSkeletonClips(observed[i], options.reading);
    const Clips known = recon::ReadSkeletonClips(truth[i], options.reading);
    const auto truth_of = FindTruth(seen, known);
    WarnOfUnpaired(observed[i], truth[i], truth_of, seen);
    AlignClocks(observed[i], truth_of, options, seen);
    clocks.WarnOf(observed[i], truth[i], truth_of, seen);
    if (options.read && !(options.read(seen) && options.read(known))) return pairs;
    const size_t before = pairs.size();
    AddClips(observed[i], seen, truth_of, people, pairs);
    if (pairs.size() == before) {
      throw InputError(observed[i] + ": no frame matches one of " + truth[i] +
                       "; expected recordings of the same names, the same frame numbers or times, "
                       "and at least 4 common joints less than 0.5 m apart (of other axes and "
                       "places nothing is learned)");
    }
  }
  return pairs;
}

}  // namespace ossa::tools
