#include "tools/synth/clothed_body.h"

#include <algorithm>
#include <limits>

#include "depth/base/error.h"

namespace ossa::tools {

recon::BodyModel LoadFetchedBody() {
  const auto folder = recon::BodyFolder();
  if (!recon::BodyIsFetched(folder))
    throw InputError(folder.string() + ": expected the body model: run tools/fetch_body");
  return recon::BodyModel::Load(folder);
}

Eigen::Isometry3d LookAt(const Eigen::Vector3d& eye, const Eigen::Vector3d& target) {
  const Eigen::Vector3d forward = (target - eye).normalized();
  const Eigen::Vector3d left = Eigen::Vector3d::UnitY().cross(forward).normalized();
  Eigen::Matrix3d rotation;
  rotation << left.transpose(), forward.cross(left).transpose(), forward.transpose();
  Eigen::Isometry3d camera_from_world = Eigen::Isometry3d::Identity();
  camera_from_world.linear() = rotation;
  camera_from_world.translation() = -(rotation * eye);
  return camera_from_world;
}

ClothedBody::ClothedBody(const recon::BodyModel& model, const recon::Wardrobe& wardrobe,
                         const recon::BodyShape& shape, const recon::Clothing& clothing)
    : model_(&model),
      wardrobe_(&wardrobe),
      body_(model.Shape(shape)),
      clothing_(clothing),
      rest_m_(wardrobe.Dress(body_, clothing)),
      posed_m_(model.vertex_count()) {}

void ClothedBody::AddTo(depth::Renderer& renderer) {
  mesh_ = renderer.AddMesh({rest_m_, model_->triangles()}, true);
}

recon::Posture ClothedBody::Pose(const recon::RigPose& pose,
                                 const Eigen::Isometry3d& camera_from_world) {
  model_->Skin(body_, rest_m_, pose, camera_from_world, posed_m_);
  recon::Posture joints = recon::ComputeJoints(body_, pose);
  for (auto& joint_m : joints.position_m) joint_m = camera_from_world * joint_m;
  wardrobe_->HideUnworn(clothing_, joints[recon::Joint::kHipCenter].cast<float>(), posed_m_);
  const Eigen::Isometry3d world_from_camera = camera_from_world.inverse();
  const Eigen::Vector3f up = world_from_camera.linear().row(1).transpose().cast<float>();
  float lowest_m = std::numeric_limits<float>::max();
  for (const auto& p : posed_m_) lowest_m = std::min(lowest_m, up.dot(p));
  lowest_m += static_cast<float>(world_from_camera.translation().y());
  if (lowest_m < 0) {
    for (auto& p : posed_m_) p -= lowest_m * up;
    for (auto& joint_m : joints.position_m) joint_m -= (lowest_m * up).cast<double>();
  }
  return joints;
}

void ClothedBody::UpdateMesh(depth::Renderer& renderer) const {
  renderer.UpdateVertices(mesh_, posed_m_);
}

void LabelPeople(const depth::RenderedImage& seen, const depth::SensorImage& sensed,
                 const recon::BodyModel& model, std::span<const int> meshes, LabelledFrame* frame) {
  const depth::Camera& camera = frame->depth.camera;
  frame->parts = depth::Image<uint8_t>(camera.width, camera.height);
  frame->users = depth::Image<uint8_t>(camera.width, camera.height);
  for (size_t i = 0; i < sensed.source.data.size(); ++i) {
    if (sensed.source.data[i] < 0) continue;
    const auto source = static_cast<size_t>(sensed.source.data[i]);
    const auto person = std::find(meshes.begin(), meshes.end(), seen.mesh.data[source]);
    if (person == meshes.end()) continue;
    frame->parts.data[i] = model.triangle_part()[static_cast<size_t>(seen.triangle.data[source])];
    frame->users.data[i] = static_cast<uint8_t>(person - meshes.begin() + 1);
  }
}

LabelledFrame RenderBodies(depth::Renderer& renderer, const depth::Camera& camera,
                           const recon::BodyModel& model, std::span<const ClothedBody> bodies,
                           uint64_t noise_seed) {
  const depth::RenderedImage seen = renderer.Render(camera, {.projector = true});
  depth::SensorImage sensed = depth::SimulateStructuredLight(seen, camera, {}, noise_seed);
  std::vector<int> meshes;
  for (const ClothedBody& body : bodies) meshes.push_back(body.mesh());
  LabelledFrame frame;
  frame.depth.camera = camera;
  LabelPeople(seen, sensed, model, meshes, &frame);
  frame.depth.depth_mm = std::move(sensed.depth_mm.data);
  return frame;
}

}  // namespace ossa::tools
