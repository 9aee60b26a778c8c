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

/// Until the person is found there is nothing to reconstruct, and methods answer with a posture in
/// no place: the recording begins with the first frame that has half of the joints. It is empty
/// where there is none.
void BeginWhenFound(RecordedPair& pair);

/// The Kinect SDK as it was seen to fail (Shum 2013 sec. IV; Obdrzalek 2012): joints that are seen
/// are a centimetre or two off, slowly drifting; hidden ones are half the time guessed (inferred,
/// wandering from where they were last seen relative to the body), half the time put on what hides
/// them and called tracked.
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
    bool grabbed = false;  // by the thing that hides it
  };

  Eigen::Vector3d Noise(double deviation_m);
  Eigen::Vector3d Hidden(const SequenceFrame& frame, const Eigen::Vector3d& true_m,
                         const Eigen::Vector3d& hips_m, JointMemory& memory);

  Random random_;
  recon::JointArray<JointMemory> memory_;
};

}  // namespace ossa::tools
