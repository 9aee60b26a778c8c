#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "recon/skeleton_sequence.h"

namespace ossa::tools {

/// One recording: the skeletons of a sensor's software, and the truth.
struct RecordedPair {
  std::string clip;     // e.g. "s01/m01_s01_e01"
  std::string subject;  // who; learning must leave the tested one out
  recon::SkeletonSequence observed;
  recon::SkeletonSequence truth;
  /// `observed` after cascaded refinement at the depth images; empty without refinement.
  recon::SkeletonSequence refined{};
};

enum class RecordingSet { kUiPrmd, kItop, kKeraal, kWithoutTruth };

/// Throws as the functions below do if recordings are missing, but reads nothing.
void RequireRecordings(const std::filesystem::path& shared,
                       const std::vector<RecordingSet>& wanted);

/// The real recordings with truth in a shared data folder (DIR of `--shared DIR`). Each throws
/// InputError if they are missing.

/// Kinect and Vicon of UI-PRMD; `incorrect`: the deliberately wrong executions.
std::vector<RecordedPair> LoadUiPrmd(const std::filesystem::path& shared, bool incorrect);
/// ITOP side view: a network's joints on real depth (A2J) beside the truth; one clip.
std::vector<RecordedPair> LoadItop(const std::filesystem::path& shared);
/// KERAAL: Kinect v2 and Vicon targets of one exercise; the clocks differ, and the targets are not
/// joints.
std::vector<RecordedPair> LoadKeraal(const std::filesystem::path& shared);

/// Recordings of SDKs without truth: (name, sequence).
std::vector<RecordedPair> LoadWithoutTruth(const std::filesystem::path& shared);

}  // namespace ossa::tools
