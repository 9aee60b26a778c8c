#pragma once
#include <cstdint>
#include <istream>
#include <string>
#include <vector>

namespace ossa::depth {

/// An event of a Kinect Studio recording: an image, or the bodies of a frame.
struct XefEvent {
  int64_t at = 0;             // of its bytes in the file
  uint32_t stored_bytes = 0;  // in the file
  uint32_t bytes = 0;
  bool is_compressed = false;
  double time_s = 0.0;  // by the recording's clock
  int64_t number = -1;  // the sensor's count of frames; -1: not stated
};

/// Where the events of a Kinect Studio recording (.xef, Kinect v2) are in the file, as
/// KinectXEFTools documents the format; archived ones, whose events KSConvert compressed, too.
struct XefIndex {
  std::vector<XefEvent> depth;       // "Nui Depth", in their order
  std::vector<XefEvent> bodies;      // "Nui Body Frame"
  std::vector<std::string> streams;  // names of all streams
  int64_t lost_bytes = 0;            // of damage: they are no event
  bool is_cut_short = false;

  std::string StreamNames() const;  // "Nui IR, Nui Depth"; "none"
};

/// Whether a file begins as a recording of Kinect Studio does.
bool IsXef(std::string_view head);

/// Reads the places of the events. Throws InputError, `name` first, for other files.
XefIndex ReadXefIndex(std::istream& file, const std::string& name);

/// The bytes of an event. Throws InputError if they are damaged.
std::vector<uint8_t> ReadXefBytes(std::istream& file, const XefEvent& event);

/// Depth images are 512 × 424 in millimetres, low byte first, as the SDK delivers them: mirrored.
inline constexpr int kXefWidth = 512;  // pixels, the Kinect v2's
inline constexpr int kXefHeight = 424;

}  // namespace ossa::depth
