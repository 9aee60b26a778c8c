#include "depth/render/renderer.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>

namespace ossa::depth {
namespace {

// 16 rays of a 4 × 4 tile are traced as a packet: 2.2 ms per image instead of 8.4 with single rays
// (measured on the MPFB body at 640 × 480, Embree 3.13, one thread).
constexpr int kTile = 4;
constexpr int kPacket = kTile * kTile;
// Shadow rays end this far in front of their target, to avoid self-shadowing.
constexpr float kShadowSlack_m = 0.002F;  // chosen by hand

struct DeviceCloser {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct SceneCloser {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using Device = std::unique_ptr<std::remove_pointer_t<RTCDevice>, DeviceCloser>;
using SceneHandle = std::unique_ptr<std::remove_pointer_t<RTCScene>, SceneCloser>;

struct MeshEntry {
  RTCGeometry geometry = nullptr;  // owned by its scene
  size_t vertex_count = 0;
};

/// The packet's 16 pixels: lane i is pixel (u0 + i % 4, v0 + i / 4).
struct Tile {
  alignas(64) int valid[kPacket];
  int u0 = 0;
  int v0 = 0;
};

RTCIntersectContext CoherentContext() {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  return context;
}

/// Direction of the ray through each column (x) and row (y) at z = 1; padded to whole tiles.
struct RayGrid {
  std::vector<float> x;
  std::vector<float> y;

