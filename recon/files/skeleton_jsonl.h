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
/// Beside "joints" a body may have "bones": estimates of the 19 bone lengths from this frame, in
/// the order of the joints at which the bones end. Objects of a scene follow the bodies,
/// "objects":[{"name":"crate","p":[x,y,z],"q":[w,x,y,z]}]; readers ignore them. Camera space,
/// metres. Empty fields and joints are left out. Lengths have seven digits after the point (a tenth
/// of a micrometre), other numbers six. Throws std::invalid_argument for a number that is not
/// finite, which JSON cannot represent.
std::string SkeletonJsonLine(const SkeletonFrame& frame);

/// Writes frames to a stream, a line each; the line is complete when Write returns. For a file use
/// AtomicFile::stream(), and Commit() at the end.
class SkeletonJsonlWriter {
 public:
  explicit SkeletonJsonlWriter(std::ostream& stream) : stream_(stream) {}
  void Write(const SkeletonFrame& frame);

 private:
  std::ostream& stream_;
};

/// Reads a stream of skeleton JSONL frame by frame, strictly: unknown joints or states, numbers
/// that are missing or not finite, a duplicate body id in a frame and lines over 1 MiB are refused
/// with InputError "SOURCE: line N: ...". Unknown keys are ignored; a floor's normal is scaled to
/// unit length, and a floor without a normal is dropped.
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

/// Reads the whole stream. Throws InputError for an empty one.
SkeletonSequence ReadSkeletonJsonl(std::istream& stream, const std::string& source);

}  // namespace ossa::recon
