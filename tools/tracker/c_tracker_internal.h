#pragma once
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ossa/ossa_c.h"
#include "recon/fit/body_mesh.h"
#include "tools/tracker/tracker.h"

/// What a C program holds: a tracker, and all that the pointers handed out point into.
struct ossa_tracker {
  ossa_tracker(const ossa::tracker::TrackerOptions& options, std::string surface, std::string mesh);

  ossa::tracker::Tracker tracker;
  int64_t images = 0;  // tracked since it was created or reset
  ossa::tracker::BodyFrame last;
  bool is_seated = false;
  // Null without a surface to fit: who asks for stature, shape or skin learns that there is none.
  std::shared_ptr<const ossa::recon::BodySurface> surface;
  std::string surface_file, mesh_file;  // as ossa_options names them, "": the shipped one
  std::shared_ptr<const ossa::recon::BodyMesh> mesh;  // read for who first asks for a skin
  std::vector<float> skin_m;                          // of the last skin that was asked for
  std::deque<std::string> warnings;                   // of the models, not yet taken
  std::string taken_note;
};

struct ossa_source;

namespace ossa::depth {
class FrameSource;
}

namespace ossa::tracker {

/// In the tracker's own terms. Throws InputError and std::invalid_argument.
TrackerOptions OptionsFrom(const ossa_options& given);

/// A frame whose pixels stay the caller's; the image says how many there are, so that it is checked
/// before one is read. Without `depths` none are.
depth::Camera CameraFrom(const ossa_depth_image& image);

ossa_frame FrameFrom(const BodyFrame& bodies, Mount mount);
/// `surface` may be null.
ossa_body BodyFrom(const Body& body, const recon::BodySurface* surface);
ossa_object ObjectFrom(const SceneObjectState& object);

depth::FrameSource& FramesOf(ossa_source& source);
/// Whether whoever waits for the source goes on (ossa_source_options.keep_waiting).
const std::function<bool()>& KeepWaitingFor(const ossa_source& source);

}  // namespace ossa::tracker
