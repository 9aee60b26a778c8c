#include "tests/support/capsule_person.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

namespace ossa::tests {
namespace {

using Eigen::Vector3d;
using recon::Joint;

constexpr double kMiss = std::numeric_limits<double>::infinity();

struct Axes {
  Vector3d left, up, forward;
};

Axes AxesOf(const CapsulePose& pose) {
  const Eigen::AngleAxisd turn(pose.yaw_rad, Vector3d::UnitY());
  return {turn * Vector3d(-1, 0, 0), Vector3d::UnitY(), turn * Vector3d(0, 0, -1)};
}

// Distance z along the ray z * direction (direction.z = 1) to a sphere, or kMiss.
double HitSphere(const Vector3d& direction, const Vector3d& centre, double radius) {
  const double a = direction.squaredNorm();
  const double b = direction.dot(centre);
  const double discriminant = b * b - a * (centre.squaredNorm() - radius * radius);
  if (discriminant < 0) return kMiss;
  const double z = (b - std::sqrt(discriminant)) / a;
  return z > 0 ? z : kMiss;
}

double HitCapsule(const Vector3d& direction, const Capsule& capsule) {
  double z = std::min(HitSphere(direction, capsule.a_m, capsule.radius_m),
                      HitSphere(direction, capsule.b_m, capsule.radius_m));
  const Vector3d axis = capsule.b_m - capsule.a_m;
  const double length2 = axis.squaredNorm();
  if (length2 < 1e-12) return z;
  // Components across the axis: |z d' - a'|^2 = r^2.
  const Vector3d d = direction - axis * (direction.dot(axis) / length2);
  const Vector3d c = capsule.a_m - axis * (capsule.a_m.dot(axis) / length2);
  const double a = d.squaredNorm();
  const double b = d.dot(c);
  const double discriminant = b * b - a * (c.squaredNorm() - capsule.radius_m * capsule.radius_m);
  if (a < 1e-12 || discriminant < 0) return z;
  const double hit = (b - std::sqrt(discriminant)) / a;
  const double along = (hit * direction - capsule.a_m).dot(axis) / length2;
  if (hit > 0 && along >= 0 && along <= 1) z = std::min(z, hit);
  return z;
}

double HitBox(const Vector3d& direction, const Box& box) {
  double near = 0, far = kMiss;
  for (int i = 0; i < 3; ++i) {
    if (std::abs(direction[i]) < 1e-12) {
      if (box.low_m[i] > 0 || box.high_m[i] < 0) return kMiss;
      continue;
    }
    double t0 = box.low_m[i] / direction[i], t1 = box.high_m[i] / direction[i];
    if (t0 > t1) std::swap(t0, t1);
    near = std::max(near, t0);
    far = std::min(far, t1);
  }
  return near <= far && near > 0 ? near : kMiss;
}

std::vector<Capsule> CapsulesOf(const CapsulePose& pose) {
  const recon::Posture p = ComputeJoints(pose);
  const double s = pose.height_m / 1.75;
  const Axes axes = AxesOf(pose);
  const auto at = [&](Joint j) { return p[j]; };
  const Vector3d chin = at(Joint::kHead) - 0.06 * s * axes.up;
  const Vector3d crown = at(Joint::kHead) + 0.02 * s * axes.up;
  const Vector3d belly = 0.5 * (at(Joint::kHipCenter) + at(Joint::kSpine));
  std::vector<Capsule> capsules = {
      {crown, crown, 0.095 * s, 1, 2},
      {chin, chin, 0.08 * s, 3, 4},
      {at(Joint::kShoulderCenter), chin, 0.055 * s, 5, 5},
      {at(Joint::kShoulderCenter) - 0.08 * s * axes.up, at(Joint::kSpine), 0.13 * s, 18, 19},
      {at(Joint::kSpine), belly, 0.13 * s, 20, 21}};
  const auto pair = [&](Joint a, Joint b, double radius, int label) {
    const auto mirrored = [](Joint j) {
      return static_cast<Joint>(recon::kMirroredJoint[recon::Index(j)]);
    };
    const auto left = static_cast<uint8_t>(label), right = static_cast<uint8_t>(label + 1);
    capsules.push_back({at(a), at(b), radius * s, left, left});
    capsules.push_back({at(mirrored(a)), at(mirrored(b)), radius * s, right, right});
  };
  pair(Joint::kShoulderLeft, Joint::kHipLeft, 0.08, 18);
  pair(Joint::kShoulderLeft, Joint::kShoulderLeft, 0.075, 6);
  pair(Joint::kShoulderLeft, Joint::kElbowLeft, 0.05, 8);
  pair(Joint::kElbowLeft, Joint::kElbowLeft, 0.055, 12);
  pair(Joint::kElbowLeft, Joint::kWristLeft, 0.042, 10);
  pair(Joint::kWristLeft, Joint::kWristLeft, 0.045, 14);
  pair(Joint::kHandLeft, Joint::kHandLeft, 0.055, 16);
  pair(Joint::kHipLeft, Joint::kKneeLeft, 0.08, 22);
  pair(Joint::kKneeLeft, Joint::kKneeLeft, 0.075, 26);
  pair(Joint::kKneeLeft, Joint::kAnkleLeft, 0.055, 24);
  pair(Joint::kAnkleLeft, Joint::kAnkleLeft, 0.06, 28);
  pair(Joint::kAnkleLeft, Joint::kFootLeft, 0.045, 30);
  return capsules;
}

struct Canvas {
  CapsuleRender render;
  std::vector<double> z_m;

