#include "tools/tracker/dynamics.h"

#include <fmt/ostream.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "depth/base/angles.h"
#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "depth/base/statistics.h"
#include "physics/character.h"
#include "recon/smallest_turn.h"

namespace ossa::tracker {
namespace {

using Eigen::Vector3d;
using recon::Joint;
using recon::kJointCount;

std::optional<recon::Posture> WholePosture(const recon::BodyRecord& body) {
  recon::Posture posture;
  for (size_t i = 0; i < kJointCount; ++i) {
    if (!body.joints[i] || !body.joints[i]->position_m.allFinite()) return std::nullopt;
    posture.position_m[i] = body.joints[i]->position_m;
  }
  return posture;
}

// Constants: chosen by hand.

constexpr double kStraight_deg = 20.0;  // largest angle between legs, trunk and the up direction
constexpr double kTilted_deg = 40.0;    // largest tilt of a camera
constexpr size_t kFewest_frames = 15;   // half a second of one person at 30 a second
constexpr double kSole_m = 0.03;        // from a foot joint to the sole, as of the character's feet

/// The up direction of a person who stands straight; nothing for others.
std::optional<Vector3d> FindStandingUp(const recon::Posture& p) {
  const Vector3d feet = 0.5 * (p[Joint::kAnkleLeft] + p[Joint::kAnkleRight]);
  const Vector3d knees = 0.5 * (p[Joint::kKneeLeft] + p[Joint::kKneeRight]);
  const Vector3d hips = 0.5 * (p[Joint::kHipLeft] + p[Joint::kHipRight]);
  const Vector3d shoulders = p[Joint::kShoulderCenter];
  const Vector3d up = shoulders - feet;
  if (ToDegrees(recon::AngleBetween_rad(up, Vector3d::UnitY())) > kTilted_deg) return std::nullopt;
  for (const Vector3d& part :
       {Vector3d(shoulders - hips), Vector3d(hips - knees), Vector3d(knees - feet)}) {
    if (!(ToDegrees(recon::AngleBetween_rad(part, up)) <= kStraight_deg)) return std::nullopt;
  }
  return up.normalized();
}

/// Consecutive frames of one person with all joints.
using Run = std::vector<physics::BodyPose>;

constexpr double kLongestGap_s = 0.25;  // by hand, as of physics/character_filter.h

std::map<int, std::vector<Run>> SplitIntoRuns(const recon::SkeletonSequence& sequence) {
  std::map<int, std::vector<Run>> runs;
  for (const recon::SkeletonFrame& frame : sequence.frames) {
    for (const recon::BodyRecord& body : frame.bodies) {
      const auto posture = WholePosture(body);
      if (!posture) continue;
      physics::BodyPose pose{frame.time_s, *posture, {}};
      for (size_t i = 0; i < kJointCount; ++i) {
        pose.orientation[i] = body.joints[i]->orientation.value_or(Eigen::Quaterniond::Identity());
      }
      std::vector<Run>& own = runs[body.id];
      const double gap_s = own.empty() ? 0.0 : frame.time_s - own.back().back().time_s;
      if (!own.empty() && !(gap_s > 0.0)) continue;
      if (own.empty() || gap_s > kLongestGap_s) own.emplace_back();
      own.back().push_back(std::move(pose));
    }
  }
  return runs;
}

std::string ColumnsText() {
  std::string text = "time_s,body";
  const auto add = [&text](const std::string& name, const std::string& unit) {
    for (const char* axis : {"x", "y", "z"}) text += "," + name + "_" + axis + "_" + unit;
  };
  for (const char* name : {"ground_force", "left_foot_force", "right_foot_force"}) add(name, "n");
  add("centre_of_pressure", "m");
  add("centre_of_mass", "m");
  text += ",free_moment_nm";
  for (size_t i = 2; i < kJointCount; ++i) {
    // The joint and the bone's end: three bones begin at the hip centre.
    add("torque_" + std::string(recon::kJointNames[recon::ParentOf(i)]) + "_to_" +
            std::string(recon::kJointNames[i]),
        "nm");
  }
  return text + "\n";
}

void WriteNumber(std::ostream& out, double value) { fmt::print(out, ",{:.6g}", value); }

void WriteVector(std::ostream& out, const Vector3d& v) {
  for (const double value : v) WriteNumber(out, value);
}

void WriteLine(std::ostream& out, double time_s, int body, const physics::Dynamics& d) {
  fmt::print(out, "{:.6f},{}", time_s, body);
  WriteVector(out, d.ground_force_n);
  WriteVector(out, d.foot_force_n[0]);
  WriteVector(out, d.foot_force_n[1]);
  if (d.centre_of_pressure_m) {
    WriteVector(out, *d.centre_of_pressure_m);
  } else {
    out << ",,,";
  }
  WriteVector(out, d.centre_of_mass_m);
  WriteNumber(out, d.free_moment_nm);
  for (size_t i = 2; i < kJointCount; ++i) WriteVector(out, d.torque_nm[i]);
  out << '\n';
}

}  // namespace

std::optional<Eigen::Vector4d> EstimateFloor(const recon::SkeletonSequence& sequence) {
  std::vector<recon::Posture> standing;
  Vector3d up = Vector3d::Zero();
  for (const recon::SkeletonFrame& frame : sequence.frames) {
    for (const recon::BodyRecord& body : frame.bodies) {
      const auto posture = WholePosture(body);
      const auto stands = posture ? FindStandingUp(*posture) : std::nullopt;
      if (!stands) continue;
      up += *stands;
      standing.push_back(*posture);
    }
  }
  if (standing.size() < kFewest_frames) return std::nullopt;
  up.normalize();
  std::vector<double> height_m;
  for (const recon::Posture& p : standing) {
    height_m.push_back(std::min(up.dot(p[Joint::kFootLeft]), up.dot(p[Joint::kFootRight])));
  }
  return Eigen::Vector4d(up.x(), up.y(), up.z(), kSole_m - Median(height_m));
}

void WriteDynamics(const std::filesystem::path& path, const recon::SkeletonSequence& sequence,
                   double mass_kg) {
  const auto with_floor = std::find_if(sequence.frames.begin(), sequence.frames.end(),
                                       [](const auto& frame) { return frame.floor.has_value(); });
  if (with_floor == sequence.frames.end()) {
    throw InputError(sequence.source +
                     ": expected a floor for forces of the ground (--floor auto or a,b,c,d)");
  }
  physics::DynamicsOptions options;
  options.mass_kg = mass_kg;
  options.floor = *with_floor->floor;
  AtomicFile file(path);
  file.stream() << ColumnsText();
  size_t lines = 0;
  for (const auto& [id, runs] : SplitIntoRuns(sequence)) {
    for (const Run& run : runs) {
      if (run.size() < 3) continue;  // too few for an acceleration
      const auto bones_m = recon::MeasureBoneLengths(run.front().posture);
      const auto dynamics = physics::ComputeDynamics(bones_m, run, options);
      for (size_t k = 0; k < run.size(); ++k) {
        WriteLine(file.stream(), run[k].time_s, id, dynamics[k]);
      }
      lines += run.size();
    }
  }
  if (lines == 0) {
    throw InputError(sequence.source +
                     ": expected three frames of a person within a quarter of a second each");
  }
  file.Commit();
}

}  // namespace ossa::tracker
