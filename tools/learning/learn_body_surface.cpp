#include "tools/learning/learn_body_surface.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <stdexcept>

#include "depth/base/random.h"
#include "recon/body/clothing.h"
#include "recon/body/standard_body.h"
#include "recon/fit/posed_surface.h"
#include "recon/motion/humanoid.h"
#include "tools/learning/simplify_skin.h"
#include "tools/synth/sample_person.h"

namespace ossa::tools {
namespace {

using namespace recon;

// Constants: by the rig (recon/body/rig.h) unless stated otherwise.

// The segment of each bone of the rig.
constexpr std::array<uint8_t, kRigBoneCount> kSegmentOfBone = {
    0, 0, 12, 13, 14, 14, 0, 15, 16, 17, 17, 1,  2,  2,  3, 3,
    3, 4, 5,  6,  7,  7,  7, 7,  8,  9,  10, 11, 11, 11, 11};
// The bone at whose head each segment's joint is, and the bone that turns as the segment does.
constexpr std::array<size_t, kSegmentCount> kJointBone = {0,  11, 12, 14, 17, 18, 19, 20, 24,
                                                          25, 26, 27, 2,  3,  4,  7,  8,  9};
constexpr std::array<size_t, kSegmentCount> kTurnBone = {0,  11, 13, 16, 17, 18, 19, 20, 24,
                                                         25, 26, 27, 2,  3,  4,  7,  8,  9};
// The bone of a humanoid (kHumanBones) that each bone of the rig belongs to.
constexpr std::array<uint8_t, kRigBoneCount> kHumanBoneOfBone = {
    0, 0, 13, 14, 15, 16, 0, 17, 18, 19, 20, 1,  2,  2,  3, 3,
    4, 5, 6,  7,  8,  8,  8, 8,  9,  10, 11, 12, 12, 12, 12};
// By hand, radians: people turn their joints a little more than those who were recorded.
constexpr double kMoreTurn_rad = 0.1;
// By hand, a factor: joints have more weight than points in the shape components.
constexpr double kJointShare = 3.0;

// Vertices of the skin, each as far as can be from those before it.
std::vector<size_t> SelectSpreadVertices(const BodyModel& model, size_t count) {
  std::vector<size_t> skin;
  for (size_t v = 0; v < model.vertex_count(); ++v) {
    if (model.vertex_layer()[v] == BodyLayer::kSkin) skin.push_back(v);
  }
  const ShapedBody body = model.Shape({});
  std::vector<float> away(skin.size(), std::numeric_limits<float>::max());
  std::vector<size_t> chosen;
  size_t next = 0;
  while (chosen.size() < std::min(count, skin.size())) {
    chosen.push_back(skin[next]);
    const Eigen::Vector3f from = body.rest_m[skin[next]];
    for (size_t i = 0; i < skin.size(); ++i) {
      away[i] = std::min(away[i], (body.rest_m[skin[i]] - from).squaredNorm());
    }
    next = static_cast<size_t>(std::max_element(away.begin(), away.end()) - away.begin());
  }
  std::stable_sort(chosen.begin(), chosen.end(), [&](size_t a, size_t b) {
    return model.vertex_part()[a] < model.vertex_part()[b];
  });
  return chosen;
}

// The bones of a humanoid that carry a vertex, each once.
MeshVertex FindCarriers(const BodyModel::Influence& influence) {
  MeshVertex vertex;
  size_t count = 0;
  for (size_t k = 0; k < influence.bone.size(); ++k) {
    if (influence.weight[k] == 0.0F) continue;
    const uint8_t bone = kHumanBoneOfBone[influence.bone[k]];
    const auto end = vertex.bone.begin() + static_cast<ptrdiff_t>(count);
    const auto known = std::find(vertex.bone.begin(), end, bone);
    const auto place = static_cast<size_t>(known - vertex.bone.begin());
    vertex.bone[place] = bone;
    vertex.weight[place] += influence.weight[k];
    count += known == end;
  }
  return vertex;
}

// All that shape moves, as one vector a person: points, joints, landmarks, stature. The mesh's
// vertices are moved along.
class ShapeSamples {
 public:
  ShapeSamples(const BodyModel& model, std::vector<size_t> vertices, const BodySurfaceOptions& o,
               std::vector<size_t> mesh_vertices)
      : model_(model),
        vertices_(std::move(vertices)),
        mesh_vertices_(std::move(mesh_vertices)),
        normals_(vertices_.size()) {
    for (Eigen::Vector3d& normal : normals_) normal.setZero();
    const auto rows = static_cast<Eigen::Index>(3 * places() + 1);
    values_.resize(rows, static_cast<Eigen::Index>(o.people));
    mesh_values_.resize(static_cast<Eigen::Index>(3 * mesh_vertices_.size()), values_.cols());
    const Wardrobe wardrobe(model);
    for (size_t k = 0; k < o.people; ++k) {
      Random random(o.seed, k);
      const ShapedBody body = model.Shape(SampleShape(Split::kTrain, random));
      Add(body, wardrobe.Dress(body, SampleClothing(random)), static_cast<Eigen::Index>(k));
      if (o.progress) o.progress(k + 1);
    }
  }
  void Learn(BodyMesh& body);

