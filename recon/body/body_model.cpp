#include "recon/body/body_model.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

#include "depth/base/error.h"
#include "recon/body/body_build_internal.h"
#include "recon/body/standard_body.h"

namespace ossa::recon {
namespace {

namespace fs = std::filesystem;

constexpr double kMetresPerDecimetre = 0.1;
// Constants: by the format of MPFB's rig and shape targets; finger rotations by eye.

constexpr float kDeltaUnit_dm = 1e-3f;  // decimetres a unit

/// One macro parameter's contribution to a target: the word in the target's name and its weight.
struct Term {
  const char* word;
  double weight;
};
using Factor = std::vector<Term>;

Factor WithoutZeros(Factor factor) {
  std::erase_if(factor, [](const Term& term) { return term.weight <= 0.0; });
  return factor;
}

Factor Gender(double male) { return WithoutZeros({{"female", 1.0 - male}, {"male", male}}); }

Factor Age(double age) {
  constexpr double kChild = 0.1875, kYoung = 0.5, kOld = 1.0;  // no unit: MPFB's scale of age
  const double old = std::clamp((age - kYoung) / (kOld - kYoung), 0.0, 1.0);
  const double child = std::clamp((kYoung - age) / (kYoung - kChild), 0.0, 1.0);
  return WithoutZeros({{"child", child}, {"young", 1.0 - old - child}, {"old", old}});
}

Factor ThreeLevels(double value, const char* low, const char* middle, const char* high) {
  const double above = std::max(0.0, 2.0 * value - 1.0);
  const double below = std::max(0.0, 1.0 - 2.0 * value);
  return WithoutZeros({{low, below}, {middle, 1.0 - above - below}, {high, above}});
}

Factor TwoEnds(double value, const char* low, const char* high) {
  return WithoutZeros(
      {{low, std::max(0.0, 1.0 - 2.0 * value)}, {high, std::max(0.0, 2.0 * value - 1.0)}});
}

// Calls visit(name, weight) for each combination of one term per factor: names joined by '-',
// weights multiplied.
template <typename Visit>
void ForEachProduct(const std::vector<Factor>& factors, const Visit& visit, size_t next = 0,
                    const std::string& name = {}, double weight = 1.0) {
  if (next == factors.size()) return visit(name, weight);
  for (const Term& term : factors[next]) {
    ForEachProduct(factors, visit, next + 1, name.empty() ? term.word : name + "-" + term.word,
                   weight * term.weight);
  }
}

std::vector<Eigen::Vector3f> VertexNormals(const std::vector<Eigen::Vector3f>& vertices,
                                           const std::vector<std::array<uint32_t, 3>>& triangles) {
  std::vector<Eigen::Vector3f> normals(vertices.size(), Eigen::Vector3f::Zero());
  for (const auto& [a, b, c] : triangles) {
    const Eigen::Vector3f n = (vertices[b] - vertices[a]).cross(vertices[c] - vertices[a]);
    normals[a] += n;  // weighted by area
    normals[b] += n;
    normals[c] += n;
  }
  for (auto& normal : normals) {
    const float length = normal.norm();
    normal = length > 0 ? Eigen::Vector3f(normal / length) : Eigen::Vector3f::UnitY();
  }
  return normals;
}

/// Of three knuckles. Fingers are slightly bent at rest: turning further about the same axis closes
/// the hand.
Eigen::Vector3d FlexionAxis(const Eigen::Vector3f* knuckle) {
  return (knuckle[1] - knuckle[0]).cross(knuckle[2] - knuckle[1]).normalized().cast<double>();
}

}  // namespace

BodyModel BodyModel::Load(const fs::path& folder) {
  if (!BodyIsFetched(folder)) {
    throw InputError(folder.string() +
                     ": expected the MPFB body, found none: run tools/fetch_body");
  }
  const fs::path cache = folder / "body.cache";
  try {
    if (!AreFilesNewer(folder, cache)) return BodyModelBuilder::ReadCache(cache);
  } catch (const InputError&) {  // missing, or of another version: built from the files
  }
  BodyModel model = BodyModelBuilder::Build(ReadBodyFiles(folder));
  try {
    BodyModelBuilder::WriteCache(cache, model);
  } catch (const InputError&) {  // without a cache the next start only takes longer
  }
  return model;
}

const BodyModel::Target& BodyModel::Find(const std::string& name) const {
  const auto at = std::lower_bound(target_names_.begin(), target_names_.end(), name);
  if (at == target_names_.end() || *at != name) {
    throw InputError("the MPFB body: expected a shape target " + name + ": run tools/fetch_body");
  }
  return targets_[static_cast<size_t>(at - target_names_.begin())];
}

void BodyModel::AddTarget(const std::string& name, double weight,
                          std::vector<Eigen::Vector3f>* v_dm) const {
  const Target& target = Find(name);
  const auto w = static_cast<float>(weight);
  const float unit = w * kDeltaUnit_dm;
  for (size_t i = 0; i < target.index.size(); ++i) {
    const auto& d = target.delta[i];
    (*v_dm)[target.index[i]] += unit * Eigen::Vector3f(d[0], d[1], d[2]);
  }
  for (size_t p = 0; p < target.point_delta_dm.size(); ++p) {
    const auto& d = target.point_delta_dm[p];
    (*v_dm)[vertex_count() + p] += w * Eigen::Vector3f(d[0], d[1], d[2]);
  }
}

// v = base + sum over targets of (product of the factors' weights) · delta.
std::vector<Eigen::Vector3f> BodyModel::Morph(const BodyShape& shape) const {
  std::vector<Eigen::Vector3f> v_dm = base_dm_;
  const auto add = [&](const std::string& name, double weight) { AddTarget(name, weight, &v_dm); };
  const Factor gender = Gender(shape.male), age = Age(shape.age);
  const Factor muscle = ThreeLevels(shape.muscle, "minmuscle", "averagemuscle", "maxmuscle");
  const Factor weight = ThreeLevels(shape.weight, "minweight", "averageweight", "maxweight");
  const Factor race = WithoutZeros(
      {{"african", shape.african}, {"asian", shape.asian}, {"caucasian", shape.caucasian}});
  const Factor universal{{"universal", 1.0}};
  ForEachProduct({race, gender, age}, add);
  ForEachProduct({universal, gender, age, muscle, weight}, add);
  ForEachProduct({gender, age, muscle, weight, TwoEnds(shape.height, "minheight", "maxheight")},
                 add);
  ForEachProduct({gender, age, muscle, weight,
                  TwoEnds(shape.proportions, "uncommonproportions", "idealproportions")},
                 add);
  return v_dm;
}

ShapedBody BodyModel::Shape(const BodyShape& shape) const {
  const std::vector<Eigen::Vector3f> v_dm = Morph(shape);
  ShapedBody body;
  float low_dm = 1e9f, high_dm = -1e9f;
  for (size_t i = 0; i < vertex_count(); ++i) {
    if (vertex_layer_[i] != BodyLayer::kSkin) continue;
    low_dm = std::min(low_dm, v_dm[i].y());
    high_dm = std::max(high_dm, v_dm[i].y());
  }
  const auto metres = [&](const Eigen::Vector3f& p) -> Eigen::Vector3f {
    return static_cast<float>(kMetresPerDecimetre) * (p - Eigen::Vector3f(0, low_dm, 0));
  };
  body.height_m = kMetresPerDecimetre * static_cast<double>(high_dm - low_dm);
  body.rest_m.reserve(vertex_count());
  for (size_t i = 0; i < vertex_count(); ++i) body.rest_m.push_back(metres(v_dm[i]));
  body.normals = VertexNormals(body.rest_m, triangles_);

  const Eigen::Vector3f* point = v_dm.data() + vertex_count();
  for (size_t b = 0; b < kRigBoneCount; ++b) body.bone_head_m[b] = metres(point[b]).cast<double>();
  point += 2 * kRigBoneCount;
  for (size_t j = 0; j < kJointCount; ++j) body.joint_m[j] = metres(point[j]).cast<double>();
  point += kJointCount;
  for (size_t k = 0; k < 4; ++k, point += 3) body.flexion_axis[k] = FlexionAxis(point);
  body.root_scale = body.bone_head_m[0].y() / StandardRigRest().head_m[0].y();
  return body;
}

void BodyModel::Skin(const ShapedBody& body, std::span<const Eigen::Vector3f> rest_m,
                     const RigPose& pose, const Eigen::Isometry3d& cam_from_world,
                     std::span<Eigen::Vector3f> posed_m) const {
  if (rest_m.size() != vertex_count() || posed_m.size() != vertex_count()) {
    throw std::invalid_argument("BodyModel::Skin: expected one rest and one posed place a vertex");
  }
  using Affine = Eigen::Matrix<float, 3, 4>;
  const auto heads = PosedBoneHeads(body, pose);
  std::array<Affine, kRigBoneCount> cam_from_bone;
  for (size_t b = 0; b < kRigBoneCount; ++b) {
    const Eigen::Matrix3d r =
        cam_from_world.linear() * pose.world_from_rest[b].normalized().toRotationMatrix();
    cam_from_bone[b].leftCols<3>() = r.cast<float>();
    cam_from_bone[b].col(3) = (cam_from_world * heads[b] - r * body.bone_head_m[b]).cast<float>();
  }
  for (size_t i = 0; i < rest_m.size(); ++i) {
    const Influence& influence = influence_[i];
    Affine blend = influence.weight[0] * cam_from_bone[influence.bone[0]];
    for (size_t k = 1; k < 4 && influence.weight[k] > 0; ++k) {
      blend += influence.weight[k] * cam_from_bone[influence.bone[k]];
    }
    posed_m[i] = blend.leftCols<3>() * rest_m[i] + blend.col(3);
  }
}

fs::path BodyFolder() {
  const auto variable = [](const char* name) {
    const char* value = std::getenv(name);
    return std::string(value != nullptr ? value : "");
  };
  if (const std::string folder = variable("OSSA_BODY_DIR"); !folder.empty()) return folder;
  const std::string cache = variable("XDG_CACHE_HOME");
  return fs::path(cache.empty() ? variable("HOME") + "/.cache" : cache) / "ossa" / "mpfb2";
}

bool BodyIsFetched(const fs::path& folder) {
  std::error_code ignored;
  return fs::is_regular_file(folder / "fetched.txt", ignored);
}

std::array<Eigen::Vector3d, kRigBoneCount> PosedBoneHeads(const ShapedBody& body,
                                                          const RigPose& pose) {
  std::array<Eigen::Vector3d, kRigBoneCount> heads;
  heads[0] = body.root_scale * pose.root_m;
  for (size_t b = 1; b < kRigBoneCount; ++b) {
    const auto parent = static_cast<size_t>(kRigBoneParent[b]);
    heads[b] = heads[parent] +
               pose.world_from_rest[parent] * (body.bone_head_m[b] - body.bone_head_m[parent]);
  }
  return heads;
}

Posture ComputeJoints(const ShapedBody& body, const RigPose& pose) {
  const auto heads = PosedBoneHeads(body, pose);
  const auto& anchors = StandardJointAnchors();  // the same bones carry them on every body
  Posture posture;
  for (size_t j = 0; j < kJointCount; ++j) {
    const size_t bone = anchors[j].bone;
    posture.position_m[j] =
        heads[bone] + pose.world_from_rest[bone] * (body.joint_m[j] - body.bone_head_m[bone]);
  }
  return posture;
}

void CloseHands(const ShapedBody& body, double left, double right, RigPose* pose) {
  constexpr double kPalm_rad = 0.35, kFinger_rad = 1.7, kThumb_rad = 0.9;  // of a fist
  constexpr size_t kLeftFingerBase = 21, kRightFingerBase = 28;
  for (const auto& [base, axes, closed] : {std::tuple{kLeftFingerBase, size_t{0}, left},
                                           std::tuple{kRightFingerBase, size_t{2}, right}}) {
    const auto bend = [&, axes = axes, closed = closed](size_t axis, double angle_rad) {
      return Eigen::Quaterniond(
          Eigen::AngleAxisd(closed * angle_rad, body.flexion_axis[axes + axis]));
    };
    const Eigen::Quaterniond hand = pose->world_from_rest[base - 1];
    pose->world_from_rest[base] = hand * bend(0, kPalm_rad);
    pose->world_from_rest[base + 1] = hand * bend(0, kPalm_rad + kFinger_rad);
    pose->world_from_rest[base + 2] = hand * bend(1, kThumb_rad);
  }
}

}  // namespace ossa::recon
