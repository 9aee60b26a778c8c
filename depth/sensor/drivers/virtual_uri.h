#pragma once
#include <chrono>
#include <optional>
#include <string>

namespace ossa::depth {

/// Options of the virtual OpenNI2 device in `ossa://PATH?key=value&...`. PATH is any recorded
/// SOURCE (data set, PNG folder, .oni); in it, %3F stands for a question mark and %25 for a per
/// cent sign.
struct VirtualDeviceOptions {
  std::string path;
  bool loop = false;          // loop=1: restart at the end; otherwise the device is unplugged there
  double speed = 1.0;         // speed=2: twice as fast as recorded; > 0; factor; by definition
  std::optional<double> fps;  // fps=15: overrides the recording's times; > 0
  bool mirror = false;        // mirror=1: the device mirrors by default, as real ones do
  bool mirrored = false;      // mirrored=1: PATH's images are mirrored, and are turned back
  // Simulated failures for tests: after this many delivered frames the device is unplugged ...
  std::optional<int> unplug_after;            // unplug_after=30; frames, > 0
  std::chrono::milliseconds replug_after{0};  // replug_after_ms=200; 0: stays unplugged
  int unplugs = 1;                            // unplugs=5: number of times; by hand
  // ... after this many it silently stops delivering ...
  std::optional<int> stall_after;  // stall_after=30; frames
  // ... and after this many its clock starts again at 0, as a counter that overflows.
  std::optional<int> restart_clock_after;  // restart_clock_after=30; frames
};

inline constexpr const char* kVirtualScheme = "ossa://";

/// Throws InputError naming the URI and the part of it that is wrong.
VirtualDeviceOptions ParseVirtualUri(const std::string& uri);

}  // namespace ossa::depth
