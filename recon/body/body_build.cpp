#include "recon/body/body_build_internal.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include "depth/base/checksummed_container.h"
#include "depth/base/error.h"
#include "recon/body/parts.h"

namespace ossa::recon {
namespace {

constexpr ContainerFormat kCacheFormat{{'O', 'S', 'S', 'A', 'B', 'O', 'D', 'Y'}, 2, "body cache"};
constexpr float kDeltaUnit_dm = 1e-3f;  // decimetres a unit; our format

/// A point that is a weighted sum of vertices of base.obj.
using PointRule = std::vector<std::pair<uint32_t, float>>;

void AddMean(const VertexMean& vertices, float share, PointRule* rule) {
  for (const uint32_t v : vertices) {
    rule->emplace_back(v, share / static_cast<float>(vertices.size()));
  }
}

struct GroupShare {
  const char* group;
  float share;
};

// The joints of standard_body.h, from joint cubes: midline, left side, right side.
const std::array<std::vector<GroupShare>, kJointCount> kJointRules = {{
    {{"joint-pelvis", 0.5f}, {"joint-spine-4", 0.5f}},
    {{"joint-spine-2", 1}},
    {{"joint-neck", 1}},
    {{"joint-head", 0.5f}, {"joint-head-2", 0.5f}},
    {{"joint-l-shoulder", 1}},
    {{"joint-l-elbow", 1}},
    {{"joint-l-hand", 1}},
    {{"joint-l-hand", 0.5f}, {"joint-l-finger-3-1", 0.5f}},
    {{"joint-r-shoulder", 1}},
    {{"joint-r-elbow", 1}},
    {{"joint-r-hand", 1}},
    {{"joint-r-hand", 0.5f}, {"joint-r-finger-3-1", 0.5f}},
    {{"joint-l-upper-leg", 1}},
    {{"joint-l-knee", 1}},
    {{"joint-l-ankle", 1}},
    {{"joint-l-toe-3-1", 1}},
    {{"joint-r-upper-leg", 1}},
    {{"joint-r-knee", 1}},
    {{"joint-r-ankle", 1}},
    {{"joint-r-toe-3-1", 1}},
}};

constexpr std::array<const char*, 12> kKnuckles = {
    "joint-l-finger-3-1", "joint-l-finger-3-2", "joint-l-finger-3-4", "joint-l-finger-1-1",
    "joint-l-finger-1-2", "joint-l-finger-1-4", "joint-r-finger-3-1", "joint-r-finger-3-2",
    "joint-r-finger-3-4", "joint-r-finger-1-1", "joint-r-finger-1-2", "joint-r-finger-1-4"};

std::vector<PointRule> PointRules(const BodyFiles& files) {
  std::vector<PointRule> rules;
  for (const auto* means : {&files.bone_head, &files.bone_tail}) {
    for (const auto& mean : *means) AddMean(mean, 1.0f, &rules.emplace_back());
  }
  for (const auto& joint : kJointRules) {
    auto& rule = rules.emplace_back();
    for (const auto& [group, share] : joint) AddMean(files.Vertices(group), share, &rule);
  }
  for (const char* group : kKnuckles) AddMean(files.Vertices(group), 1.0f, &rules.emplace_back());
  return rules;
}

Eigen::Vector3f Apply(const PointRule& rule, const std::vector<Eigen::Vector3f>& vertices) {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (const auto& [v, share] : rule) sum += share * vertices[v];
  return sum;
}

// Part labels of all triangles from the neutral body.
std::vector<uint8_t> LabelTriangles(const BodyFiles& files, const std::vector<uint32_t>& kept,
                                    const std::vector<std::array<uint32_t, 3>>& triangles) {
  PartLandmarks marks;
  const auto rules = PointRules(files);
  for (size_t b = 0; b < kRigBoneCount; ++b) {
    marks.bone_head_dm[b] = Apply(rules[b], files.vertex_dm);
    marks.bone_tail_dm[b] = Apply(rules[kRigBoneCount + b], files.vertex_dm);
  }
  std::vector<uint8_t> parts;
  for (const auto& triangle : triangles) {
    PartLabelInput place{Eigen::Vector3f::Zero(), {}};
    for (const uint32_t corner : triangle) {
      const uint32_t v = kept[corner];
      place.centroid_dm += files.vertex_dm[v] / 3.0f;
      for (const auto& [bone, weight] : files.weights[v]) place.bone_weight[bone] += weight / 3.0f;
    }
    parts.push_back(LabelPart(place, marks));
  }
  return parts;
}

std::vector<std::array<float, 3>> Plain(const std::vector<Eigen::Vector3f>& points) {
  std::vector<std::array<float, 3>> plain;
  for (const auto& p : points) plain.push_back({p.x(), p.y(), p.z()});
  return plain;
}

std::vector<Eigen::Vector3f> GetPoints(PayloadReader& reader, const char* field) {
  std::vector<Eigen::Vector3f> points;
  for (const auto& p : reader.GetVector<std::array<float, 3>>(field)) {
    points.emplace_back(p[0], p[1], p[2]);
  }
  return points;
}

template <typename Influence>
Influence FourLargest(std::vector<std::pair<uint8_t, float>> weights) {
  std::sort(weights.begin(), weights.end(),
            [](const auto& a, const auto& b) { return a.second > b.second; });
  if (weights.size() > 4) weights.resize(4);
  float sum = 0;
  for (const auto& [bone, weight] : weights) sum += weight;
  Influence influence;
  for (size_t k = 0; k < weights.size(); ++k) {
    influence.bone[k] = weights[k].first;
    influence.weight[k] = weights[k].second / sum;
  }
  return influence;
}

}  // namespace

void BodyModelBuilder::AddLayer(const BodyFiles& files, const std::string& group, BodyLayer layer,
                                std::vector<uint32_t>* kept, BodyModel* model) {
  std::unordered_map<uint32_t, uint32_t> number;
  for (const uint32_t v : files.Vertices(group)) {
    number[v] = static_cast<uint32_t>(kept->size());
    kept->push_back(v);
    model->vertex_layer_.push_back(layer);
  }
  for (const auto& polygon : files.faces.at(group)) {
    for (size_t k = 2; k < polygon.size(); ++k) {
      model->triangles_.push_back(
          {number.at(polygon[0]), number.at(polygon[k - 1]), number.at(polygon[k])});
    }
  }
}

void BodyModelBuilder::AddTargets(const BodyFiles& files, const std::vector<uint32_t>& kept,
                                  BodyModel* model) {
  const auto rules = PointRules(files);
  std::vector<int> number(files.vertex_dm.size(), -1);
  for (size_t i = 0; i < kept.size(); ++i) number[kept[i]] = static_cast<int>(i);
  std::vector<Eigen::Vector3f> dense(files.vertex_dm.size());
  for (const auto& from : files.targets) {
    std::fill(dense.begin(), dense.end(), Eigen::Vector3f::Zero());
    BodyModel::Target target;
    for (size_t i = 0; i < from.index.size(); ++i) {
      dense[from.index[i]] = from.delta_dm[i];
      if (number[from.index[i]] < 0) continue;
      target.index.push_back(static_cast<uint16_t>(number[from.index[i]]));
      auto& delta = target.delta.emplace_back();
      for (size_t c = 0; c < 3; ++c) {
        delta[c] = static_cast<int16_t>(
            std::lround(from.delta_dm[i][static_cast<Eigen::Index>(c)] / kDeltaUnit_dm));
      }
    }
    for (const auto& rule : rules) {
      const Eigen::Vector3f delta = Apply(rule, dense);
      target.point_delta_dm.push_back({delta.x(), delta.y(), delta.z()});
    }
    model->target_names_.push_back(from.name);
    model->targets_.push_back(std::move(target));
  }
}

void BodyModelBuilder::AddInfluences(const BodyFiles& files, const std::vector<uint32_t>& kept,
                                     BodyModel* model) {
  for (const uint32_t v : kept) {
    const auto& weights = files.weights[v];
    if (std::none_of(weights.begin(), weights.end(), [](const auto& w) { return w.second > 0; })) {
      throw InputError("weights.cmu_mb.json: vertex " + std::to_string(v) + ": has no weight");
    }
    model->influence_.push_back(FourLargest<BodyModel::Influence>(files.weights[v]));
  }
}

BodyModel BodyModelBuilder::Build(const BodyFiles& files) {
  BodyModel model;
  std::vector<uint32_t> kept;
  AddLayer(files, "body", BodyLayer::kSkin, &kept, &model);
  AddLayer(files, "helper-skirt", BodyLayer::kSkirt, &kept, &model);
  AddLayer(files, "helper-hair", BodyLayer::kHair, &kept, &model);
  constexpr size_t kMostVertices = 65535;  // whose numbers targets hold in 16 bits; our format
  if (kept.size() > kMostVertices) {
    throw InputError(files.mesh_file + ": expected at most 65535 vertices, found " +
                     std::to_string(kept.size()));
  }
  for (const uint32_t v : kept) {
    model.base_dm_.push_back(files.vertex_dm[v]);
    model.base_m_.push_back(files.vertex_dm[v] * 0.1f);
  }
  for (const auto& rule : PointRules(files)) model.base_dm_.push_back(Apply(rule, files.vertex_dm));
  model.triangle_part_ = LabelTriangles(files, kept, model.triangles_);
  model.vertex_part_.resize(kept.size());
  for (size_t t = 0; t < model.triangles_.size(); ++t) {
    for (const uint32_t v : model.triangles_[t]) model.vertex_part_[v] = model.triangle_part_[t];
  }
  AddInfluences(files, kept, &model);
  AddTargets(files, kept, &model);
  return model;
}

void BodyModelBuilder::WriteCache(const std::filesystem::path& path, const BodyModel& model) {
  PayloadWriter writer;
  writer.PutVector(Plain(model.base_dm_));
  writer.PutVector(Plain(model.base_m_));
  writer.PutVector(model.triangles_);
  writer.PutVector(model.triangle_part_);
  writer.PutVector(model.vertex_layer_);
  writer.PutVector(model.vertex_part_);
  writer.PutVector(model.influence_);
  writer.Put<uint64_t>(model.targets_.size());
  for (size_t i = 0; i < model.targets_.size(); ++i) {
    writer.PutString(model.target_names_[i]);
    writer.PutVector(model.targets_[i].index);
    writer.PutVector(model.targets_[i].delta);
    writer.PutVector(model.targets_[i].point_delta_dm);
  }
  WriteContainer(path, kCacheFormat, writer.bytes());
}

BodyModel BodyModelBuilder::ReadCache(const std::filesystem::path& path) {
  const auto payload = ReadContainer(path, kCacheFormat);
  PayloadReader reader(payload, path.string());
  BodyModel model;
  model.base_dm_ = GetPoints(reader, "base");
  model.base_m_ = GetPoints(reader, "base");
  model.triangles_ = reader.GetVector<std::array<uint32_t, 3>>("triangles");
  model.triangle_part_ = reader.GetVector<uint8_t>("parts");
  model.vertex_layer_ = reader.GetVector<BodyLayer>("layers");
  model.vertex_part_ = reader.GetVector<uint8_t>("parts");
  model.influence_ = reader.GetVector<BodyModel::Influence>("weights");
  const auto targets = reader.Get<uint64_t>("targets");
  for (uint64_t i = 0; i < targets; ++i) {
    model.target_names_.push_back(reader.GetString("target"));
    BodyModel::Target target;
    target.index = reader.GetVector<uint16_t>("target");
    target.delta = reader.GetVector<std::array<int16_t, 3>>("target");
    target.point_delta_dm = reader.GetVector<std::array<float, 3>>("target");
    model.targets_.push_back(std::move(target));
  }
  reader.ExpectEnd();
  return model;
}

}  // namespace ossa::recon
