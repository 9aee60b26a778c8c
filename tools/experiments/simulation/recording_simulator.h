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
  kFurniture,  // objects in front of the person: tables, chairs, boards
  kHeld,       // an object in the hands
  kCarSeat,    // a seat with its backrest close in front of the person, as in Plantard 2016 fig. 4
};

/// A sequence rendered for a virtual sensor. The clip is turned so that it begins facing the sensor
/// if the azimuth is zero.
struct SequenceOptions {
  std::string name;
  Clutter clutter = Clutter::kNone;
  double azimuth_rad = 0.0;  // of the sensor about the person; negative: on the person's right
  double distance_m = 2.7;   // of the sensor from the centre of the motion
  int width = 320;
  int height = 240;
  int64_t frames = 150;  // at most, at 30 Hz
  uint64_t seed = 1;     // of body, clothes, objects and sensor noise
};

/// One frame: what the sensor measures, and the true joints, hidden ones too.
struct SequenceFrame {
  depth::DepthFrame depth;
  recon::SkeletonFrame truth;  // one body, id 1, with JointRecord::visible
};

/// Renders sequences with Embree and simulates the recording of a sensor's software: observed and
/// true skeletons. Body shapes are those kept for tests.
class RecordingSimulator {
 public:
  /// `observer`: "forest", the tracker's raw joints (needs a model), or "simulated", a model of the
  /// Kinect SDK's failures (SimulatedSdk); throws InputError for other names. The body model is
  /// read only if something must be rendered.
  RecordingSimulator(const ExperimentContext& context, std::string observer);
  ~RecordingSimulator();

  /// Cached by content. Begins with the first frame in which half of the joints are observed; empty
  /// if there is none.
  RecordedPair Record(const recon::MotionClip& clip, const SequenceOptions& options);
  /// The rendered frames, not cached; for pictures and tests.
  std::vector<SequenceFrame> RenderClip(const recon::MotionClip& clip,
                                        const SequenceOptions& options);

 private:
  // Not cached, from the first frame on.
  RecordedPair Observe(const recon::MotionClip& clip, const SequenceOptions& options);

  struct State;
  std::unique_ptr<State> state_;
};

/// The parameter `observer`, "forest" by default.
std::string ReadObserver(Parameters& parameters);

/// Description of the observer for tables.
std::string ObserverNote(const std::string& observer);

}  // namespace ossa::tools
