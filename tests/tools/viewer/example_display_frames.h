#pragma once
#include <cstdint>

#include "tests/support/depth_examples.h"
#include "tools/viewer/viewer.h"

/// Servers and frames for the tests of the viewer.
namespace ossa::viewer {

inline constexpr const char* kStateRequest = "GET /state HTTP/1.1\r\nHost: localhost";

/// Options of a server on a free port. `keeps`: as for a recording, all frames can be requested.
inline ViewerOptions AnyPort(bool keeps = false) {
  ViewerOptions options;
  options.port = 0;
  options.keeps = keeps;
  return options;
}

/// A frame with a content specific to its index: depth by ExampleFrame, skeletons by a joint.
inline DisplayFrame ExampleDisplayFrame(int index) {
  DisplayFrame display;
  display.depth = test::ExampleFrame(index);
  const size_t pixels = display.depth.depth_mm.size();
  display.users = {32, 24, static_cast<uint8_t>(index % 6 + 1)};
  display.parts.data.assign(pixels, static_cast<uint8_t>(index % 31 + 1));
  recon::BodyRecord body;
  body.id = 1;
  body.joints[3].emplace().position_m = {0.001 * index, 0.5, 2.0};
  display.layers[0].frame = index;
  display.layers[0].time_s = index / 30.0;
  display.layers[0].bodies = {body};
  return display;
}

}  // namespace ossa::viewer