  void Offer(int u, int v, double z, uint8_t part, uint8_t person) {
    double& nearest = z_m[static_cast<size_t>(v) * static_cast<size_t>(render.part.width) +
                          static_cast<size_t>(u)];
    if (z >= nearest) return;
    nearest = z;
    render.part.at(u, v) = part;
    render.person.at(u, v) = person;
  }
};

Vector3d RayOf(const depth::Camera& camera, int u, int v) {
  return {(camera.cx - u) / camera.fx, (camera.cy - v) / camera.fy, 1.0};
}

void DrawCapsule(Canvas& canvas, const depth::Camera& camera, const Capsule& capsule,
                 const Vector3d& middle, const Vector3d& left, uint8_t person) {
  const double z_near =
      std::max(0.1, std::min(capsule.a_m.z(), capsule.b_m.z()) - capsule.radius_m);
  int low[2] = {camera.width, camera.height}, high[2] = {0, 0};
  for (const Vector3d& end : {capsule.a_m, capsule.b_m}) {
    const Eigen::Vector2d pixel =
        depth::Project(camera, {end.x(), end.y(), std::max(0.1, end.z())});
    const double reach = 1.5 * camera.fx * capsule.radius_m / z_near + 2;
    for (int i = 0; i < 2; ++i) {
      low[i] = std::min(low[i], static_cast<int>(std::clamp(pixel[i] - reach, 0.0, 1e5)));
      high[i] = std::max(high[i], static_cast<int>(std::clamp(pixel[i] + reach, -1.0, 1e5)));
    }
  }
  for (int v = low[1]; v <= std::min(high[1], camera.height - 1); ++v) {
    for (int u = low[0]; u <= std::min(high[0], camera.width - 1); ++u) {
      const Vector3d ray = RayOf(camera, u, v);
      const double z = HitCapsule(ray, capsule);
      if (z == kMiss) continue;
      const bool is_left = (z * ray - middle).dot(left) > 0;
      canvas.Offer(u, v, z, is_left ? capsule.left_label : capsule.right_label, person);
    }
  }
}

void DrawRoom(Canvas& canvas, const depth::Camera& camera, const CapsuleScene& scene) {
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const Vector3d ray = RayOf(camera, u, v);
      for (const Plane& plane : scene.planes) {
        const double slope = plane.normal.dot(ray);
        const double z = std::abs(slope) > 1e-9 ? -plane.offset_m / slope : -1.0;
        if (z > 0) canvas.Offer(u, v, z, 0, 0);
      }
      for (const Box& box : scene.boxes) canvas.Offer(u, v, HitBox(ray, box), 0, 0);
    }
  }
}

}  // namespace

