#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "recon/files/skeleton_jsonl.h"
#include "tools/viewer/message_internal.h"

namespace ossa::viewer {
namespace {

std::string CameraJson(const depth::Camera& camera) {
  return fmt::format(R"({{"width":{},"height":{},"fx":{},"fy":{},"cx":{},"cy":{}}})", camera.width,
                     camera.height, camera.fx, camera.fy, camera.cx, camera.cy);
}

std::string StagesJson(const tracker::StageTimes& ms) {
  return fmt::format(
      R"({{"segment":{:.2f},"classify":{:.2f},"propose":{:.2f},"reconstruct":{:.2f},"physics":{:.2f},"total":{:.2f}}})",
      ms.segment, ms.classify, ms.propose, ms.reconstruct, ms.physics, ms.total);
}

std::string MeshesJson(const std::vector<FittedBody>& fits, size_t vertices) {
  std::string text = "[";
  for (const FittedBody& fit : fits) {
    text +=
        fmt::format(R"({}{{"id":{},"vertices":{}}})", text.size() > 1 ? "," : "", fit.id, vertices);
  }
  return text + "]";
}

void AppendMesh(std::string& bytes, const recon::BodyMesh& body, const recon::SurfacePose& pose) {
  constexpr double kUnits = 2000.0;  // a metre, of the format: to 16 m
  constexpr double kMost = std::numeric_limits<int16_t>::max();
  for (const Eigen::Vector3d& vertex_m : recon::PoseMesh(body, pose)) {
    for (const double x_m : vertex_m) {
      const double units = std::clamp(std::round(x_m * kUnits), -kMost, kMost);
      const auto whole = static_cast<uint16_t>(static_cast<int16_t>(units));
      bytes.push_back(static_cast<char>(whole));
      bytes.push_back(static_cast<char>(whole >> 8));
    }
  }
}

std::string LayersJson(const DisplayFrame& display) {
  std::string text = "{";
  for (size_t i = 0; i < kLayerNames.size(); ++i) {
    text += fmt::format(R"({}"{}":{})", i == 0 ? "" : ",", kLayerNames[i],
                        recon::SkeletonJsonLine(display.layers[i]));
  }
  return text + "}";
}

// Users and parts have one label per pixel of the depth image, or are absent.
bool HasLabels(const DisplayFrame& display, const depth::Image<uint8_t>& parts) {
  const size_t pixels = display.depth.depth_mm.size();
  return display.users.data.size() == pixels && parts.data.size() == pixels;
}

template <typename T>
void Append(std::string& bytes, const std::vector<T>& values) {
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

// Every step-th pixel of every step-th row of an image of `size` bytes a pixel.
void AppendThinned(std::string& bytes, const char* image, int width, int height, size_t size,
                   int step) {
  const auto row = static_cast<size_t>(width) * size;
  for (int v = 0; v < height; v += step) {
    const char* at = image + static_cast<size_t>(v) * row;
    for (int u = 0; u < width; u += step) bytes.append(at + static_cast<size_t>(u) * size, size);
  }
}

}  // namespace

PackedFrame Pack(const DisplayFrame& display, const depth::Image<uint8_t>& parts,
                 const recon::BodyMesh* body) {
  const depth::Camera& camera = display.depth.camera;
  PackedFrame packed;
  packed.members = fmt::format(
      R"("frame":{},"time_s":{},"camera":{},"layers":{},"ms":{},"dropped":{},"latency_ms":{:.2f},)"
      R"("meshes":{},"solids":{})",
      display.skeletons().frame, display.skeletons().time_s, CameraJson(camera),
      LayersJson(display), StagesJson(display.ms), display.dropped, display.latency_ms,
      body != nullptr ? MeshesJson(display.fits, body->vertices.size()) : "[]",
      SolidsJson(display.solids));
  if (body != nullptr) {
    for (const FittedBody& fit : display.fits) AppendMesh(packed.meshes, *body, fit.pose);
  }
  if (display.depth.depth_mm.empty()) return packed;
  packed.width = camera.width;
  packed.height = camera.height;
  packed.planes = HasLabels(display, parts) ? 3 : 1;
  packed.pictures.reserve(display.depth.depth_mm.size() * 4);
  Append(packed.pictures, display.depth.depth_mm);
  if (packed.planes == 1) return packed;
  Append(packed.pictures, display.users.data);
  Append(packed.pictures, parts.data);
  return packed;
}

std::string HeadOf(const PackedFrame& display, int64_t number, int step, std::string_view state) {
  std::string header =
      fmt::format(R"({{"number":{},"step":{},"width":{},"height":{},"planes":{},{},"state":{}}})",
                  number, step, (display.width + step - 1) / step,
                  (display.height + step - 1) / step, display.planes, display.members, state);
  header.resize((header.size() + 3) / 4 * 4, ' ');
  const auto length = static_cast<uint32_t>(header.size());
  std::string bytes;
  for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<char>(length >> shift));
  return bytes += header;
}

std::string ThinPictures(const PackedFrame& display, int step) {
  const auto pixels = static_cast<size_t>(display.width) * static_cast<size_t>(display.height);
  const char* image = display.pictures.data();
  std::string bytes;
  for (int plane = 0; plane < display.planes; ++plane) {
    const size_t size = plane == 0 ? 2 : 1;
    AppendThinned(bytes, image, display.width, display.height, size, step);
    image += pixels * size;
  }
  return bytes;
}

}  // namespace ossa::viewer
