#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "recon/files/gltf_scene_internal.h"

namespace ossa::recon {
namespace {

// By hand: six distinguishable colours, linear, for the six people that the tracker follows.
constexpr std::array<std::array<double, 3>, 6> kColours = {{{0.55, 0.58, 0.62},
                                                            {0.75, 0.42, 0.25},
                                                            {0.25, 0.50, 0.70},
                                                            {0.40, 0.60, 0.30},
                                                            {0.65, 0.55, 0.25},
                                                            {0.55, 0.35, 0.60}}};

int Last(size_t count) { return static_cast<int>(count) - 1; }

std::vector<double> AsList(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

/// Components per element of a glTF accessor type.
constexpr std::array<std::pair<int, size_t>, 4> kWidths = {{{TINYGLTF_TYPE_SCALAR, 1},
                                                            {TINYGLTF_TYPE_VEC3, 3},
                                                            {TINYGLTF_TYPE_VEC4, 4},
                                                            {TINYGLTF_TYPE_MAT4, 16}}};

size_t WidthOf(int type) {
  const auto found = std::find_if(kWidths.begin(), kWidths.end(),
                                  [type](const auto& width) { return width.first == type; });
  return found->second;
}

}  // namespace

struct GltfScene::Impl {
  tinygltf::Model model;

  Impl() {
    model.asset.version = "2.0";
    model.asset.generator = "ossa";
    model.buffers.emplace_back();
    model.scenes.emplace_back();
    model.defaultScene = 0;
    model.animations.emplace_back();
    model.animations[0].name = "motion";
  }

  tinygltf::Animation& motion() { return model.animations[0]; }

  /// Adds numbers as an accessor; returns its index.
  template <typename T>
  int Add(const std::vector<T>& values, int component, int type, int target) {
    std::vector<unsigned char>& data = model.buffers[0].data;
    data.resize((data.size() + 3) / 4 * 4);  // accessors begin at multiples of four
    tinygltf::BufferView view;
    view.buffer = 0;
    view.byteOffset = data.size();
    view.byteLength = values.size() * sizeof(T);
    view.target = target;
    data.resize(data.size() + view.byteLength);
    std::memcpy(data.data() + view.byteOffset, values.data(), view.byteLength);
    model.bufferViews.push_back(view);
    tinygltf::Accessor accessor;
    accessor.bufferView = Last(model.bufferViews.size());
    accessor.componentType = component;
    accessor.type = type;
    accessor.count = values.size() / WidthOf(type);
    model.accessors.push_back(accessor);
    return Last(model.accessors.size());
  }
  int AddFloats(const std::vector<float>& values, int type, int target = 0) {
    return Add(values, TINYGLTF_COMPONENT_TYPE_FLOAT, type, target);
  }
  /// As Add, with the minimum and maximum of each component, which glTF requires of some accessors.
  int AddBounded(const std::vector<float>& values, int type, int target = 0) {
    const int number = AddFloats(values, type, target);
    tinygltf::Accessor& accessor = model.accessors.back();
    const size_t width = WidthOf(type);
    for (size_t k = 0; k < width; ++k) {
      float least = values[k], most = values[k];
      for (size_t i = k; i < values.size(); i += width) {
        least = std::min(least, values[i]);
        most = std::max(most, values[i]);
      }
      accessor.minValues.push_back(static_cast<double>(least));
      accessor.maxValues.push_back(static_cast<double>(most));
    }
    return number;
  }

