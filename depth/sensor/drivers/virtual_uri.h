#pragma once
#include <chrono>
#include <optional>
#include <string>

namespace ossa::depth {

/// What `ossa://PATH?key=value&...` asks of the virtual OpenNI2 device. PATH is any recorded SOURCE
/// (data set, PNG folder, .oni); in it, %3F stands for a question mark and %25 for a per cent sign.
struct VirtualDeviceOptions {
  std::string path;
  bool loop = false;   // loop=1: begin anew at the end; otherwise the device is unplugged there
  double speed = 1.0;  // speed=2: twice as fast as recorded; > 0; factor; by definition
  std::optional<double> fps;  // fps=15: this rate whatever the recording's times; > 0
  bool mirror = false;        // mirror=1: the device mirrors until told not to, as real ones do
  bool mirrored = false;      // mirrored=1: PATH's images are as a mirror shows them
  // Simulated trouble, for tests: after so many frames delivered the device is unplugged ...
  std::optional<int> unplug_after;            // unplug_after=30; frames, > 0
  std::chrono::milliseconds replug_after{0};  // replug_after_ms=200; 0: never comes back
  int unplugs = 1;                            // unplugs=5: this often; by hand
  // ... and after so many it stops delivering without a word.
  std::optional<int> stall_after;  // stall_after=30; frames
};

inline constexpr const char* kVirtualScheme = "ossa://";

/// Throws InputError naming the URI and the part of it that is wrong.
VirtualDeviceOptions ParseVirtualUri(const std::string& uri);

}  // namespace ossa::depth
