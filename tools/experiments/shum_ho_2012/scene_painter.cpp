#include "tools/experiments/shum_ho_2012/scene_painter.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "physics/anthropometry.h"

namespace ossa::tools {
namespace {

using Eigen::Vector3d;

// Red, green, blue.
const cv::Scalar kSky(250, 251, 253), kGrid(222, 226, 232), kShadow(200, 204, 212);
const std::array<cv::Scalar, 2> kPeople = {cv::Scalar(88, 130, 193), cv::Scalar(196, 110, 92)};
const cv::Scalar kTarget(226, 174, 0);
const std::array<cv::Scalar, 6> kThings = {cv::Scalar(214, 169, 108), cv::Scalar(146, 184, 134),
                                           cv::Scalar(203, 140, 124), cv::Scalar(163, 152, 196),
                                           cv::Scalar(128, 181, 187), cv::Scalar(221, 196, 124)};

class Painter {
 public:
  Painter(const SceneView& view, cv::Mat& image) : view_(view), image_(image) {
    forward_ = (view.look_at_m - view.eye_m).normalized();
    right_ = forward_.cross(Vector3d::UnitY()).normalized();
    up_ = right_.cross(forward_);
  }

  double Depth(const Vector3d& p) const { return forward_.dot(p - view_.eye_m); }
  double Pixels(double size_m, const Vector3d& at) const {
    return view_.focal_px * size_m / std::max(Depth(at), 0.1);
  }
  /// Fixed-point image position, sixteenths of a pixel.
  cv::Point At(const Vector3d& p) const {
    const double depth = std::max(Depth(p), 0.1);
    const double u = 0.5 * view_.width + view_.focal_px * right_.dot(p - view_.eye_m) / depth;
    const double v = 0.5 * view_.height - view_.focal_px * up_.dot(p - view_.eye_m) / depth;
    return {static_cast<int>(std::clamp(16.0 * u, -1e6, 1e6)),
            static_cast<int>(std::clamp(16.0 * v, -1e6, 1e6))};
  }

  void Line(const Vector3d& a, const Vector3d& b, const cv::Scalar& colour, double width_px) {
    cv::line(image_, At(a), At(b), colour, std::max(1, static_cast<int>(std::lround(width_px))),
             cv::LINE_AA, 4);
  }
  void Disc(const Vector3d& p, double radius_px, const cv::Scalar& colour) {
    cv::circle(image_, At(p), static_cast<int>(16.0 * radius_px), colour, cv::FILLED, cv::LINE_AA,
               4);
  }
  void Face(const std::vector<Vector3d>& corners, const cv::Scalar& colour) {
    std::vector<cv::Point> points;
    for (const Vector3d& c : corners) points.push_back(At(c));
    cv::fillConvexPoly(image_, points, colour, cv::LINE_AA, 4);
  }
  const Vector3d& forward() const { return forward_; }
  const SceneView& view() const { return view_; }

