#pragma once
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "depth/base/error.h"
#include "recon/motion/mocap.h"
#include "tests/support/capsule_person.h"
#include "tools/tracker/shipped.h"
#include "tools/tracker/tracker.h"

namespace ossa::tracker {

/// The shipped model's path, or "" when this checkout has none: such tests skip and say so.
inline std::string ModelOrNothing() {
  try {
    return ShippedFile("body.ossa").string();
  } catch (const InputError&) {
    return {};
  }
}

#define OSSA_NEEDS_MODEL()            \
  if (ModelOrNothing().empty())       \
  GTEST_SKIP() << "no shipped model " \
                  "(tools/tracker/shipped/body.ossa)"

/// ossa's own clips, made once: under sanitizers they take half a minute.
inline const std::vector<recon::MotionClip>& AuthoredMotion() {
  static const std::vector<recon::MotionClip> clips = recon::LoadMocap({"authored"});
  return clips;
}

/// Options that need the model only; joints come out as the forest and the image have them.
inline TrackerOptions PlainOptions() {
  TrackerOptions options;
  options.method = "none";
  options.smoothing = SmoothingPreset("none");
  return options;
}

/// A method by files of one's own.
inline TrackerOptions OptionsWith(const ModelFiles& files,
                                  std::string_view method = recon::kDefaultMethod) {
  TrackerOptions options;
  options.method = method;
  options.models = ModelSet::Load(files, method);
  return options;
}

inline tests::CapsulePose PersonAt(double x_m, double z_m) {
  tests::CapsulePose pose;
  pose.feet_m = {x_m, -1.0, z_m};
  pose.left_lift_rad = 0.5;
  pose.right_lift_rad = 0.5;
  return pose;
}

inline tests::CapsuleRender Rendered(const std::vector<tests::CapsulePose>& people, int frame = 0,
                                     double noise_m = 0.0) {
  tests::CapsuleScene scene;
  scene.people = people;
  scene.planes = tests::EmptyRoom();
  scene.noise_m = noise_m;
  scene.seed = static_cast<uint64_t>(frame) + 1;
  auto render = tests::Render(scene, depth::KinectV1Camera(320, 240));
  render.frame.index = frame;
  render.frame.time_s = frame / 30.0;
  return render;
}

}  // namespace ossa::tracker
