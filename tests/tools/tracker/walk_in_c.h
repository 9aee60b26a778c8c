#pragma once
#include <cmath>
#include <string>

#include "ossa/ossa_c.h"
#include "tests/tools/tracker/tracked_scenes.h"

namespace ossa::test {

inline ossa_depth_image ImageOf(const depth::DepthFrame& frame) {
  const depth::Camera& c = frame.camera;
  return {sizeof(ossa_depth_image), c.width,     c.height, c.fx, c.fy, c.cx, c.cy,
          frame.depth_mm.data(),    frame.time_s};
}

/// A struct of ossa_c.h as a program hands it over.
template <typename Struct>
Struct Sized() {
  Struct made{};
  made.struct_size = sizeof made;
  return made;
}

inline ossa_options PlainOptionsInC() {
  auto options = Sized<ossa_options>();
  options.method = "none";
  options.smoothing = "none";
  return options;
}

inline bool Says(const char* what) {
  return std::string(ossa_last_error()).find(what) != std::string::npos;
}

/// A walk to the side, a frame a step, seen through the C interface.
class WalkInC {
 public:
  explicit WalkInC(ossa_options options = PlainOptionsInC())
      : tracker(ossa_tracker_create(&options)) {}
  ~WalkInC() { ossa_tracker_destroy(tracker); }
  WalkInC(const WalkInC&) = delete;
  WalkInC& operator=(const WalkInC&) = delete;

  ossa_body Next() {
    const tests::CapsuleRender render =
        tracker::Rendered({tracker::PersonAt(0.03 * frames_, 2.5)}, frames_);
    const ossa_depth_image image = ImageOf(render.frame);
    EXPECT_EQ(ossa_tracker_track(tracker, &image, &frame), OSSA_OK) << ossa_last_error();
    ++frames_;
    EXPECT_EQ(frame.body_count, 1);
    ossa_body body{};
    body.struct_size = sizeof body;
    EXPECT_EQ(ossa_tracker_body(tracker, 0, &body), OSSA_OK) << ossa_last_error();
    return body;
  }
  int32_t SpineState() { return Next().joints[OSSA_SPINE].state; }
  /// How far smoothing moved the head, metres.
  float SmoothedBy_m() {
    const ossa_body body = Next();
    const float* final_m = body.joints[OSSA_HEAD].position_m;
    const float* before_m = body.reconstructed_m[OSSA_HEAD];
    return std::hypot(final_m[0] - before_m[0], final_m[1] - before_m[1], final_m[2] - before_m[2]);
  }

  ossa_tracker* tracker = nullptr;
  ossa_frame frame = Sized<ossa_frame>();

 private:
  int frames_ = 0;
};

}  // namespace ossa::test