 private:
  SceneView view_;
  cv::Mat& image_;
  Vector3d forward_, right_, up_;
};

struct Piece {
  double depth;
  std::function<void()> draw;
};

Vector3d OnFloor(const Vector3d& p) { return {p.x(), 0.0, p.z()}; }
cv::Scalar Shade(const cv::Scalar& c, double by) { return {c[0] * by, c[1] * by, c[2] * by}; }

void PaintFloor(Painter& painter) {
  for (int i = -8; i <= 8; ++i) {
    const double at = 0.5 * i;
    painter.Line({at, 0.0, -4.0}, {at, 0.0, 4.0}, kGrid, 1.0);
    painter.Line({-4.0, 0.0, at}, {4.0, 0.0, at}, kGrid, 1.0);
  }
}

void AddLimb(Painter& painter, std::vector<Piece>& pieces, const Vector3d& from, const Vector3d& to,
             double radius_m, const cv::Scalar& colour) {
  const Vector3d middle = 0.5 * (from + to);
  painter.Line(OnFloor(from), OnFloor(to), kShadow,
               painter.Pixels(1.6 * radius_m, OnFloor(middle)));
  pieces.push_back({painter.Depth(middle), [&painter, from, to, radius_m, middle, colour] {
                      const double width = painter.Pixels(2.0 * radius_m, middle);
                      painter.Line(from, to, Shade(colour, 0.72), width + 1.5);
                      painter.Line(from, to, colour, 0.8 * width);
                    }});
}

void AddCharacter(Painter& painter, std::vector<Piece>& pieces, const recon::Posture& posture,
                  const cv::Scalar& colour) {
  const auto segments = physics::ComputeSegments(recon::MeasureBoneLengths(posture));
  for (size_t i = 1; i < recon::kJointCount; ++i) {
    const Vector3d from = posture.position_m[recon::ParentOf(i)];
    const Vector3d bone = posture.position_m[i] - from;
    AddLimb(painter, pieces, from + segments[i].capsule_from * bone,
            from + segments[i].capsule_to * bone, segments[i].radius_m, colour);
  }
}

void AddBox(Painter& painter, std::vector<Piece>& pieces, const physics::ObjectState& state,
            const Vector3d& size, const cv::Scalar& colour) {
  painter.Disc(OnFloor(state.position_m), painter.Pixels(0.5 * size.x(), OnFloor(state.position_m)),
               kShadow);
  pieces.push_back(
      {painter.Depth(state.position_m), [&painter, state, size, colour] {
         for (int axis = 0; axis < 3; ++axis) {
           for (const double sign : {1.0, -1.0}) {
             const Vector3d normal = state.orientation * Vector3d(sign * Vector3d::Unit(axis));
             const Vector3d centre = state.position_m + 0.5 * size[axis] * normal;
             if (normal.dot(centre - painter.view().eye_m) >= 0.0) continue;  // faces away
             const int b = (axis + 1) % 3, c = (axis + 2) % 3;
             const Vector3d eb = state.orientation * Vector3d(0.5 * size[b] * Vector3d::Unit(b));
             const Vector3d ec = state.orientation * Vector3d(0.5 * size[c] * Vector3d::Unit(c));
             const double light = 0.75 + 0.25 * normal.dot(Vector3d(0.3, 0.85, 0.4));
             painter.Face({centre + eb + ec, centre + eb - ec, centre - eb - ec, centre - eb + ec},
                          Shade(colour, light));
           }
         }
       }});
}

void AddObject(Painter& painter, std::vector<Piece>& pieces, const physics::ObjectState& state,
               const physics::ObjectOptions& info, const cv::Scalar& colour) {
  switch (info.shape) {
    case physics::Shape::kBox:
      AddBox(painter, pieces, state, info.size_m, colour);
      return;
    case physics::Shape::kCapsule: {
      const Vector3d half = state.orientation * Vector3d(0.0, 0.5 * info.size_m.y(), 0.0);
      AddLimb(painter, pieces, state.position_m - half, state.position_m + half,
              0.5 * info.size_m.x(), colour);
      return;
    }
    case physics::Shape::kBall:
      break;
  }
  const Vector3d at = state.position_m;
  const double radius = 0.5 * info.size_m.x();
  painter.Disc(OnFloor(at), painter.Pixels(radius, OnFloor(at)), kShadow);
  pieces.push_back({painter.Depth(at), [&painter, at, radius, colour] {
                      const double px = painter.Pixels(radius, at);
                      painter.Disc(at, px, Shade(colour, 0.72));
                      painter.Disc(at, std::max(0.8 * px, px - 1.5), colour);
                    }});
}

}  // namespace

Picture Paint(const physics::World& world, const SceneView& view, const SceneOverlay& overlay) {
  Picture picture(view.width, view.height);
  cv::Mat image(view.height, view.width, CV_8UC3, picture.rgb.data());
  image.setTo(kSky);
  Painter painter(view, image);
  PaintFloor(painter);
  std::vector<Piece> pieces;
  for (int c = 0; c < world.CharacterCount(); ++c) {
    AddCharacter(painter, pieces, world.StateOf(c).posture,
                 kPeople[static_cast<size_t>(c) % kPeople.size()]);
  }
  for (int k = 0; k < world.ObjectCount(); ++k) {
    AddObject(painter, pieces, world.ObjectOf(k), world.ObjectInfo(k),
              kThings[static_cast<size_t>(k) % kThings.size()]);
  }
  std::stable_sort(pieces.begin(), pieces.end(),
                   [](const Piece& a, const Piece& b) { return a.depth > b.depth; });
  for (const Piece& piece : pieces) piece.draw();
  for (const recon::Posture& target : overlay.targets) {
    for (size_t i = 1; i < recon::kJointCount; ++i) {
      painter.Line(target.position_m[recon::ParentOf(i)], target.position_m[i], kTarget, 1.0);
    }
  }
  cv::putText(image, overlay.caption, {6, 14}, cv::FONT_HERSHEY_SIMPLEX, 0.4,
              cv::Scalar(70, 74, 82), 1, cv::LINE_AA);
  return picture;
}

}  // namespace ossa::tools
