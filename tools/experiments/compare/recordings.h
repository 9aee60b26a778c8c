#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "recon/skeleton_sequence.h"

namespace ossa::tools {

/// One performance seen twice: what a sensor's software said, and the truth.
struct RecordedPair {
  std::string clip;     // e.g. "s01/m01_s01_e01"
  std::string subject;  // who; learning must leave the tested one out
  recon::SkeletonSequence observed;
  recon::SkeletonSequence truth;
  /// `observed` after cascaded refinement at the depth images; without frames where there was none.
  recon::SkeletonSequence refined{};
};

enum class RecordingSet { kUiPrmd, kItop, kKeraal, kWithoutTruth };

/// Throws as the functions below do where the folder lacks some, but reads nothing.
void RequireRecordings(const std::filesystem::path& shared,
                       const std::vector<RecordingSet>& wanted);

/// The real recordings with truth in a shared data folder (DIR of `--shared DIR`). Each throws
/// InputError when the folder lacks them.

/// Kinect and Vicon of UI-PRMD; `incorrect` chooses the deliberately wrong performances.
std::vector<RecordedPair> LoadUiPrmd(const std::filesystem::path& shared, bool incorrect);
/// ITOP side view: a network's joints on real depth (A2J) beside the truth; one clip.
std::vector<RecordedPair> LoadItop(const std::filesystem::path& shared);
/// KERAAL: Kinect v2 and Vicon targets of one exercise; the clocks differ, targets are no joints.
std::vector<RecordedPair> LoadKeraal(const std::filesystem::path& shared);

/// Recordings of SDKs without truth: (name, sequence).
std::vector<RecordedPair> LoadWithoutTruth(const std::filesystem::path& shared);

}  // namespace ossa::tools