recon::Posture ComputeJoints(const CapsulePose& pose) {
  const double h = pose.height_m;
  const auto [left, up, forward] = AxesOf(pose);
  recon::Posture p;
  p[Joint::kHipCenter] = pose.feet_m + 0.54 * h * up;
  p[Joint::kSpine] = pose.feet_m + 0.60 * h * up;
  p[Joint::kShoulderCenter] = pose.feet_m + 0.83 * h * up;
  p[Joint::kHead] = pose.feet_m + 0.93 * h * up;
  const auto side = [&, left = left, up = up, forward = forward](double sign, double lift,
                                                                 double bend, double swing,
                                                                 Joint first_arm, Joint first_leg) {
    const auto joint = [&](Joint j, int step) -> Vector3d& {
      return p[static_cast<Joint>(static_cast<int>(j) + step)];
    };
    const Vector3d out = sign * left;
    const Vector3d arm = std::sin(lift) * out - std::cos(lift) * up;
    const Vector3d forearm = std::cos(bend) * arm + std::sin(bend) * forward;
    joint(first_arm, 0) = pose.feet_m + 0.805 * h * up + 0.105 * h * out;
    joint(first_arm, 1) = joint(first_arm, 0) + 0.17 * h * arm;
    joint(first_arm, 2) = joint(first_arm, 1) + 0.145 * h * forearm;
    joint(first_arm, 3) = joint(first_arm, 2) + 0.05 * h * forearm;
    const Vector3d leg = std::sin(swing) * forward - std::cos(swing) * up;
    joint(first_leg, 0) = pose.feet_m + 0.52 * h * up + 0.055 * h * out;
    joint(first_leg, 1) = joint(first_leg, 0) + 0.24 * h * leg;
    joint(first_leg, 2) = joint(first_leg, 1) + 0.235 * h * leg;
    joint(first_leg, 3) = joint(first_leg, 2) + 0.07 * h * forward - 0.02 * h * up;
  };
  side(1, pose.left_lift_rad, pose.left_elbow_rad, pose.stride_rad, Joint::kShoulderLeft,
       Joint::kHipLeft);
  side(-1, pose.right_lift_rad, pose.right_elbow_rad, -pose.stride_rad, Joint::kShoulderRight,
       Joint::kHipRight);
  return p;
}

CapsuleRender Render(const CapsuleScene& scene, const depth::Camera& camera) {
  Canvas canvas;
  canvas.render.part = depth::Image<uint8_t>(camera.width, camera.height);
  canvas.render.person = depth::Image<uint8_t>(camera.width, camera.height);
  canvas.z_m.assign(canvas.render.part.data.size(), kMiss);
  DrawRoom(canvas, camera, scene);
  for (size_t i = 0; i < scene.people.size(); ++i) {
    canvas.render.joints.push_back(ComputeJoints(scene.people[i]));
    const Vector3d middle = canvas.render.joints.back()[Joint::kHipCenter];
    for (const Capsule& capsule : CapsulesOf(scene.people[i])) {
      DrawCapsule(canvas, camera, capsule, middle, AxesOf(scene.people[i]).left,
                  static_cast<uint8_t>(i + 1));
    }
  }
  for (const Capsule& capsule : scene.capsules)
    DrawCapsule(canvas, camera, capsule, capsule.a_m, Vector3d::UnitX(), 0);
  std::mt19937_64 random(scene.seed);
  std::normal_distribution<double> normal;
  depth::DepthFrame& frame = canvas.render.frame;
  frame.camera = camera;
  frame.depth_mm.resize(canvas.z_m.size());
  for (size_t i = 0; i < canvas.z_m.size(); ++i) {
    double z = canvas.z_m[i];
    if (z < 10 && scene.noise_m > 0) z += scene.noise_m * z * z * normal(random);
    frame.depth_mm[i] = z < 10 && z > 0 ? static_cast<uint16_t>(std::lround(1000 * z)) : 0;
  }
  return canvas.render;
}

std::vector<Plane> EmptyRoom() { return {{Vector3d::UnitY(), 1.0}, {Vector3d(0, 0, -1), 4.5}}; }

}  // namespace ossa::tests
