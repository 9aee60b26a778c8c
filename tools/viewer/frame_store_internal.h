#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "forest/forest.h"
#include "recon/fit/body_mesh.h"
#include "tools/viewer/display_frame.h"
#include "tools/viewer/message_internal.h"
#include "tools/viewer/spool_internal.h"

namespace ossa::viewer {

/// The frames that can be requested: of a recording all so far, of a camera the newest. Used from
/// any thread.
class FrameStore {
 public:
  /// `forest`: finds the missing body parts of requested frames of a camera; `body`: the mesh of
  /// fitted bodies. Each may be null.
  FrameStore(bool keeps, std::shared_ptr<const forest::ForestModel> forest,
             std::shared_ptr<const recon::BodyMesh> body);

  void Add(DisplayFrame display);
  /// The recording has ended.
  void Complete();
  /// Deletes all frames, for another run with changed settings.
  void Clear();

  struct Count {
    int64_t frames = 0;      // since the beginning
    int64_t generation = 0;  // number of calls of Clear()
    bool complete = false;
  };
  Count count() const;
  bool keeps() const { return spools_ != nullptr; }

  /// The frame of that number; of a camera always the newest. Null where there is none; `number`
  /// becomes that of the returned frame.
  std::shared_ptr<const PackedFrame> At(int64_t& number) const;
  /// The final skeletons of a frame as a line of skeleton JSONL without a line end; of a camera
  /// those of the newest frame. Empty without any.
  std::string Line(int64_t number) const;
  /// Shapes of people by body id, from their last fit.
  std::map<int, recon::ShapeVector> shapes() const;
  /// Seconds of a kept frame, on the recording's clock.
  double TimeOf(int64_t number) const;

 private:
  struct Kept {
    int width = 0, height = 0, planes = 0;
    size_t members = 0, pictures = 0;  // bytes of the record, which come before the meshes
    double time_s = 0.0;
  };
  struct Spools {
    Spool frames, lines;
    std::vector<Kept> kept;
  };
  std::shared_ptr<const PackedFrame> ReadKept(int64_t number) const;
  PackedFrame PackWithParts(const DisplayFrame& display) const;

  const std::shared_ptr<const forest::ForestModel> forest_;
  const std::shared_ptr<const recon::BodyMesh> body_;

  mutable std::mutex mutex_;  // guards all below
  Count count_;
  std::unique_ptr<Spools> spools_;
  std::shared_ptr<const DisplayFrame> newest_;
  std::map<int, recon::ShapeVector> shapes_;
  mutable std::shared_ptr<const PackedFrame> packed_;  // of the newest, once requested
};

}  // namespace ossa::viewer
