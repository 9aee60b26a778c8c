#pragma once
#include <array>
#include <filesystem>
#include <vector>

#include "depth/base/random.h"
#include "tools/experiments/simulation/recording_simulator.h"

namespace ossa::tools {

/// Model files of the observer "forest"; empty: none. The key of the cache contains all of them.
struct ObserverFiles {
  std::filesystem::path forest, refinement, network, surface;
  std::vector<std::filesystem::path> All() const;
};

/// `model`: a custom forest, which is not refined; empty: the shipped one.
ObserverFiles FindObserverFiles(const std::filesystem::path& model);

/// Removes the frames before the first one with half of the joints; all of them if there is none.
/// Before the person is found, methods cannot reconstruct anything.
void BeginWhenFound(RecordedPair& pair);

/// A model of the Kinect SDK's failures (Shum 2013 sec. IV; Obdrzalek 2012). Visible joints have a
/// slowly drifting error of one or two centimetres. Half of the hidden joints are inferred and
/// drift from where they were last seen relative to the body; the other half lie on the occluder
/// and are reported as tracked.
class SimulatedSdk {
 public:
  explicit SimulatedSdk(uint64_t seed) : random_(seed, 4711) {}
  recon::SkeletonFrame Observe(const SequenceFrame& frame);

 private:
  struct JointMemory {
    Eigen::Vector3d drift_m = Eigen::Vector3d::Zero();
    Eigen::Vector3d wander_m = Eigen::Vector3d::Zero();
    Eigen::Vector3d from_hips_m = Eigen::Vector3d::Zero();  // where it was last seen
    bool seen_once = false;
    bool hidden = false;
    bool grabbed = false;  // lies on the occluder
  };

  Eigen::Vector3d Noise(double deviation_m);
  Eigen::Vector3d Hidden(const SequenceFrame& frame, const Eigen::Vector3d& true_m,
                         const Eigen::Vector3d& hips_m, JointMemory& memory);

  Random random_;
  recon::JointArray<JointMemory> memory_;
};

}  // namespace ossa::tools