 private:
  size_t places() const { return vertices_.size() + kSegmentCount + kJointCount; }
  size_t SegmentOf(size_t vertex) const { return kSegmentOfBone[model_.MainBone(vertex)]; }
  void Add(const ShapedBody& body, const std::vector<Eigen::Vector3f>& rest_m, Eigen::Index person);
  Eigen::MatrixXd Components();
  void LearnVertices(std::vector<MeshVertex>& vertices);

  const BodyModel& model_;
  std::vector<size_t> vertices_, mesh_vertices_;
  std::vector<Eigen::Vector3d> normals_;
  Eigen::MatrixXd values_, mesh_values_;  // a column a person, metres
  Eigen::MatrixXd votes_;  // a column a component: how much of it is each person's deviation
};

void ShapeSamples::Add(const ShapedBody& body, const std::vector<Eigen::Vector3f>& rest_m,
                       Eigen::Index person) {
  const auto joint = [&](size_t s) -> const Eigen::Vector3d& {
    return body.bone_head_m[kJointBone[s]];
  };
  Eigen::Index row = 0;
  const auto put = [&](const Eigen::Vector3d& place_m) {
    values_.block<3, 1>(row, person) = place_m;
    row += 3;
  };
  for (size_t i = 0; i < vertices_.size(); ++i) {
    put(rest_m[vertices_[i]].cast<double>() - joint(SegmentOf(vertices_[i])));
    normals_[i] += body.normals[vertices_[i]].cast<double>();
  }
  for (size_t s = 0; s < kSegmentCount; ++s) put(joint(s) - joint(ParentSegment(s)));
  const auto& anchors = StandardJointAnchors();
  for (size_t j = 0; j < kJointCount; ++j) {
    put(body.joint_m[j] - joint(kSegmentOfBone[anchors[j].bone]));
  }
  values_(row, person) = body.height_m;
  for (size_t i = 0; i < mesh_vertices_.size(); ++i) {
    mesh_values_.block<3, 1>(FirstCoordinate(i), person) =
        rest_m[mesh_vertices_[i]].cast<double>() - joint(0);
  }
}

// Principal components by the people's Gram matrix, each times its standard deviation; with the
// larger share of stature growing, so that they are the same every time. Values become deviations.
Eigen::MatrixXd ShapeSamples::Components() {
  const auto people = static_cast<double>(values_.cols());
  Eigen::VectorXd weight = Eigen::VectorXd::Ones(values_.rows());
  weight.tail(static_cast<Eigen::Index>(3 * (kSegmentCount + kJointCount) + 1))
      .setConstant(kJointShare);
  const Eigen::MatrixXd weighted = weight.asDiagonal() * values_;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(weighted.transpose() * weighted);
  Eigen::MatrixXd components(values_.rows(), kShapeCount);
  votes_ = solver.eigenvectors().rightCols(kShapeCount).rowwise().reverse() / std::sqrt(people);
  for (Eigen::Index c = 0; c < kShapeCount; ++c) {
    components.col(c) =
        values_ * solver.eigenvectors().col(values_.cols() - 1 - c) / std::sqrt(people);
    if (components(values_.rows() - 1, c) < 0.0) {
      components.col(c) *= -1.0;
      votes_.col(c) *= -1.0;
    }
  }
  return components;
}

// By Components()' votes.
void ShapeSamples::LearnVertices(std::vector<MeshVertex>& vertices) {
  const Eigen::VectorXd mean = mesh_values_.rowwise().mean();
  const Eigen::MatrixXd components = (mesh_values_.colwise() - mean) * votes_;
  for (size_t i = 0; i < mesh_vertices_.size(); ++i) {
    MeshVertex vertex = FindCarriers(model_.InfluenceOn(mesh_vertices_[i]));
    vertex.place.mean_m = mean.segment<3>(FirstCoordinate(i));
    vertex.place.by_shape_m = components.middleRows<3>(FirstCoordinate(i));
    vertices.push_back(vertex);
  }
}

void ShapeSamples::Learn(BodyMesh& body) {
  BodySurface& surface = body.surface;
  const Eigen::VectorXd mean = values_.rowwise().mean();
  values_.colwise() -= mean;
  const Eigen::MatrixXd components = Components();
  Eigen::Index row = 0;
  const auto take = [&] {
    ShapedPlace place;
    place.mean_m = mean.segment<3>(row);
    place.by_shape_m = components.middleRows<3>(row);
    row += 3;
    return place;
  };
  for (size_t i = 0; i < vertices_.size(); ++i) {
    surface.points.push_back({static_cast<uint8_t>(SegmentOf(vertices_[i])),
                              model_.vertex_part()[vertices_[i]], take(),
                              normals_[i].normalized()});
  }
  for (ShapedPlace& joint : surface.joint) joint = take();
  for (size_t j = 0; j < kJointCount; ++j) {
    surface.landmark_segment[j] = kSegmentOfBone[StandardJointAnchors()[j].bone];
    surface.landmark[j] = take();
  }
  surface.stature_mean_m = mean[row];
  surface.stature_by_shape_m = components.row(row).transpose();
  LearnVertices(body.vertices);
}

void LearnTurns(const std::vector<MotionClip>& motion, size_t step, BodySurface& surface) {
  std::array<Eigen::Vector3d, kSegmentCount> sum;
  std::array<Eigen::Matrix3d, kSegmentCount> squares;
  sum.fill(Eigen::Vector3d::Zero());
  squares.fill(Eigen::Matrix3d::Zero());
  double count = 0.0;
  for (const MotionClip& clip : motion) {
    for (size_t f = 0; f < clip.frames.size(); f += step, ++count) {
      const auto& turned = clip.frames[f].world_from_rest;
      for (size_t s = 1; s < kSegmentCount; ++s) {
        const Eigen::Quaterniond turn =
            turned[kTurnBone[ParentSegment(s)]].conjugate() * turned[kTurnBone[s]];
        const Eigen::Vector3d vector = ToRotationVector(turn.normalized().toRotationMatrix());
        sum[s] += vector;
        squares[s] += vector * vector.transpose();
      }
    }
  }
  if (count == 0.0) throw std::invalid_argument("LearnBodySurface: expected motion, found none");
  for (size_t s = 0; s < kSegmentCount; ++s) {
    surface.turn_mean[s] = sum[s] / count;
    const Eigen::Matrix3d covariance = squares[s] / count -
                                       surface.turn_mean[s] * surface.turn_mean[s].transpose() +
                                       kMoreTurn_rad * kMoreTurn_rad * Eigen::Matrix3d::Identity();
    surface.turn_information[s] = covariance.inverse();
  }
}

}  // namespace

recon::BodyMesh LearnBody(const recon::BodyModel& model,
                          const std::vector<recon::MotionClip>& motion, bool with_mesh,
                          const BodySurfaceOptions& options) {
  if (options.points < 1 || options.points > BodySurface::kMostPoints ||
      options.people < kShapeCount || options.frame_step < 1) {
    throw std::invalid_argument("BodySurfaceOptions: out of range");
  }
  SimplifiedSkin skin;
  if (with_mesh) skin = SimplifySkin(model, options.triangles);
  BodyMesh body;
  body.triangles = skin.triangles;
  ShapeSamples(model, SelectSpreadVertices(model, options.points), options, skin.vertices)
      .Learn(body);
  LearnTurns(motion, options.frame_step, body.surface);
  return body;
}

}  // namespace ossa::tools
