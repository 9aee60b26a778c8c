#include <algorithm>

#include "recon/body/parts.h"
#include "tools/synth/frame_truth_internal.h"
#include "tools/synth/visibility_internal.h"

namespace ossa::tools {
namespace {

// Constants: chosen by hand unless stated otherwise.

// Width in pixels of an uncropped image with a Kinect's field of view and this frame's focal
// length.
double WidthOf(const LabelledFrame& frame, const FrameOptions& options) {
  constexpr double kWidthOverFocal = 640.0 / 575.0;  // of a Kinect v1; factor; derived
  if (options.cameras != Cameras::kAny && options.fov_deg == 0.0) return options.width;
  return kWidthOverFocal * frame.depth.camera.fx;
}

}  // namespace

void LabelProps(const depth::RenderedImage& seen, std::span<const Prop> props,
                std::span<const int> prop_mesh, Background background, depth::SensorImage* sensed,
                LabelledFrame* frame) {
  for (size_t i = 0; i < sensed->source.data.size(); ++i) {
    if (sensed->source.data[i] < 0 || frame->users.data[i] != 0) continue;
    const int mesh = seen.mesh.data[static_cast<size_t>(sensed->source.data[i])];
    const auto at = std::find(prop_mesh.begin(), prop_mesh.end(), mesh);
    const Prop* prop =
        at != prop_mesh.end() ? &props[static_cast<size_t>(at - prop_mesh.begin())] : nullptr;
    if (prop != nullptr && prop->counts_as_other) {
      frame->parts.data[i] = prop->part;
      frame->users.data[i] = prop->user;
    } else if (background == Background::kNone) {
      sensed->depth_mm.data[i] = 0;
    }
  }
}

void AddTruth(std::vector<TruthBody> bodies, const ViewSample& view, int64_t index,
              LabelledFrame* frame) {
  frame->bodies = std::move(bodies);
  frame->depth.index = index;
  frame->depth.time_s = static_cast<double>(index) / 30.0;
  const Eigen::Vector3d up = view.camera_from_world.linear().col(1);
  frame->floor =
      Eigen::Vector4d(up.x(), up.y(), up.z(), -up.dot(view.camera_from_world.translation()));
  MarkVisibleJoints(frame);
}

bool ShowsEnough(const LabelledFrame& frame, const FrameOptions& options) {
  constexpr double kLeastPixels = 900;  // of a 640-pixel-wide image: half a head at 2 m; pixels
  constexpr int kLeastJoints = 5;       // of the 20; by hand
  const double width = WidthOf(frame, options);
  const auto pixels = static_cast<double>(
      std::count_if(frame.parts.data.begin(), frame.parts.data.end(),
                    [](uint8_t part) { return part > 0 && part <= recon::kPartCount; }));
  const auto& visible = frame.bodies[0].visible;
  return pixels >= kLeastPixels * (width / 640.0) * (width / 640.0) &&
         std::count(visible.begin(), visible.end(), true) >= kLeastJoints;
}

}  // namespace ossa::tools
