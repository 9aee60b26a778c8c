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
#include "tools/viewer/message_internal.h"
#include "tools/viewer/moment.h"
#include "tools/viewer/spool_internal.h"

namespace ossa::viewer {

/// The moments that may be asked for: of a recording all until now, of a camera the newest. Used
/// from any thread.
class FrameStore {
 public:
  /// `forest`: of a camera finds the parts of moments that are asked for and have none; `body`: the
  /// skin of fitted bodies. Each may be null.
  FrameStore(bool keeps, std::shared_ptr<const forest::ForestModel> forest,
             std::shared_ptr<const recon::BodyMesh> body);

  void Add(Moment moment);
  /// Of a recording: nothing more comes.
  void Complete();
  /// Begins anew, as with other settings.
  void Clear();

  struct Count {
    int64_t frames = 0;      // that came since the beginning
    int64_t generation = 0;  // how often it began anew
    bool complete = false;
  };
  Count count() const;
  bool keeps() const { return spools_ != nullptr; }

  /// The moment of that number; of a camera the newest, whatever the number. Nothing where there is
  /// none; `number` becomes that of what is returned.
  std::shared_ptr<const PackedMoment> At(int64_t& number) const;
  /// The final skeletons of a frame as a line of skeleton JSONL without its end; of a camera those
  /// of the newest. Empty where there are none.
  std::string Line(int64_t number) const;
  /// What is known of people's shapes, by body id: the last fit's.
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
    Spool moments, lines;
    std::vector<Kept> kept;
  };
  std::shared_ptr<const PackedMoment> ReadKept(int64_t number) const;
  PackedMoment PackWithParts(const Moment& moment) const;

  const std::shared_ptr<const forest::ForestModel> forest_;
  const std::shared_ptr<const recon::BodyMesh> body_;

  mutable std::mutex mutex_;  // guards all below
  Count count_;
  std::unique_ptr<Spools> spools_;
  std::shared_ptr<const Moment> newest_;
  std::map<int, recon::ShapeVector> shapes_;
  mutable std::shared_ptr<const PackedMoment> packed_;  // of the newest, once it was asked for
};

}  // namespace ossa::viewer
