#pragma once
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <vector>

#include "recon/fit/body_surface.h"
#include "recon/fit/posed_surface.h"
#include "recon/fit/surface_fit.h"
#include "tests/support/places.h"

namespace ossa::recon {

inline const BodySurface& Surface() {
  static const BodySurface surface =
      BodySurface::Load(test::SourceFolder() / "tools/tracker/shipped" / kShippedSurface);
  return surface;
}

/// A person 2.5 m in front of the camera, facing it, with each joint rotated randomly from its
/// mean.
inline SurfacePose RandomPose(unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, 1.0);
  SurfacePose pose;
  pose.parent_from_segment[0] =
      Eigen::AngleAxisd(M_PI + 0.3 * normal(random), Eigen::Vector3d::UnitY()).toRotationMatrix();
  pose.pelvis_m = {0.1 * normal(random), 0.0, 2.5};
  for (size_t s = 1; s < kSegmentCount; ++s) {
    const Eigen::Vector3d noise(normal(random), normal(random), normal(random));
    pose.parent_from_segment[s] = ToRotation(Surface().turn_mean[s] + 0.15 * noise);
  }
  for (double& value : pose.shape) value = 0.5 * normal(random);
  return pose;
}

/// A depth image of a posed surface, with each point drawn as a disc, in front of a wall at 4 m;
/// with the person's pixels and their parts.
struct SeenSurface {
  depth::DepthFrame frame;
  std::vector<int32_t> pixels;
  std::vector<uint8_t> parts;
  Posture joints_m;

  explicit SeenSurface(const SurfacePose& pose) {
    constexpr double kDisc_m = 0.04;
    frame.camera = depth::KinectV1Camera(320, 240);
    frame.depth_mm.assign(320 * 240, 4000);
    std::vector<uint8_t> part(frame.depth_mm.size(), 0);
    PosedSurface posed(Surface());
    posed.PoseSegments(pose);
    posed.PosePoints();
    joints_m = posed.Landmarks();
    for (size_t i = 0; i < posed.at_m().size(); ++i) {
      if (!posed.FacesCamera(i)) continue;
      const Eigen::Vector3d across = posed.normal()[i].unitOrthogonal();
      for (int ring = 0; ring < 8; ++ring) {
        for (int k = 0; k < 24; ++k) {
          const Eigen::Vector3d off =
              Eigen::AngleAxisd(k * M_PI / 12, posed.normal()[i]) * across * kDisc_m * ring / 8.0;
          Paint(posed.at_m()[i] + off, posed.surface().points[i].part, part);
        }
      }
    }
    for (size_t p = 0; p < part.size(); ++p) {
      if (part[p] == 0) continue;
      pixels.push_back(static_cast<int32_t>(p));
      parts.push_back(part[p]);
    }
  }

  SurfaceFitInput Input(const Posture& start_m) const {
    SurfaceFitInput input;
    input.joints_m = start_m;
    for (auto& confidence : input.confidence) confidence = 0.9;
    input.depth = &frame;
    input.pixels = input.samples = pixels;
    input.parts = parts;
    return input;
  }

 private:
  void Paint(const Eigen::Vector3d& at_m, uint8_t label, std::vector<uint8_t>& part) {
    const Eigen::Vector2d px = depth::Project(frame.camera, at_m);
    const long u = std::lround(px.x()), v = std::lround(px.y());
    if (u < 0 || v < 0 || u >= 320 || v >= 240) return;
    const auto pixel = static_cast<size_t>(v * 320 + u);
    const auto depth_mm = static_cast<uint16_t>(std::lround(1000 * at_m.z()));
    if (depth_mm >= frame.depth_mm[pixel]) return;
    frame.depth_mm[pixel] = depth_mm;
    part[pixel] = label;
  }
};

/// Each joint moved by noise of this standard deviation an axis.
inline Posture Disturbed(const Posture& joints_m, double sigma_m, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, sigma_m);
  Posture disturbed = joints_m;
  for (Eigen::Vector3d& joint : disturbed.position_m) {
    joint += Eigen::Vector3d(normal(random), normal(random), normal(random));
  }
  return disturbed;
}

inline double MeanDistance_m(const Posture& a, const Posture& b) {
  double sum = 0.0;
  for (size_t j = 0; j < kJointCount; ++j) sum += (a.position_m[j] - b.position_m[j]).norm();
  return sum / kJointCount;
}

}  // namespace ossa::recon
