#pragma once
#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "recon/motion/bone_names_internal.h"
#include "recon/posture.h"

namespace ossa::recon {

/// Checks that a retargeted motion agrees with its source, by the angles between corresponding
/// bones.
class AgreementCheck {
 public:
  explicit AgreementCheck(const SourceBones& bones);

  /// Adds a frame: positions of the source's joints in our axes, any unit, and the standard body's.
  void Add(const std::vector<Eigen::Vector3d>& source, const Posture& ours);

  /// Throws InputError that names the worst bone if the motions disagree.
  void Require(const std::string& source) const;

 private:
  struct Pair {
    std::string name;
    std::array<int, 2> from, to;  // joints of the source; their midpoint is used
    std::array<Joint, 2> our_from, our_to;
    double sum_rad = 0.0;
  };

  void AddSide(const SideBones& side, bool left);

  std::vector<Pair> pairs_;
  size_t frames_ = 0;
};

}  // namespace ossa::recon
