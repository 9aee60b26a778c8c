// Tracked frames as dicts of arrays.
#include "tools/python/native/body_frames.h"

#include <pybind11/stl.h>

#include <limits>
#include <optional>
#include <utility>

#include "tools/python/native/arrays.h"

namespace ossa::python {
namespace {

using tracker::Body;

// float64 [n, 5]: x y z, confidence, seen.
py::array_t<double> ToArray(const std::vector<tracker::JointProposal>& proposals) {
  std::vector<double> values;
  for (const tracker::JointProposal& p : proposals) {
    values.insert(values.end(), p.position_m.begin(), p.position_m.end());
    values.insert(values.end(), {p.confidence, p.seen ? 1.0 : 0.0});
  }
  return python::ToArray(std::move(values), {static_cast<py::ssize_t>(proposals.size()), 5});
}

py::object ToArray(const std::optional<recon::BoneLengths>& bones_m) {
  return bones_m ? py::object(python::ToArray(*bones_m)) : py::none();
}

recon::JointArray<double> ConfidenceOf(const Body& body) {
  recon::JointArray<double> confidence;
  for (size_t j = 0; j < confidence.size(); ++j) confidence[j] = body.joints[j].confidence;
  return confidence;
}

py::dict ToDict(const recon::SurfaceFit& fit, const MeshPointer& mesh) {
  constexpr py::ssize_t kSegments = recon::kSegmentCount;
  std::vector<double> turns, residuals_m;
  for (const Eigen::Quaterniond& q : fit.camera_from_segment) {
    turns.insert(turns.end(), {q.w(), q.x(), q.y(), q.z()});
  }
  for (const auto& residual_m : fit.residual_m) {
    residuals_m.push_back(residual_m.value_or(std::numeric_limits<double>::quiet_NaN()));
  }
  const auto& shape = fit.pose.shape;
  py::dict made;
  made["joints"] = python::ToArray(fit.joints_m);
  made["shape"] =
      python::ToArray(std::vector<double>(shape.begin(), shape.end()), {recon::kShapeCount});
  made["stature_m"] = fit.stature_m;
  std::vector<double> covariance_m2;
  for (const Eigen::Matrix3d& of_joint : fit.covariance_m2) {
    covariance_m2.insert(covariance_m2.end(), of_joint.data(), of_joint.data() + of_joint.size());
  }
  made["covariance_m2"] = python::ToArray(std::move(covariance_m2),
                                          {static_cast<py::ssize_t>(recon::kJointCount), 3, 3});
  made["explained"] = fit.explained;
  made["score"] = fit.score;
  made["median_residual_m"] = fit.median_residual_m;
  made["residuals_m"] = python::ToArray(std::move(residuals_m), {kSegments});
  made["orientations"] = python::ToArray(std::move(turns), {kSegments, 4});
  made["_skin"] = Skin{mesh, fit.pose};
  return made;
}

// The fields of a tracked body besides joints and id.
void AddSkeleton(const Body& body, bool with_proposals, py::dict& made) {
  recon::JointArray<recon::TrackingState> states;
  recon::JointArray<double> reliability;
  recon::JointOrientations orientations;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    states[j] = body.joints[j].state;
    reliability[j] = body.joints[j].reliability;
    orientations[j] = body.joints[j].orientation;
  }
  made["joints"] = python::ToArray(tracker::ToPosture(body));
  made["states"] = python::ToArray(states);
  made["confidence"] = python::ToArray(ConfidenceOf(body));
  made["reliability"] = python::ToArray(reliability);
  made["orientations"] = python::ToArray(orientations);
  made["hierarchical_orientations"] =
      python::ToArray(tracker::ComputeHierarchicalOrientations(body));
  made["raw"] = python::ToArray(body.raw.posture);
  made["refined"] = body.refined ? py::object(python::ToArray(*body.refined)) : py::none();
  made["reconstructed"] = python::ToArray(body.reconstructed);
  made["bones_m"] = ToArray(body.bones_m);
  if (!with_proposals) return;
  py::list proposals;
  for (const auto& of_joint : body.proposals) proposals.append(ToArray(of_joint));
  made["proposals"] = proposals;
}

py::dict ToDict(const Body& body, bool with_proposals, const MeshPointer& mesh) {
  py::dict made;
  made["id"] = body.id;
  made["tracked"] = body.state == tracker::BodyState::kTracked;
  made["position"] =
      python::ToArray(std::vector<double>(body.position_m.begin(), body.position_m.end()), {3});
  made["clipped_edges"] = body.clipped_edges;
  made["person_score"] = body.person_score;
  if (body.state == tracker::BodyState::kTracked) AddSkeleton(body, with_proposals, made);
  if (body.fit && mesh) made["fit"] = ToDict(*body.fit, mesh);
  return made;
}

py::object ToArray(depth::Image<uint8_t> image) {
  if (image.data.empty()) return py::none();
  return python::ToArray(std::move(image.data), {image.height, image.width});
}

py::dict ToDict(const tracker::StageTimes& ms) {
  py::dict made;
  made["segment"] = ms.segment;
  made["classify"] = ms.classify;
  made["propose"] = ms.propose;
  made["reconstruct"] = ms.reconstruct;
  made["physics"] = ms.physics;
  made["fit"] = ms.fit;
  made["total"] = ms.total;
  return made;
}

py::dict ToDict(const tracker::SceneObjectState& object) {
  py::dict made;
  const auto array = [](const Eigen::Vector3d& v) {
    return python::ToArray(std::vector<double>(v.begin(), v.end()), {3});
  };
  const Eigen::Quaterniond& q = object.orientation;
  made["name"] = object.name;
  made["position"] = array(object.position_m);
  made["orientation"] = python::ToArray(std::vector<double>{q.w(), q.x(), q.y(), q.z()}, {4});
  made["velocity_m_s"] = array(object.velocity_m_s);
  made["held_by"] = py::tuple(py::cast(object.held_by));
  return made;
}

}  // namespace