  explicit RayGrid(const Camera& camera) {
    for (int u = 0; u < camera.width + kTile; ++u) {
      x.push_back(static_cast<float>((camera.cx - u) / camera.fx));
    }
    for (int v = 0; v < camera.height + kTile; ++v) {
      y.push_back(static_cast<float>((camera.cy - v) / camera.fy));
    }
  }
};

void SetCameraRays(const RayGrid& grid, const Tile& tile, RTCRayHit16& packet) {
  for (int i = 0; i < kPacket; ++i) {
    packet.ray.org_x[i] = packet.ray.org_y[i] = packet.ray.org_z[i] = 0.0F;
    packet.ray.dir_x[i] = grid.x[static_cast<size_t>(tile.u0 + i % kTile)];
    packet.ray.dir_y[i] = grid.y[static_cast<size_t>(tile.v0 + i / kTile)];
    packet.ray.dir_z[i] = 1.0F;  // so that the ray's parameter is the depth itself
    packet.ray.tnear[i] = 0.0F;
    packet.ray.tfar[i] = std::numeric_limits<float>::infinity();
    packet.ray.time[i] = 0.0F;
    packet.ray.mask[i] = ~0U;
    packet.ray.id[i] = 0;
    packet.ray.flags[i] = 0;
    packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
}

float Incidence(const RTCRayHit16& packet, int i) {
  const Eigen::Vector3f normal(packet.hit.Ng_x[i], packet.hit.Ng_y[i], packet.hit.Ng_z[i]);
  const Eigen::Vector3f ray(packet.ray.dir_x[i], packet.ray.dir_y[i], packet.ray.dir_z[i]);
  const float norms = normal.norm() * ray.norm();
  return norms > 0.0F ? std::abs(normal.dot(ray)) / norms : 0.0F;
}

bool StoreHits(const Tile& tile, const RTCRayHit16& packet, RenderedImage& image) {
  bool any = false;
  for (int i = 0; i < kPacket; ++i) {
    if (tile.valid[i] == 0 || packet.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
    const int u = tile.u0 + i % kTile;
    const int v = tile.v0 + i / kTile;
    image.depth_m.at(u, v) = packet.ray.tfar[i];
    image.triangle.at(u, v) = static_cast<int32_t>(packet.hit.primID[i]);
    image.mesh.at(u, v) = static_cast<int16_t>(packet.hit.geomID[i]);
    image.incidence.at(u, v) = Incidence(packet, i);
    any = true;
  }
  return any;
}

/// Traces rays from the projector to the surface points hit by the camera rays.
void TraceProjector(RTCScene scene, const Tile& tile, const RTCRayHit16& seen, double baseline_m,
                    RenderedImage& image) {
  alignas(64) int valid[kPacket];
  RTCRay16 rays;
  for (int i = 0; i < kPacket; ++i) {
    valid[i] = tile.valid[i] != 0 && seen.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID ? -1 : 0;
    const float z = valid[i] != 0 ? seen.ray.tfar[i] : 1.0F;
    const Eigen::Vector3f projector_m(static_cast<float>(-baseline_m), 0.0F, 0.0F);
    const Eigen::Vector3f surface_m(seen.ray.dir_x[i] * z, seen.ray.dir_y[i] * z, z);
    const Eigen::Vector3f way = surface_m - projector_m;
    rays.org_x[i] = projector_m.x();
    rays.org_y[i] = rays.org_z[i] = 0.0F;
    rays.dir_x[i] = way.x();
    rays.dir_y[i] = way.y();
    rays.dir_z[i] = way.z();
    rays.tnear[i] = 0.0F;
    rays.tfar[i] = 1.0F - kShadowSlack_m / way.norm();
    rays.time[i] = 0.0F;
    rays.mask[i] = ~0U;
    rays.id[i] = rays.flags[i] = 0;
  }
  RTCIntersectContext context = CoherentContext();
  rtcOccluded16(valid, scene, &context, &rays);
  for (int i = 0; i < kPacket; ++i) {
    if (valid[i] != 0 && rays.tfar[i] >= 0.0F) {
      image.lit.at(tile.u0 + i % kTile, tile.v0 + i / kTile) = 1;
    }
  }
}

Tile TileAt(const Camera& camera, int u0, int v0) {
  Tile tile;
  tile.u0 = u0;
  tile.v0 = v0;
  for (int i = 0; i < kPacket; ++i) {
    tile.valid[i] = u0 + i % kTile < camera.width && v0 + i / kTile < camera.height ? -1 : 0;
  }
  return tile;
}

void CheckTriangles(const TriangleMesh& mesh) {
  for (const auto& triangle : mesh.triangles) {
    const uint32_t highest = std::max({triangle[0], triangle[1], triangle[2]});
    if (highest >= mesh.vertices_m.size()) {
      throw std::invalid_argument("triangle names vertex " + std::to_string(highest) + " of " +
                                  std::to_string(mesh.vertices_m.size()));
    }
  }
}

}  // namespace

struct Renderer::Scene {
  // One thread per renderer: callers parallelise over renderers.
  Device device{rtcNewDevice("threads=1")};
  SceneHandle scene;
  std::map<int, MeshEntry> meshes;
  bool changed = true;
};

Renderer::Renderer() : scene_(std::make_unique<Scene>()) {
  if (!scene_->device) throw std::runtime_error("Embree could not be started");
  scene_->scene.reset(rtcNewScene(scene_->device.get()));
  // Only dynamic scenes of low build quality are refitted; otherwise every pose costs a rebuild
  // (measured: 0.25 ms a refit, 4.9 ms a rebuild).
  rtcSetSceneFlags(scene_->scene.get(), RTC_SCENE_FLAG_DYNAMIC);
  rtcSetSceneBuildQuality(scene_->scene.get(), RTC_BUILD_QUALITY_LOW);
}

Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

int Renderer::AddMesh(const TriangleMesh& mesh, bool deforming) {
  CheckTriangles(mesh);
  RTCGeometry geometry = rtcNewGeometry(scene_->device.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetGeometryBuildQuality(geometry, deforming ? RTC_BUILD_QUALITY_REFIT : RTC_BUILD_QUALITY_LOW);
  void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                           sizeof(Eigen::Vector3f), mesh.vertices_m.size());
  void* triangles = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                            3 * sizeof(uint32_t), mesh.triangles.size());
  std::memcpy(vertices, mesh.vertices_m.data(), mesh.vertices_m.size() * sizeof(Eigen::Vector3f));
  std::memcpy(triangles, mesh.triangles.data(), mesh.triangles.size() * 3 * sizeof(uint32_t));
  rtcCommitGeometry(geometry);
  const int id = static_cast<int>(rtcAttachGeometry(scene_->scene.get(), geometry));
  rtcReleaseGeometry(geometry);
  scene_->meshes[id] = {geometry, mesh.vertices_m.size()};
  // Builds a deforming mesh's BVH now, from these vertices; later it is refitted. If it were built
  // at the first Render, it would depend on that frame's vertices, and so would which of two
  // triangles a ray through their common edge hits.
  if (deforming) rtcCommitScene(scene_->scene.get());
  scene_->changed = true;
  return id;
}

void Renderer::UpdateVertices(int mesh, std::span<const Eigen::Vector3f> vertices_m) {
  const MeshEntry& entry = scene_->meshes.at(mesh);
  if (vertices_m.size() != entry.vertex_count) {
    throw std::invalid_argument("mesh has " + std::to_string(entry.vertex_count) +
                                " vertices, given " + std::to_string(vertices_m.size()));
  }
  std::memcpy(rtcGetGeometryBufferData(entry.geometry, RTC_BUFFER_TYPE_VERTEX, 0),
              vertices_m.data(), vertices_m.size() * sizeof(Eigen::Vector3f));
  rtcUpdateGeometryBuffer(entry.geometry, RTC_BUFFER_TYPE_VERTEX, 0);
  rtcCommitGeometry(entry.geometry);
  scene_->changed = true;
}

void Renderer::RemoveMesh(int mesh) {
  if (scene_->meshes.erase(mesh) == 0) {
    throw std::invalid_argument("no mesh " + std::to_string(mesh));
  }
  rtcDetachGeometry(scene_->scene.get(), static_cast<unsigned>(mesh));
  scene_->changed = true;
}

RenderedImage Renderer::Render(const Camera& camera, const RenderOptions& options) {
  RTCScene scene = scene_->scene.get();
  if (scene_->changed) rtcCommitScene(scene);
  scene_->changed = false;

  const int w = camera.width;
  const int h = camera.height;
  RenderedImage image{{w, h}, {w, h, -1}, {w, h, -1}, {w, h}, {w, h}};
  const RayGrid grid(camera);
  RTCRayHit16 packet;
  for (int v0 = 0; v0 < h; v0 += kTile) {
    for (int u0 = 0; u0 < w; u0 += kTile) {
      const Tile tile = TileAt(camera, u0, v0);
      SetCameraRays(grid, tile, packet);
      RTCIntersectContext context = CoherentContext();
      rtcIntersect16(tile.valid, scene, &context, &packet);
      if (StoreHits(tile, packet, image) && options.projector) {
        TraceProjector(scene, tile, packet, options.baseline_m, image);
      }
    }
  }
  return image;
}

}  // namespace ossa::depth
