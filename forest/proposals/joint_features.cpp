// The features of an object for the refinement. Positions are relative to the object's root, in
// axes of which z is along the ray to it, so they do not depend on the person's position in the
// image. Lengths are metres and clipped: beyond that only "far" is informative.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "depth/base/cpu_dispatch.h"
#include "depth/base/lanes.h"
#include "forest/joint_features_internal.h"
#include "forest/proposals/refinement_internal.h"

namespace ossa::forest {
namespace {

// Constants: chosen by hand; part of every shipped model.

constexpr float kFar_m = 1.0F;          // clip: distance of modes and predictions from the position
constexpr double kBorderReach_m = 0.5;  // clip: distance of image borders
constexpr float kSurfaceReach_m = 0.6F;  // clip: distance of surface
constexpr float kNowhere_m = 1e4F;       // padding, beyond every clip

// The evidence's surface points in the frame, one array per coordinate, padded with far points.
struct Surface {
  std::vector<float> x, y, z;
  Eigen::Vector3f centre_m = Eigen::Vector3f::Zero();
  float area_m2 = 0.0F;

  void Add(const Eigen::Vector3f& p_m) {
    x.push_back(p_m.x());
    y.push_back(p_m.y());
    z.push_back(p_m.z());
  }
};

// The nearest surface point to a position: in 3D, and perpendicular to the line of sight.
struct Nearest {
  float square_m2 = kSurfaceReach_m * kSurfaceReach_m;
  float perpendicular_m2 = square_m2;
  float behind_m = 0.0F;  // depth behind the position, along the line of sight
};

// As Nearest, per lane.
struct NearestOfLanes {
  Lanes square_m2, perpendicular_m2, behind_m;
  IntLanes number;  // index of the nearest point perpendicular to the line of sight
};

OSSA_CPU_DISPATCH void FindNearest(const Surface& surface, const float* place, const float* ray,
                                   NearestOfLanes* out) {
  NearestOfLanes near = *out;
  for (size_t i = 0; i < surface.x.size(); i += kLanes) {
    Lanes x, y, z;
    LoadLanes(surface.x.data() + i, &x);
    LoadLanes(surface.y.data() + i, &y);
    LoadLanes(surface.z.data() + i, &z);
    x -= place[0];
    y -= place[1];
    z -= place[2];
    const Lanes along = x * ray[0] + (y * ray[1] + z * ray[2]);
    const Lanes square = x * x + (y * y + z * z);
    Lanes perpendicular = square - along * along;
    perpendicular = perpendicular > 0.0F ? perpendicular : Lanes{};
    near.square_m2 = square < near.square_m2 ? square : near.square_m2;
    const IntLanes nearer = perpendicular < near.perpendicular_m2;
    near.perpendicular_m2 = nearer ? perpendicular : near.perpendicular_m2;
    near.behind_m = nearer ? along : near.behind_m;
    near.number = nearer ? IntLanes{} + static_cast<int32_t>(i) : near.number;
  }
  *out = near;
}

// Ties are resolved by index, independent of the lane.
Nearest NearestTo(const Surface& surface, const Eigen::Vector3f& place_m,
                  const Eigen::Vector3f& ray) {
  Nearest nearest;
  NearestOfLanes lanes{Lanes{} + nearest.square_m2, Lanes{} + nearest.perpendicular_m2, Lanes{},
                       IntLanes{}};
  FindNearest(surface, place_m.data(), ray.data(), &lanes);
  int32_t number = 0;
  for (size_t l = 0; l < kLanes; ++l) {
    nearest.square_m2 = std::min(nearest.square_m2, lanes.square_m2[l]);
    if (lanes.perpendicular_m2[l] > nearest.perpendicular_m2) continue;
    if (lanes.perpendicular_m2[l] == nearest.perpendicular_m2 && lanes.number[l] >= number)
      continue;
    nearest.perpendicular_m2 = lanes.perpendicular_m2[l];
    nearest.behind_m = lanes.behind_m[l];
    number = lanes.number[l];
  }
  return nearest;
}

class FeatureBuilder {
 public:
  FeatureBuilder(const depth::Camera& camera, const Evidence& evidence,
                 const JointFeatures& features)
      : camera_(camera), evidence_(evidence), features_(features) {
    for (size_t i = 0; i < evidence.count; ++i) {
      const Eigen::Vector3f p_m = InFrame(evidence.surface_m(i).cast<double>());
      surface_.Add(p_m);
      surface_.centre_m += evidence.area_m2[i] * p_m;
      surface_.area_m2 += evidence.area_m2[i];
    }
    if (surface_.area_m2 > 0) surface_.centre_m /= surface_.area_m2;
    while (surface_.x.size() % kLanes != 0) surface_.Add(Eigen::Vector3f::Constant(kNowhere_m));
  }

