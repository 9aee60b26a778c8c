#include "tools/learning/segmented_person.h"

#include <algorithm>
#include <cstddef>

#include "depth/scene/point_grid.h"
#include "depth/scene/regions.h"
#include "recon/body/parts.h"

namespace ossa::tools {
namespace {

// Constants: of the Kinect v1's range.

// Gaps that the tracker's regions bridge: depth::kStepsOverGaps.
constexpr int kCellsOver = 2;

bool IsContinuous(uint16_t a_mm, uint16_t b_mm) {
  return depth::Continuous(1e-3F * static_cast<float>(a_mm), 1e-3F * static_cast<float>(b_mm));
}

// Precondition: the floor is known.
bool MayBeFloor(const LabelledFrame& frame, int u, int v) {
  const Eigen::Vector3d place_m =
      depth::BackProject(frame.depth.camera, u, v, frame.depth.view().at(u, v));
  return depth::IsOnOrBelow({*frame.floor}, place_m.cast<float>());
}

}  // namespace

std::vector<uint8_t> SegmentedPerson(const LabelledFrame& frame, int id) {
  const depth::DepthView view = frame.depth.view();
  std::vector<uint8_t> is_person(frame.depth.depth_mm.size(), 0);
  std::vector<int> front;
  bool has_things = false;
  for (size_t i = 0; i < is_person.size(); ++i) {
    const uint8_t part = frame.parts.data[i];
    if (frame.users.data[i] != id || part == 0) continue;
    has_things = has_things || part == recon::kOtherPart;
    if (part == recon::kOtherPart) continue;
    if (frame.depth.depth_mm[i] == 0) continue;
    const auto u = static_cast<int>(i) % view.width, v = static_cast<int>(i) / view.width;
    if (frame.floor && MayBeFloor(frame, u, v)) continue;
    is_person[i] = 1;
    front.push_back(static_cast<int>(i));
  }
  if (!has_things) return is_person;
  const int reach = kCellsOver * depth::CellPixels(view.width);
  for (size_t f = 0; f < front.size(); ++f) {
    const int at = front[f], u = at % view.width, v = at / view.width;
    const auto join = [&](int other_u, int other_v) {
      if (other_u < 0 || other_u >= view.width || other_v < 0 || other_v >= view.height) return;
      const int other = other_v * view.width + other_u;
      const auto o = static_cast<size_t>(other);
      if (is_person[o] != 0 || frame.parts.data[o] != recon::kOtherPart) return;
      if (frame.users.data[o] != id || frame.depth.depth_mm[o] == 0) return;
      if (!IsContinuous(frame.depth.depth_mm[static_cast<size_t>(at)], frame.depth.depth_mm[o]))
        return;
      is_person[o] = 1;
      front.push_back(other);
    };
    for (int step = 1; step <= reach; ++step) {
      join(u - step, v);
      join(u + step, v);
      join(u, v - step);
      join(u, v + step);
    }
  }
  return is_person;
}

std::optional<SegmentedFrame> ReadSegmented(const DatasetReader& reader, int64_t index) {
  constexpr int kFewest = 200;  // pixels: fewer are a hand or a head
  SegmentedFrame out;
  out.frame = Uncropped(reader.Read(index), reader.manifest().camera);
  const std::vector<TruthBody>& bodies = out.frame.bodies;
  if (bodies.empty()) return std::nullopt;
  LayFloor(&out.frame);
  out.body = bodies[static_cast<size_t>(index) % bodies.size()];
  out.is_person = SegmentedPerson(out.frame, out.body.id);
  if (std::ranges::count(out.is_person, 1) < kFewest) return std::nullopt;
  return out;
}

void LayFloor(LabelledFrame* frame) {
  if (!frame->floor) return;
  constexpr double kNearest_m = 0.4, kFarthest_m = 8.0;  // of what a sensor measures
  const depth::Camera& camera = frame->depth.camera;
  const Eigen::Vector3d normal = frame->floor->head<3>();
  const auto towards = [&](double u, double v) {  // the floor, a metre along the axis
    return normal.dot(depth::BackProject(camera, u, v, 1e3));
  };
  for (int v = 0; v < camera.height; ++v) {
    const double start = towards(0, v), step = towards(1, v) - start;
    for (int u = 0; u < camera.width; ++u) {
      uint16_t& depth_mm = frame->depth.depth_mm[static_cast<size_t>(v * camera.width + u)];
      if (depth_mm != 0) continue;
      const double z_m = -(*frame->floor)[3] / (start + u * step);
      if (z_m > kNearest_m && z_m < kFarthest_m) {
        depth_mm = static_cast<uint16_t>(1e3 * z_m + 0.5);
      }
    }
  }
}

}  // namespace ossa::tools
