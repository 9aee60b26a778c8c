#include "tools/tracker/picture.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "depth/base/atomic_file.h"
#include "depth/image/colour_png.h"
#include "depth/image/packed_depth.h"
#include "recon/body/parts.h"

namespace ossa::tracker {
namespace {

using recon::kJointCount;
using recon::TrackingState;

// Constants: pixels, by eye.

constexpr int kPanelWidth = 480, kPanelHeight = 960;  // at most

cv::Mat DepthPanel(const depth::DepthFrame& frame) {
  std::vector<uint16_t> buffer, sorted;
  for (const uint16_t mm : depth::PackedDepth(frame.view(), buffer)) {
    if (mm > 0) sorted.push_back(mm);
  }
  std::sort(sorted.begin(), sorted.end());
  const auto rank = [&](double share) {
    if (sorted.empty()) return 0.0;
    return static_cast<double>(
        sorted[static_cast<size_t>(share * static_cast<double>(sorted.size() - 1))]);
  };
  const double near = rank(0.01), far = std::max(rank(0.97), near + 1);
  cv::Mat panel(frame.camera.height, frame.camera.width, CV_8UC3, cv::Scalar::all(0));
  for (int v = 0; v < panel.rows; ++v) {
    for (int u = 0; u < panel.cols; ++u) {
      const uint16_t mm = frame.view().at(u, v);
      if (mm == 0) continue;
      const double share = std::clamp((mm - near) / (far - near), 0.0, 1.0);
      const auto grey = static_cast<uint8_t>(235 - 190 * share);
      panel.at<cv::Vec3b>(v, u) = {grey, grey, grey};
    }
  }
  return panel;
}

cv::Scalar BodyColour(int id) {
  static const cv::Scalar colours[] = {{80, 200, 255},  {120, 255, 120}, {255, 160, 90},
                                       {200, 120, 255}, {255, 255, 110}, {110, 130, 255}};
  return colours[static_cast<size_t>(std::max(0, id - 1)) % std::size(colours)];
}

cv::Mat PartsPanel(const depth::DepthFrame& frame, const BodyFrame& bodies) {
  cv::Mat panel = 0.4 * DepthPanel(frame);
  const bool parts = bodies.parts.data.size() == frame.pixel_count();
  for (int v = 0; v < panel.rows; ++v) {
    for (int u = 0; u < panel.cols; ++u) {
      const uint8_t id = bodies.users.at(u, v);
      if (id == 0) continue;
      const recon::Rgb c = recon::PartColour(parts ? bodies.parts.at(u, v) : 1 + id % 31);
      panel.at<cv::Vec3b>(v, u) = {c.b, c.g, c.r};
    }
  }
  return panel;
}

bool Drawable(const Eigen::Vector3d& p) { return p.allFinite() && p.z() > 0.1 && p.norm() < 20; }

cv::Point ProjectToPixel(const depth::Camera& camera, const Eigen::Vector3d& p) {
  const Eigen::Vector2d pixel = depth::Project(camera, p);
  return {static_cast<int>(std::clamp(pixel.x(), -4000.0, 4000.0)),
          static_cast<int>(std::clamp(pixel.y(), -4000.0, 4000.0))};
}

void DrawJoints(cv::Mat& panel, const depth::Camera& camera, const recon::Posture& posture,
                const Body& body, bool bones, bool all) {
  const int thick = std::max(1, camera.width / 200);
  const auto shown = [&](size_t j) {
    return Drawable(posture.position_m[j]) &&
           (all || body.joints[j].state != TrackingState::kNotTracked);
  };
  for (size_t j = 1; bones && j < kJointCount; ++j) {
    const auto parent = recon::ParentOf(j);
    if (!shown(j) || !shown(parent)) continue;
    const bool seen = body.joints[j].state == TrackingState::kTracked;
    cv::line(panel, ProjectToPixel(camera, posture.position_m[parent]),
             ProjectToPixel(camera, posture.position_m[j]),
             seen ? BodyColour(body.id) : cv::Scalar(110, 110, 110), seen ? thick : 1, cv::LINE_AA);
  }
  for (size_t j = 0; j < kJointCount; ++j) {
    if (!shown(j)) continue;
    const bool seen = body.joints[j].state == TrackingState::kTracked;
    // The person's left is drawn in red, the right in blue, the middle in white.
    const bool middle = recon::kMirroredJoint[j] == j;
    const bool left = recon::kMirroredJoint[j] > j;
    const cv::Scalar colour = middle ? cv::Scalar(255, 255, 255)
                                     : (left ? cv::Scalar(60, 60, 255) : cv::Scalar(255, 140, 40));
    cv::circle(panel, ProjectToPixel(camera, posture.position_m[j]), 2 * thick, colour,
               seen ? cv::FILLED : 1, cv::LINE_AA);
  }
}

cv::Mat SkeletonPanel(const depth::DepthFrame& frame, const BodyFrame& bodies, bool raw) {
  cv::Mat panel = 0.6 * DepthPanel(frame);
  for (const Body& body : bodies.bodies) {
    if (body.state != BodyState::kTracked) continue;
    DrawJoints(panel, frame.camera, raw ? body.raw.posture : ToPosture(body), body, !raw, !raw);
  }
  return panel;
}

}  // namespace

void WritePicture(const std::filesystem::path& path, const depth::DepthFrame& frame,
                  const BodyFrame& bodies) {
  std::vector<cv::Mat> panels = {DepthPanel(frame), PartsPanel(frame, bodies),
                                 SkeletonPanel(frame, bodies, true),
                                 SkeletonPanel(frame, bodies, false)};
  for (cv::Mat& panel : panels) {
    const double scale = std::min(static_cast<double>(kPanelWidth) / panel.cols,
                                  static_cast<double>(kPanelHeight) / panel.rows);
    const auto scaled = [&](int size) { return std::max(1, static_cast<int>(size * scale)); };
    cv::resize(panel, panel, {scaled(panel.cols), scaled(panel.rows)}, 0, 0, cv::INTER_AREA);
  }
  cv::Mat row;
  cv::hconcat(panels, row);
  cv::cvtColor(row, row, cv::COLOR_BGR2RGB);
  const std::vector<uint8_t> png =
      depth::EncodeColourPng({row.data, row.total() * row.elemSize()}, {row.cols, row.rows}, 3);
  AtomicFile file(path);
  file.stream().write(reinterpret_cast<const char*>(png.data()),
                      static_cast<std::streamsize>(png.size()));
  file.Commit();
}

}  // namespace ossa::tracker
