#pragma once
#include <istream>
#include <memory>
#include <ostream>
#include <string>

#include "recon/skeleton_sequence.h"

namespace ossa::recon {

/// One frame as a line of skeleton JSONL (docs/architecture.md, "Skeleton JSONL"), without the line
/// end:
/// {"frame":0,"time_s":0.0,"floor":[a,b,c,d],"bodies":[{"id":1,"joints":{"HipCenter":{"p":[x,y,z],
/// "state":"tracked","confidence":0.93,"reliability":0.88,"q":[w,x,y,z],"visible":true},...}}]}
/// A joint of a fitted body also has "sigma":[x,y,z], standard deviations along the camera's axes.
/// Beside "joints" a body may have "bones": the lengths of the 19 bones as they were judged of this
/// frame, in the order of the joints that they end in. Things of a scene follow the bodies,
/// "objects":[{"name":"crate","p":[x,y,z],"q":[w,x,y,z]}]; readers pass them over. Camera space,
/// metres. Empty fields and joints are left out. Lengths carry seven digits after the point (a
/// tenth of a micrometre), other numbers six. Throws std::invalid_argument for a number that is not
/// finite: JSON cannot say it and a reader would refuse it.
std::string SkeletonJsonLine(const SkeletonFrame& frame);

/// Appends frames to a stream as they come, a line each; every line is complete when Write returns.
/// Give it AtomicFile::stream() and Commit() at the end, or std::cout.
class SkeletonJsonlWriter {
 public:
  explicit SkeletonJsonlWriter(std::ostream& stream) : stream_(stream) {}
  void Write(const SkeletonFrame& frame);

 private:
  std::ostream& stream_;
};

/// Reads a stream of skeleton JSONL frame by frame, strictly: unknown joints or states, numbers
/// that are missing or not finite, a body id twice in a frame and lines over 1 MiB are refused with
/// InputError "SOURCE: line N: ...". Keys this version does not know are passed over; a floor whose
/// normal is no unit is brought to one, and without a normal is none.
class SkeletonJsonlReader {
 public:
  SkeletonJsonlReader(std::istream& stream, std::string source);
  ~SkeletonJsonlReader();
  SkeletonJsonlReader(const SkeletonJsonlReader&) = delete;
  SkeletonJsonlReader& operator=(const SkeletonJsonlReader&) = delete;

  /// False at the end of the stream.
  bool Next(SkeletonFrame& frame);

 private:
  class Lines;
  std::unique_ptr<Lines> lines_;
};

/// The whole stream. An empty one is refused.
SkeletonSequence ReadSkeletonJsonl(std::istream& stream, const std::string& source);

}  // namespace ossa::recon
