#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "depth/base/atomic_file.h"
#include "depth/image/depth_frame.h"
#include "recon/files/skeleton_writer.h"
#include "recon/fit/surface_fit.h"
#include "tools/commands/posture_record.h"
#include "tools/commands/track_options.h"
#include "tools/tracker/tracker.h"

// The output files of `ossa track`; each is complete or absent.
namespace ossa::commands {

/// Writer of the skeletons for --out; without one nothing is written.
class SkeletonOutput {
 public:
  explicit SkeletonOutput(const TrackOptions& options);
  /// Throws DiskFull.
  void Write(const tracker::BodyFrame& bodies);
  /// After DiskFull keeps the complete frames; throws InputError that states their number.
  void Finish();

 private:
  std::string path_;
  PostureRecorder recorder_;
  std::optional<recon::SkeletonWriter> writer_;
  std::optional<DiskFull> full_;
};

/// The pictures of --picture and --pictures. The single picture shows the frame with the most
/// tracked joints (the latest of ties).
class Pictures {
 public:
  explicit Pictures(const TrackOptions& options);
  /// Throws DiskFull.
  void Take(const depth::DepthFrame& frame, const tracker::BodyFrame& bodies);
  /// Throws InputError, also for a picture that did not fit earlier.
  void Finish() const;

 private:
  void WriteToFolder(const depth::DepthFrame& frame, const tracker::BodyFrame& bodies);

  std::string one_, folder_;
  int64_t in_folder_ = 0;  // pictures
  std::optional<DiskFull> full_;
  bool has_best_ = false;
  depth::DepthFrame best_frame_;
  tracker::BodyFrame best_;
};

/// The fitted people: for --save-person, and for checking an assumed camera.
class PersonKeeper {
 public:
  explicit PersonKeeper(const TrackOptions& options);
  void Take(const tracker::BodyFrame& bodies);
  /// Throws InputError if no person was fitted.
  void Finish(const TrackOptions& options) const;
  /// For an assumed camera: prints, unless quiet, if the most fitted person has an implausible
  /// adult stature, and the presets with which it would be plausible.
  void PrintUnlikelyStature(const TrackOptions& options, const depth::Camera& camera) const;

 private:
  struct Kept {
    recon::PersonShape shape;
    int64_t fits = 0;
  };
  /// The person with the most fits, by id; null if there is none.
  const std::pair<const int, Kept>* FindMostFitted() const;

  std::string path_;
  std::map<int, Kept> kept_;
};

}  // namespace ossa::commands
