#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "depth/image/depth_frame.h"
#include "recon/body/rig.h"
#include "recon/skeleton_sequence.h"
#include "tools/experiments/compare/recordings.h"
#include "tools/experiments/experiment.h"

namespace ossa::tools {

// Constants: by hand; the image is half a Kinect v1's each way, for speed.

/// Objects between the sensor and the person.
enum class Clutter {
  kNone,
  kFurniture,  // things that stand before the person: tables, chairs, boards
  kHeld,       // a thing in the hands
  kCarSeat,    // a seat with its back rest, close before the person, as in Plantard 2016 fig. 4
};

/// A performance before a virtual sensor. The clip is turned so that it begins facing the sensor
/// when the azimuth is zero.
struct SequenceOptions {
  std::string name;
  Clutter clutter = Clutter::kNone;
  double azimuth_rad = 0.0;  // of the sensor about the person; negative: on the person's right
  double distance_m = 2.7;   // of the sensor from the middle of the motion
  int width = 320;
  int height = 240;
  int64_t frames = 150;  // at most, at 30 Hz
  uint64_t seed = 1;     // of body, clothes, things and sensor noise
};

/// One frame: what the sensor measures, and the true joints, hidden ones too.
struct SequenceFrame {
  depth::DepthFrame depth;
  recon::SkeletonFrame truth;  // one body, id 1, with JointRecord::visible
};

/// Renders performances with Embree and records them as a sensor's software would: observed and
/// true skeletons, frame by frame. Bodies are of the shapes kept for tests.
class RecordingSimulator {
 public:
  /// `observer`: "forest", the tracker's raw joints (needs a model), or "simulated", joints made up
  /// from the truth and the depth image as the Kinect's SDK was seen to fail. Reads the body model
  /// only when something must be rendered.
  RecordingSimulator(const ExperimentContext& context, std::string observer);
  ~RecordingSimulator();

  /// Cached by content. Begins with the first frame in which half of the joints are found; empty
  /// where none is.
  RecordedPair Record(const recon::MotionClip& clip, const SequenceOptions& options);
  /// The frames themselves, uncached: for pictures and tests.
  std::vector<SequenceFrame> RenderClip(const recon::MotionClip& clip,
                                        const SequenceOptions& options);

 private:
  // Uncached, and from the first frame on.
  RecordedPair Observe(const recon::MotionClip& clip, const SequenceOptions& options);

  struct State;
  std::unique_ptr<State> state_;
};

/// The parameter `observer`, "forest" by default.
std::string ReadObserver(Parameters& parameters);

/// Description of the observer for tables.
std::string ObserverNote(const std::string& observer);

}  // namespace ossa::tools