  void AddObject(std::span<const float> context_posterior, const PoseMarginals& marginals) {
    value_.insert(value_.end(), context_posterior.begin(), context_posterior.end());
    Add(surface_.area_m2);
    Add(surface_.centre_m);
    Add(static_cast<float>(marginals.margin));
    Add(static_cast<float>(marginals.mean_confidence));
    Add(static_cast<float>(marginals.mean_support));
    Add(static_cast<float>(features_.frame.middle_m.norm()));
    Add(static_cast<float>(features_.frame.middle_m.x() / features_.frame.middle_m.z()));
    Add(static_cast<float>(features_.frame.middle_m.y() / features_.frame.middle_m.z()));
  }

  void AddTarget(size_t t, const PoseMarginals& marginals) {
    const TargetMarginal& marginal = marginals.target[t];
    Add(InFrame(features_.place_m[t]));
    Add(FromPlace(t, marginal.predicted_m));
    Add(static_cast<float>(0.5 * std::log(marginal.covariance_m2.trace() / 3.0)));
    Add(static_cast<float>(marginal.support()));
    Add(static_cast<float>(marginals.neighbour_support[t]));
    AddBorders(features_.place_m[t]);
    AddNearestSurface(InFrame(features_.place_m[t]));
  }

  void AddModes(size_t t, const ProposalTarget& target, const std::vector<Mode>& modes,
                const TargetMarginal& marginal) {
    for (size_t m = 0; m < kModes; ++m) {
      if (m >= modes.size()) {
        value_.insert(value_.end(), kNumbersOfMode, 0.0F);
        continue;
      }
      Add(FromPlace(t, modes[m].position_m.cast<double>()));
      Add(static_cast<float>(marginal.confidence[m]));
      Add(static_cast<float>(marginal.weight[m]));
      Add(static_cast<float>(Evaluate(target.visible, modes[m].feature)));
      Add(modes[m].feature[0]);  // contribution of the target's classes
      Add(modes[m].feature[1]);  // contribution of votes
    }
  }

  // Area, position and spread of each class.
  void AddClasses() {
    for (size_t c = 1; c < static_cast<size_t>(evidence_.class_count); ++c) AddClass(c);
  }

  Eigen::RowVectorXf values() const {
    return Eigen::Map<const Eigen::RowVectorXf>(value_.data(),
                                                static_cast<Eigen::Index>(value_.size()));
  }

 private:
  Eigen::Vector3f InFrame(const Eigen::Vector3d& p_m) const {
    return (features_.frame.frame_from_camera * (p_m - features_.frame.middle_m)).cast<float>();
  }
  Eigen::Vector3f FromPlace(size_t t, const Eigen::Vector3d& p_m) const {
    const Eigen::Vector3d offset = features_.frame.frame_from_camera * (p_m - features_.place_m[t]);
    return offset.cast<float>().cwiseMax(-kFar_m).cwiseMin(kFar_m);
  }
  void Add(float value) { value_.push_back(value); }
  void Add(const Eigen::Vector3f& v) { value_.insert(value_.end(), v.data(), v.data() + 3); }