  int AddRestNodes(const std::string& name, std::span<const RestNode> nodes);
  int AddMesh(const std::string& name, const SkinnedBody& body, const BodyMesh& mesh);
  void AddSkin(const std::string& name, int first, std::span<const RestNode> nodes, int mesh);
  void AddChannel(int node, const char* path, const char* interpolation, int times, int values);
};

/// Returns the index of the first node; the person's own root node is the one before it.
int GltfScene::Impl::AddRestNodes(const std::string& name, std::span<const RestNode> nodes) {
  tinygltf::Node person;
  person.name = name;
  model.nodes.push_back(person);
  const auto first = static_cast<int>(model.nodes.size());
  model.scenes[0].nodes.push_back(first - 1);
  for (size_t i = 0; i < nodes.size(); ++i) {
    const RestNode& rest = nodes[i];
    tinygltf::Node node;
    node.name = rest.name;
    const Eigen::Vector3d parent_m = rest.parent < 0
                                         ? Eigen::Vector3d(Eigen::Vector3d::Zero())
                                         : nodes[static_cast<size_t>(rest.parent)].place_m;
    node.translation = AsList(rest.place_m - parent_m);
    model.nodes.push_back(node);
    model.nodes[static_cast<size_t>(first + rest.parent)].children.push_back(
        Last(model.nodes.size()));
  }
  return first;
}

int GltfScene::Impl::AddMesh(const std::string& name, const SkinnedBody& body,
                             const BodyMesh& skin) {
  std::vector<float> places, normals, weights;
  std::vector<uint8_t> bones;
  std::vector<uint16_t> corners;
  for (size_t i = 0; i < skin.vertices.size(); ++i) {
    for (const double x : body.vertices_m[i]) places.push_back(static_cast<float>(x));
    for (const double x : body.normals[i]) normals.push_back(static_cast<float>(x));
    const MeshVertex& vertex = skin.vertices[i];
    weights.insert(weights.end(), vertex.weight.begin(), vertex.weight.end());
    for (size_t k = 0; k < vertex.bone.size(); ++k) {
      bones.push_back(vertex.weight[k] > 0.0F ? vertex.bone[k] : uint8_t{0});
    }
  }
  for (const MeshTriangle& triangle : skin.triangles) {
    for (const uint32_t corner : triangle) corners.push_back(static_cast<uint16_t>(corner));
  }
  tinygltf::Material material;
  const auto& colour = kColours[model.materials.size() % kColours.size()];
  material.pbrMetallicRoughness.baseColorFactor = {colour[0], colour[1], colour[2], 1.0};
  material.pbrMetallicRoughness.metallicFactor = 0.0;
  model.materials.push_back(material);
  tinygltf::Primitive primitive;
  primitive.mode = TINYGLTF_MODE_TRIANGLES;
  primitive.material = Last(model.materials.size());
  const int vertex_data = TINYGLTF_TARGET_ARRAY_BUFFER;
  primitive.attributes["POSITION"] = AddBounded(places, TINYGLTF_TYPE_VEC3, vertex_data);
  primitive.attributes["NORMAL"] = AddFloats(normals, TINYGLTF_TYPE_VEC3, vertex_data);
  primitive.attributes["WEIGHTS_0"] = AddFloats(weights, TINYGLTF_TYPE_VEC4, vertex_data);
  primitive.attributes["JOINTS_0"] =
      Add(bones, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, TINYGLTF_TYPE_VEC4, vertex_data);
  primitive.indices = Add(corners, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TYPE_SCALAR,
                          TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
  tinygltf::Mesh mesh;
  mesh.name = name;
  mesh.primitives.push_back(primitive);
  model.meshes.push_back(mesh);
  return Last(model.meshes.size());
}

void GltfScene::Impl::AddSkin(const std::string& name, int first, std::span<const RestNode> nodes,
                              int mesh) {
  tinygltf::Skin skin;
  skin.name = name;
  skin.skeleton = first - 1;
  std::vector<float> inverse_bind;
  for (size_t i = 0; i < nodes.size(); ++i) {
    skin.joints.push_back(first + static_cast<int>(i));
    Eigen::Matrix4f matrix = Eigen::Matrix4f::Identity();
    matrix.topRightCorner<3, 1>() = -nodes[i].place_m.cast<float>();
    inverse_bind.insert(inverse_bind.end(), matrix.data(), matrix.data() + matrix.size());
  }
  skin.inverseBindMatrices = AddFloats(inverse_bind, TINYGLTF_TYPE_MAT4);
  model.skins.push_back(skin);
  tinygltf::Node node;
  node.name = name + " skin";
  node.mesh = mesh;
  node.skin = Last(model.skins.size());
  model.nodes.push_back(node);
  model.scenes[0].nodes.push_back(Last(model.nodes.size()));
}

void GltfScene::Impl::AddChannel(int node, const char* path, const char* interpolation, int times,
                                 int values) {
  tinygltf::AnimationSampler sampler;
  sampler.input = times;
  sampler.output = values;
  sampler.interpolation = interpolation;
  motion().samplers.push_back(sampler);
  tinygltf::AnimationChannel channel;
  channel.sampler = Last(motion().samplers.size());
  channel.target_node = node;
  channel.target_path = path;
  motion().channels.push_back(channel);
}

GltfScene::GltfScene() : impl_(std::make_unique<Impl>()) {}
GltfScene::~GltfScene() = default;

void GltfScene::AddPerson(const std::string& name, std::span<const RestNode> nodes,
                          const SkinnedBody* body, const BodyMesh* mesh,
                          const PersonTracks& tracks) {
  const int first = impl_->AddRestNodes(name, nodes);
  if (body != nullptr && mesh != nullptr) {
    impl_->AddSkin(name, first, nodes, impl_->AddMesh(name, *body, *mesh));
  }
  const int times = impl_->AddBounded(tracks.time_s, TINYGLTF_TYPE_SCALAR);
  for (size_t i = 0; i < nodes.size(); ++i) {
    const int node = first + static_cast<int>(i);
    impl_->AddChannel(node, "translation", "LINEAR", times,
                      impl_->AddFloats(tracks.translation_m[i], TINYGLTF_TYPE_VEC3));
    if (tracks.rotation[i].empty()) continue;
    impl_->AddChannel(node, "rotation", "LINEAR", times,
                      impl_->AddFloats(tracks.rotation[i], TINYGLTF_TYPE_VEC4));
  }
  if (tracks.presence.empty()) return;
  std::vector<float> sizes;
  for (const float here : tracks.presence) sizes.insert(sizes.end(), 3, here);
  const int when = impl_->AddBounded(tracks.presence_s, TINYGLTF_TYPE_SCALAR);
  impl_->AddChannel(first - 1, "scale", "STEP", when, impl_->AddFloats(sizes, TINYGLTF_TYPE_VEC3));
}

size_t GltfScene::Bytes() const { return impl_->model.buffers[0].data.size(); }

void GltfScene::Write(std::ostream& stream) {
  tinygltf::TinyGLTF().WriteGltfSceneToStream(&impl_->model, stream, false, true);
}

}  // namespace ossa::recon
