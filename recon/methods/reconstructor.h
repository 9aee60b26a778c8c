#pragma once
#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "depth/image/depth_frame.h"
#include "recon/posture.h"

namespace ossa::recon {

/// What a method is told of one person at one time.
struct ReconstructionInput {
  TrackedPosture observed;  // camera space
  double time_s = 0.0;      // steps may be irregular; gaps of seconds happen
  /// The depth image, when there is one: whether a surface lies where a joint is said to be tells
  /// an occluded joint from a wrong one. Borrowed for the call.
  const depth::DepthFrame* depth = nullptr;
};

struct ReconstructedPosture {
  Posture posture;                                // camera space, all 20 joints finite
  std::array<double, kJointCount> reliability{};  // R_i in [0, 1] of the observed joint, eq. 8
};

/// One person's posture made complete and plausible, frame by frame. One object per person.
class Reconstructor {
 public:
  virtual ~Reconstructor() = default;
  /// Never throws on odd observations: all joints missing, NaN, jumps in time.
  virtual ReconstructedPosture Step(const ReconstructionInput& input) = 0;
  /// Forgets the person.
  virtual void Reset() = 0;
};

class PostureDatabase;  // recon/database/posture_database.h

struct ReconstructorOptions {
  std::string method = "best";                      // one of ReconstructionMethods()
  std::shared_ptr<const PostureDatabase> database;  // needed by the methods that look things up
  std::string learned_file;  // .ossagp of `ossa learn`: liu-2016, full-gp, best
  uint64_t seed = 1;
};

/// Names of all methods, in the order of `ossa track --help`.
const std::vector<std::string>& ReconstructionMethods();

/// Throws InputError for an unknown method or a missing database.
std::unique_ptr<Reconstructor> MakeReconstructor(const ReconstructorOptions& options);

}  // namespace ossa::recon
