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

/// Reads the body model that tools/fetch_body downloads. Throws InputError if it is missing.
recon::BodyModel LoadFetchedBody();

/// Camera from world of a camera at `eye` (metres, y up) whose optical axis passes through
/// `target`. Camera space has x to the sensor's left, y up, z forward.
Eigen::Isometry3d LookAt(const Eigen::Vector3d& eye, const Eigen::Vector3d& target);

/// A clothed body that can be posed and rendered. Model and wardrobe must outlive it.
class ClothedBody {
 public:
  ClothedBody(const recon::BodyModel& model, const recon::Wardrobe& wardrobe,
              const recon::BodyShape& shape, const recon::Clothing& clothing);

  /// Adds the body in its rest pose as a mesh of the renderer.
  void AddTo(depth::Renderer& renderer);
  /// Skins the body into camera space, raised so that no vertex is below the floor (y = 0 of the
  /// world). Returns the 20 joints in camera space, metres.
  recon::Posture Pose(const recon::RigPose& pose, const Eigen::Isometry3d& camera_from_world);
  /// Copies the posed vertices to the renderer's mesh.
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

/// Fills `parts` and `users` of a frame. Pixels that show meshes[i], a body of the model, get the
/// user i + 1 and their part; all others get 0.
void LabelPeople(const depth::RenderedImage& seen, const depth::SensorImage& sensed,
                 const recon::BodyModel& model, std::span<const int> meshes, LabelledFrame* frame);

/// Renders the scene as a structured-light sensor measures it, with labels: pixels of bodies[i] get
/// the user i + 1 and their part. LabelledFrame::bodies stays empty.
LabelledFrame RenderBodies(depth::Renderer& renderer, const depth::Camera& camera,
                           const recon::BodyModel& model, std::span<const ClothedBody> bodies,
                           uint64_t noise_seed);

}  // namespace ossa::tools