py::array ComputeVertices(const Skin& skin) {
  std::vector<double> vertices_m;
  for (const Eigen::Vector3d& place_m : recon::PoseMesh(*skin.mesh, skin.pose)) {
    vertices_m.insert(vertices_m.end(), place_m.begin(), place_m.end());
  }
  const auto count = static_cast<py::ssize_t>(vertices_m.size() / 3);
  return python::ToArray(std::move(vertices_m), {count, 3});
}

py::array ToArray(const std::vector<recon::MeshTriangle>& triangles) {
  std::vector<int32_t> corners;
  for (const recon::MeshTriangle& triangle : triangles) {
    for (const uint32_t corner : triangle) corners.push_back(static_cast<int32_t>(corner));
  }
  return python::ToArray(std::move(corners), {static_cast<py::ssize_t>(triangles.size()), 3});
}

py::dict ToDict(tracker::BodyFrame frame, bool with_proposals, const MeshPointer& mesh) {
  py::dict made;
  py::list bodies, objects;
  for (const auto& object : frame.objects) objects.append(ToDict(object));
  made["objects"] = objects;
  for (const Body& body : frame.bodies) bodies.append(ToDict(body, with_proposals, mesh));
  made["index"] = frame.index;
  made["time_s"] = frame.time_s;
  made["bodies"] = bodies;
  made["users"] = ToArray(std::move(frame.users));
  made["parts"] = ToArray(std::move(frame.parts));
  tracker::PartProbabilities& p = frame.probabilities;
  made["probabilities"] = p.data.empty()
                              ? py::object(py::none())
                              : python::ToArray(std::move(p.data), {p.height, p.width, p.classes});
  made["floor"] = frame.floor
                      ? py::object(python::ToArray(
                            std::vector<double>(frame.floor->begin(), frame.floor->end()), {4}))
                      : py::none();
  made["tilt_down_rad"] = frame.tilt_down_rad;
  made["ms"] = ToDict(frame.ms);
  return made;
}

}  // namespace ossa::python