  void AddClass(size_t c) {
    constexpr float kLeastProbability = 0.01F;  // probability
    constexpr float kLeastArea_m2 = 1e-4F;
    const float* probability = evidence_.probability_of(c);
    picked_.resize(evidence_.count);
    picked_.resize(PickAtLeast(kLeastProbability, probability, evidence_.count, picked_.data()));
    float area_m2 = 0.0F;
    Eigen::Array3f sum = Eigen::Array3f::Zero();
    Eigen::Array3f square = Eigen::Array3f::Zero();
    for (const uint32_t i : picked_) {
      const float weight = probability[i] * evidence_.area_m2[i];
      const Eigen::Array3f x(surface_.x[i], surface_.y[i], surface_.z[i]);
      area_m2 += weight;
      sum += weight * x;
      square += weight * x * x;
    }
    const float whole = std::max(area_m2, kLeastArea_m2);
    const Eigen::Array3f mean = sum / whole;
    Add(std::sqrt(area_m2));
    Add(Eigen::Vector3f(mean));
    Add(Eigen::Vector3f((square / whole - mean * mean).max(0.0F).sqrt()));
  }

  // Distance of a position from the nearer side border, and from the upper and lower border.
  void AddBorders(const Eigen::Vector3d& place_m) {
    const double z_m = std::max(place_m.z(), 0.1);
    const double u = camera_.cx - camera_.fx * place_m.x() / z_m;
    const double v = camera_.cy - camera_.fy * place_m.y() / z_m;
    const double metres = z_m / camera_.fx;
    for (const double pixels : {std::min(u, camera_.width - 1 - u), v, camera_.height - 1 - v}) {
      Add(static_cast<float>(std::clamp(pixels * metres, -kBorderReach_m, kBorderReach_m)));
    }
  }

  // Distance to the nearest surface in 3D; distance perpendicular to the line of sight, and depth
  // of the surface behind the position there: in front, something occludes the position; far
  // behind, it is free space.
  void AddNearestSurface(const Eigen::Vector3f& place_m) {
    const Eigen::Vector3f ray = (place_m + RootFromCamera()).normalized();
    const Nearest nearest = NearestTo(surface_, place_m, ray);
    Add(std::sqrt(nearest.square_m2));
    Add(std::sqrt(nearest.perpendicular_m2));
    Add(std::clamp(nearest.behind_m, -kSurfaceReach_m, kSurfaceReach_m));
  }

  // The camera's origin in frame axes.
  Eigen::Vector3f RootFromCamera() const {
    return {0.0F, 0.0F, static_cast<float>(features_.frame.middle_m.norm())};
  }

  const depth::Camera& camera_;
  const Evidence& evidence_;
  const JointFeatures& features_;
  std::vector<float> value_;
  Surface surface_;
  std::vector<uint32_t> picked_;  // samples of the current class
};

// The frame at the mean of the positions, weighted by their support.
ViewFrame PlaceFrame(const std::vector<Eigen::Vector3d>& places_m, const PoseMarginals& marginals) {
  constexpr double kLeastSupport = 0.05;  // by hand; part of every shipped model; share
  std::vector<double> weights;
  for (const TargetMarginal& target : marginals.target) weights.push_back(target.support());
  const Eigen::Vector3d middle_m = ComputeMiddle(places_m, weights, kLeastSupport);
  return MakeViewFrame(middle_m).value_or(ViewFrame{Eigen::Matrix3d::Identity(), middle_m});
}

}  // namespace

JointFeatures ComputeJointFeatures(const ForestModel& model, const depth::Camera& camera,
                                   const Evidence& evidence,
                                   std::span<const float> context_posterior,
                                   const TargetModes& modes, const PoseMarginals& marginals) {
  JointFeatures features;
  for (size_t t = 0; t < modes.size(); ++t) {
    features.place_m.push_back(
        Fuse(marginals.target[t], modes[t], model.targets()[t].mode_noise_m));
  }
  features.frame = PlaceFrame(features.place_m, marginals);
  FeatureBuilder builder(camera, evidence, features);
  builder.AddObject(context_posterior, marginals);
  for (size_t t = 0; t < modes.size(); ++t) {
    builder.AddTarget(t, marginals);
    builder.AddModes(t, model.targets()[t], modes[t], marginals.target[t]);
  }
  builder.AddClasses();
  features.value = builder.values();
  return features;
}

}  // namespace ossa::forest
