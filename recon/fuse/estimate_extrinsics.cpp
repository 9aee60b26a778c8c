#include "recon/fuse/estimate_extrinsics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "depth/base/error.h"
#include "recon/fuse/camera_fit_internal.h"
#include "recon/time_step.h"

namespace ossa::recon {
namespace {

// Constants: by hand.

constexpr size_t kMostTracks = 8;         // longest tracks used per camera; for speed
constexpr size_t kMostGuesses = 12;       // guesses evaluated with all people; for speed
constexpr double kLeastMotion_m = 0.03;   // least deviation from mean positions: thrice the noise
constexpr double kMostDistance_m = 0.15;  // maximum median distance of matched joints
constexpr double kLeastScore = 0.2;       // share of the possible weight
constexpr double kAlike = 0.97;  // a guess with this share of the best score counts as equal
constexpr double kOtherOffset_s = 0.25;  // clock offsets this far apart are different

/// A refined guess with its evaluation.
struct EvaluatedGuess {
  CameraGuess guess;
  double score = 0.0;
};

[[noreturn]] void RefuseCamera(const SkeletonSequence& other, const std::string& found) {
  throw InputError(
      fmt::format("{}: expected a person whom both cameras see moving, found {}; --extrinsics FILE "
                  "says where cameras are",
                  other.source, found));
}

double GridStep_s(const SkeletonSequence& sequence) {
  constexpr double kShortest_s = 1.0 / 60, kLongest_s = 1.0 / 15;
  return std::clamp(MedianStep_s(sequence), kShortest_s, kLongest_s);
}

std::vector<JointTrack> LongestTracks(std::vector<JointTrack> tracks) {
  std::stable_sort(tracks.begin(), tracks.end(), [](const JointTrack& a, const JointTrack& b) {
    return a.length_s() > b.length_s();
  });
  tracks.resize(std::min(tracks.size(), kMostTracks));
  return tracks;
}

/// Offset grids around equal clocks and, if the start times differ much, around a common start.
std::vector<OffsetGrid> MakeGrids(const SkeletonSequence& camera_0, const SkeletonSequence& other,
                                  const EstimateExtrinsicsOptions& options) {
  const double step_s = GridStep_s(other);
  const double reach_s = std::ceil(options.max_clock_offset_s / step_s) * step_s;
  std::vector<OffsetGrid> grids{{-reach_s, reach_s + 0.5 * step_s, step_s}};
  const double starts_s = camera_0.frames.front().time_s - other.frames.front().time_s;
  if (std::abs(starts_s) > options.max_clock_offset_s) {
    grids.push_back({starts_s - reach_s, starts_s + reach_s + 0.5 * step_s, step_s});
  }
  return grids;
}

std::vector<CameraGuess> SearchPairs(const CameraPair& pair, const std::vector<OffsetGrid>& grids) {
  std::vector<CameraGuess> guesses;
  const auto others = LongestTracks(pair.other);
  for (const JointTrack& a : LongestTracks(pair.camera_0)) {
    for (const JointTrack& b : others) {
      for (const OffsetGrid& grid : grids) {
        const auto found = SearchClock(a, b, grid);
        guesses.insert(guesses.end(), found.begin(), found.end());
      }
    }
  }
  std::stable_sort(guesses.begin(), guesses.end(),
                   [](const auto& a, const auto& b) { return a.cost < b.cost; });
  guesses.resize(std::min(guesses.size(), kMostGuesses));
  return guesses;
}

std::vector<EvaluatedGuess> JudgeAll(const CameraPair& pair,
                                     const std::vector<CameraGuess>& guesses, double step_s) {
  std::vector<EvaluatedGuess> judged;
  for (const CameraGuess& guess : guesses) {
    const CameraGuess refined = RefineGuess(pair, guess, step_s);
    judged.push_back({refined, ScoreGuess(FindCommonJoints(pair, refined), refined)});
  }
  std::stable_sort(judged.begin(), judged.end(),
                   [](const auto& a, const auto& b) { return a.score > b.score; });
  return judged;
}

void CheckAgreement(const SkeletonSequence& other, const CommonJoints& common,
                    const CameraGuess& guess, double score) {
  const double motion_m = MeasureMotion_m(common);
  const double median_m = MedianDistance_m(common, guess);
  if (common.joints.empty() || score < kLeastScore || median_m > kMostDistance_m) {
    RefuseCamera(other, "bodies that do not move alike");
  }
  if (motion_m < kLeastMotion_m) {
    RefuseCamera(other, fmt::format("joints that move by {:.1f} cm", 100.0 * motion_m));
  }
}

void CheckUnambiguous(const SkeletonSequence& other, const std::vector<EvaluatedGuess>& judged) {
  for (const EvaluatedGuess& second : judged) {
    const double apart_s =
        std::abs(second.guess.clock_offset_s - judged.front().guess.clock_offset_s);
    if (apart_s < kOtherOffset_s || second.score < kAlike * judged.front().score) continue;
    RefuseCamera(other, fmt::format("motion that fits as well {:.2f} s later or earlier", apart_s));
  }
}

}  // namespace

CameraEstimate EstimateCamera(const SkeletonSequence& camera_0, const SkeletonSequence& other,
                              const EstimateExtrinsicsOptions& options) {
  const CameraPair pair = MakeCameraPair(camera_0, other);
  if (pair.camera_0.empty()) RefuseCamera(camera_0, "nobody");
  if (pair.other.empty()) RefuseCamera(other, "nobody");
  const auto grids = MakeGrids(camera_0, other, options);
  const auto guesses = SearchPairs(pair, grids);
  if (guesses.empty()) RefuseCamera(other, "less than half a second that both see");
  const std::vector<EvaluatedGuess> judged = JudgeAll(pair, guesses, grids.front().step_s);
  const CameraGuess& best = judged.front().guess;
  const CommonJoints common = FindCommonJoints(pair, best);
  CheckAgreement(other, common, best, judged.front().score);
  CheckUnambiguous(other, judged);
  CameraEstimate estimate;
  estimate.camera.from_camera_0 = best.camera_0_from_other.inverse();
  estimate.camera.clock_offset_s = best.clock_offset_s;
  estimate.disagreement_m = MedianDistance_m(common, best);
  estimate.common_s = common.common_s;
  return estimate;
}

}  // namespace ossa::recon
