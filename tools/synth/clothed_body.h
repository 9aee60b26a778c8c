#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "depth/render/renderer.h"
#include "depth/render/structured_light.h"
#include "recon/body/body_model.h"
#include "recon/body/clothing.h"
#include "tools/synth/dataset.h"

namespace ossa::tools {

/// The body that tools/fetch_body fetched. Throws InputError when it was not.
recon::BodyModel LoadFetchedBody();

/// Camera space has x to the sensor's left, y up, z forward.
Eigen::Isometry3d LookAt(const Eigen::Vector3d& eye, const Eigen::Vector3d& target);

/// One clothed body before a virtual sensor. Model and wardrobe must outlive it.
class ClothedBody {
 public:
  ClothedBody(const recon::BodyModel& model, const recon::Wardrobe& wardrobe,
              const recon::BodyShape& shape, const recon::Clothing& clothing);

  /// Makes it one of the renderer's meshes.
  void AddTo(depth::Renderer& renderer);
  /// Skins into camera space, feet not below the floor at y = 0 of the world; returns the joints
  /// there.
  recon::Posture Pose(const recon::RigPose& pose, const Eigen::Isometry3d& camera_from_world);
  /// Gives the renderer the posture taken last.
  void UpdateMesh(depth::Renderer& renderer) const;

  int mesh() const { return mesh_; }
  const recon::ShapedBody& shape() const { return body_; }

 private:
  const recon::BodyModel* model_;
  const recon::Wardrobe* wardrobe_;
  recon::ShapedBody body_;
  recon::Clothing clothing_;
  std::vector<Eigen::Vector3f> rest_m_, posed_m_;
  int mesh_ = -1;
};

/// Fills in parts and users of a frame of this camera: pixels that sense meshes[i], a body of the
/// model, carry the user i + 1 and their part, all others 0.
void LabelPeople(const depth::RenderedImage& seen, const depth::SensorImage& sensed,
                 const recon::BodyModel& model, std::span<const int> meshes, LabelledFrame* frame);

/// What a structured-light sensor measures of the renderer's scene, labelled: pixels of body i
/// carry the user i + 1 and their part. Bodies are left to the caller.
LabelledFrame RenderBodies(depth::Renderer& renderer, const depth::Camera& camera,
                           const recon::BodyModel& model, std::span<const ClothedBody> bodies,
                           uint64_t noise_seed);

}  // namespace ossa::tools
