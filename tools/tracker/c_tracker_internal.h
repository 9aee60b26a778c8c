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

/// The handle of a C program: a tracker and the data that returned pointers refer to.
struct ossa_tracker {
  ossa_tracker(const ossa::tracker::TrackerOptions& options, std::string surface, std::string mesh);

  ossa::tracker::Tracker tracker;
  int64_t images = 0;  // number of tracked images since creation or reset
  ossa::tracker::BodyFrame last;
  bool is_seated = false;
  // Null without a surface to fit: calls for stature, shape or skin then fail.
  std::shared_ptr<const ossa::recon::BodySurface> surface;
  std::string surface_file, mesh_file;  // as ossa_options names them, "": the shipped one
  std::shared_ptr<const ossa::recon::BodyMesh> mesh;  // loaded with the first skin
  std::vector<float> skin_m;                          // of the last skin
  std::deque<std::string> warnings;                   // not yet taken
  std::string taken_note;
};

struct ossa_source;

namespace ossa::depth {
class FrameSource;
}

namespace ossa::tracker {

/// Converts the options. Throws InputError and std::invalid_argument.
TrackerOptions OptionsFrom(const ossa_options& given);

/// The camera of an image, checked.
depth::Camera CameraFrom(const ossa_depth_image& image);

ossa_frame FrameFrom(const BodyFrame& bodies, Mount mount);
/// `surface` may be null.
ossa_body BodyFrom(const Body& body, const recon::BodySurface* surface);
ossa_object ObjectFrom(const SceneObjectState& object);

depth::FrameSource& FramesOf(ossa_source& source);
/// The callback that decides whether to keep waiting for the source
/// (ossa_source_options.keep_waiting).
const std::function<bool()>& KeepWaitingFor(const ossa_source& source);

}  // namespace ossa::tracker
