#pragma once
#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "depth/image/depth_frame.h"
#include "depth/image/image.h"
#include "recon/fit/posed_surface.h"
#include "recon/skeleton_sequence.h"
#include "tools/tracker/tracker.h"
#include "tools/viewer/solids.h"

namespace ossa::viewer {

/// The skeletons of one frame, a layer of the page for each stage that made some.
enum class Layer { kFinal, kRefined, kRaw };
inline constexpr std::array<std::string_view, 3> kLayerNames = {"final", "refined", "raw"};

/// The body that was fitted to a person's pixels.
struct FittedBody {
  int id = 0;
  recon::SurfacePose pose;
};

/// One frame as the page shows it: pictures and skeletons that belong together.
struct DisplayFrame {
  depth::DepthFrame depth;      // without pixels: the frame of a skeleton file
  depth::Image<uint8_t> users;  // body id of each pixel, 0 nobody; empty: not known
  depth::Image<uint8_t> parts;  // body part of each pixel, 0 none; empty: not known
  std::array<recon::SkeletonFrame, kLayerNames.size()> layers;  // by Layer; camera space, metres
  std::vector<FittedBody> fits;
  std::vector<Solid> solids;  // of physics: characters and things
  tracker::StageTimes ms;     // as measured by the tracker; all 0: not measured
  int64_t dropped = 0;        // frames that the device lost since the start
  bool is_upright = true;     // people stand in the image, as the camera is mounted
  double latency_ms = 0.0;    // from the frame's arrival until it is shown

  const recon::SkeletonFrame& skeletons() const { return layers[0]; }
};

/// A frame with the result of the tracker.
DisplayFrame MakeDisplayFrame(depth::DepthFrame frame, tracker::BodyFrame bodies);

/// A frame of a skeleton file: no pictures.
DisplayFrame MakeDisplayFrame(recon::SkeletonFrame skeletons);

}  // namespace ossa::viewer
