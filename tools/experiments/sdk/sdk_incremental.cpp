// Does liu-2016 learn while it runs (Liu 2016, sec. 4.2.3)? A person that nothing was learned of
// does movements that nothing was learned of, ten times each, one performance after the other.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "recon/methods/reconstruct_sequence.h"
#include "tools/experiments/sdk/method_runs.h"
#include "tools/experiments/sdk/sdk_internal.h"
#include "tools/experiments/simulation/jobs.h"

namespace ossa::tools {
namespace {

// Constants: by hand; they define the table.

constexpr double kPause_s = 1.0;  // between performances
constexpr std::array<std::pair<size_t, size_t>, 5> kPerformances = {
    {{1, 1}, {2, 5}, {6, 15}, {16, 30}, {31, 1000}}};  // of a person, from the first

/// The number after `letter` in a name as "s01/m03_s01_e02"; 0 without one.
int NumberAfter(const std::string& clip, const std::string& letter) {
  const size_t name = clip.find('/') + 1, at = clip.find(letter, name);
  return at == std::string::npos ? 0 : std::stoi(clip.substr(at + letter.size()));
}

bool IsOfOtherHalf(const std::string& clip, int half) { return NumberAfter(clip, "m") % 2 == half; }

/// All performances one after the other, as one person's recording.
recon::SkeletonSequence Joined(const std::vector<const RecordedPair*>& clips) {
  recon::SkeletonSequence all{"joined", {}};
  double next_s = 0.0;
  for (const RecordedPair* clip : clips) {
    const auto& frames = clip->observed.frames;
    for (recon::SkeletonFrame frame : frames) {
      frame.time_s += next_s - frames.front().time_s;
      for (recon::BodyRecord& body : frame.bodies) body.id = 1;
      all.frames.push_back(std::move(frame));
    }
    if (!frames.empty()) next_s = all.frames.back().time_s + kPause_s;
  }
  return all;
}

/// The frames of one performance again, at their own times.
recon::SkeletonSequence CutOut(const recon::SkeletonSequence& made, size_t first,
                               const recon::SkeletonSequence& observed) {
  recon::SkeletonSequence clip{observed.source, {}};
  for (size_t f = 0; f < observed.frames.size(); ++f) {
    clip.frames.push_back(made.frames[first + f]);
    clip.frames.back().time_s = observed.frames[f].time_s;
    for (size_t b = 0; b < clip.frames.back().bodies.size(); ++b) {
      clip.frames.back().bodies[b].id = observed.frames[f].bodies[b].id;
    }
  }
  return clip;
}

std::vector<ClipMetrics> MeasureJoined(const std::vector<const RecordedPair*>& clips,
                                       const recon::ReconstructorOptions& options) {
  const auto made = recon::ReconstructSequence(Joined(clips), options);
  std::vector<ClipMetrics> metrics;
  size_t first = 0;
  for (const RecordedPair* clip : clips) {
    const auto part = CutOut(made, first, clip->observed);
    for (const PairedTracks& pair : PairUp(clip->truth, part)) {
      metrics.push_back(Measure(pair));
      metrics.back().name = clip->clip;
    }
    first += clip->observed.frames.size();
  }
  return metrics;
}

/// Of one person and one half of the movements: raw, without and with incremental learning.
using OfFold = std::array<std::vector<ClipMetrics>, 3>;

OfFold TestHalf(ExperimentContext& context, const Fold& fold, int half,
                const recon::ReconstructorOptions& options) {
  const std::string key = fmt::format("incremental {} {} {} {}", ComputeCodeKey(), fold.key, half,
                                      ComputeOptionsKey(context, options));
  const std::string text = context.Cached(key, [&] {
    if (context.progress) context.progress(0, 0, "incremental " + fold.name);
    Fold part{fold.name, {}, {}, fold.key};
    for (const RecordedPair* pair : fold.train) {
      if (IsOfOtherHalf(pair->clip, 1 - half)) part.train.push_back(pair);
    }
    for (const RecordedPair* pair : fold.test) {
      if (IsOfOtherHalf(pair->clip, half)) part.test.push_back(pair);
    }
    recon::ReconstructorOptions with = LearnFold(part, "liu-2016", options);
    with.method = "none";
    auto json = nlohmann::json::array();
    json.push_back(ClipsToJson(MeasureJoined(part.test, with)));
    with.method = "liu-2016";
    for (const bool incremental : {false, true}) {
      with.gaussian_process.incremental = incremental;
      json.push_back(ClipsToJson(MeasureJoined(part.test, with)));
    }
    return json.dump();
  });
  const auto json = nlohmann::json::parse(text);
  return {ClipsFromJson(json.at(0)), ClipsFromJson(json.at(1)), ClipsFromJson(json.at(2))};
}

/// By place in each person's recording: a clip's own number, from 1.
struct Placed {
  size_t number = 0;
  std::array<ClipMetrics, 3> of_method;
};

std::vector<ClipMetrics> Between(const std::vector<Placed>& clips, size_t method,
                                 std::pair<size_t, size_t> numbers) {
  std::vector<ClipMetrics> some;
  for (const Placed& clip : clips) {
    const bool within = clip.number >= numbers.first && clip.number <= numbers.second;
    if (within) some.push_back(clip.of_method[method]);
  }
  return some;
}

std::string TextOf(std::pair<size_t, size_t> numbers) {
  if (numbers.first == numbers.second) return fmt::format("{}", numbers.first);
  return numbers.second >= 1000 ? fmt::format("{} and later", numbers.first)
                                : fmt::format("{} to {}", numbers.first, numbers.second);
}

}  // namespace

Table RunIncremental(ExperimentContext& context, const std::vector<Fold>& folds,
                     const recon::ReconstructorOptions& options) {
  const size_t people = context.full ? folds.size() : std::min<size_t>(folds.size(), 3);
  std::vector<Placed> all;
  for (size_t p = 0; p < people; ++p) {
    for (const int half : {0, 1}) {
      const OfFold made = TestHalf(context, folds[p], half, options);
      for (size_t c = 0; c < made[0].size(); ++c) {
        all.push_back({c + 1, {made[0][c], made[1][c], made[2][c]}});
      }
    }
  }
  Table table;
  table.title = "Incremental learning, UI-PRMD: people and movements nothing was learned of";
  table.columns = {"performance", "clips",      "none: eq. 18", "offline",     "incremental",
                   "change, %",   "none: mean", "offline",      "incremental", "change, %"};
  for (const auto& numbers : kPerformances) {
    std::vector<std::string> row = {TextOf(numbers),
                                    std::to_string(Between(all, 0, numbers).size())};
    for (const auto member :
         {&ClipMetrics::parent_relative_error_cm, &ClipMetrics::mean_joint_error_cm}) {
      for (size_t m = 0; m < 3; ++m) row.push_back(MeanAndMedian(Between(all, m, numbers), member));
      const double offline = Average(Between(all, 1, numbers), member).value_or(1.0);
      const double made = Average(Between(all, 2, numbers), member).value_or(1.0);
      row.push_back(fmt::format("{:+.1f}", 100.0 * (made / offline - 1.0)));
    }
    table.rows.push_back(std::move(row));
  }
  table.note = fmt::format(
      "{} people, each left out; learned of one half of the movements of the others, tested on the "
      "other half, both ways. A person's performances follow each other; change: against offline.",
      people);
  return table;
}

}  // namespace ossa::tools
