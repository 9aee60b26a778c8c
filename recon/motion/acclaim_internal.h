#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "recon/motion/source_motion_internal.h"

namespace ossa::recon {

/// A degree of freedom of an Acclaim bone, in the order the file's numbers come.
enum class AcclaimDof { kRx, kRy, kRz, kTx, kTy, kTz, kLength };

struct AcclaimBone {
  std::string name;
  int parent = -1;                                    // bone 0 is the root; parents before children
  Eigen::Vector3d segment = Eigen::Vector3d::Zero();  // direction times length, metres
  Eigen::Quaterniond axis = Eigen::Quaterniond::Identity();  // C: world from the bone's own axes
  std::vector<AcclaimDof> dofs;
};

/// An Acclaim skeleton file (.asf).
struct AcclaimSkeleton {
  std::string source;
  std::vector<AcclaimBone> bones;
  double metres_per_unit = 0.0254;  // file lengths divided by the `length` of :units are inches
  bool degrees = true;
  int BoneNamed(std::string_view name) const;  // -1: none
};

AcclaimSkeleton ParseAsf(std::string text, const std::string& source);

/// The motion of an .amc on its skeleton, for retargeting. AMC has no frame time: CMU and HDM05
/// publish at 120 Hz. Joint limits in the ASF are ignored: recorded motion exceeds them.
SourceMotion ParseAmc(std::string text, const std::string& source,
                      std::shared_ptr<const AcclaimSkeleton> skeleton, double frame_s);

/// The ASF of an AMC: the only one in its folder, or the one whose name is the longest prefix of
/// the AMC's.
std::filesystem::path AsfBeside(const std::filesystem::path& amc);

}  // namespace ossa::recon
