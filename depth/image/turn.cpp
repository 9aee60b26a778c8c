#include "depth/image/turn.h"

#include <algorithm>
#include <cstdlib>

namespace ossa::depth {

Camera Turned(const Camera& camera, int quarters) {
  const double right = camera.width - 1 - camera.cx, below = camera.height - 1 - camera.cy;
  const Camera& c = camera;
  switch (quarters) {
    case 1:
      return {c.height, c.width, c.fy, c.fx, below, c.cx};
    case 2:
      return {c.width, c.height, c.fx, c.fy, right, below};
    case 3:
      return {c.height, c.width, c.fy, c.fx, c.cy, right};
    default:
      return camera;
  }
}

DepthFrame Turned(const DepthFrame& frame, int quarters) {
  if (quarters == 0) return frame;
  Image<uint16_t> image(frame.camera.width, frame.camera.height);
  const DepthView view = frame.view();
  for (int v = 0; v < view.height; ++v) {
    std::copy_n(&view.data_mm[static_cast<ptrdiff_t>(v) * view.stride], view.width,
                &image.at(0, v));
  }
  return {
      Turned(image, quarters).data, Turned(frame.camera, quarters), frame.time_s, frame.index, {}};
}

Camera Unmirrored(const Camera& camera) {
  Camera unmirrored = camera;
  unmirrored.cx = camera.width - 1 - camera.cx;
  return unmirrored;
}

DepthFrame Unmirrored(const DepthFrame& frame) {
  const DepthView view = frame.view();
  DepthFrame made;
  made.depth_mm.resize(static_cast<size_t>(view.width) * static_cast<size_t>(view.height));
  for (int v = 0; v < view.height; ++v) {
    const uint16_t* row = view.data_mm + static_cast<ptrdiff_t>(v) * view.stride;
    std::reverse_copy(row, row + view.width,
                      made.depth_mm.begin() + static_cast<ptrdiff_t>(v) * view.width);
  }
  made.camera = Unmirrored(frame.camera);
  made.time_s = frame.time_s;
  made.index = frame.index;
  return made;
}

// A pixel's offset from the centre is (-x, -y): what is below the centre, at -y, moves to its left,
// at x.
Eigen::Matrix3d CameraFromTurned(int quarters) {
  Eigen::Matrix3d quarter;
  quarter << 0, 1, 0,  //
      -1, 0, 0,        //
      0, 0, 1;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  for (int i = 0; i < quarters; ++i) turn = turn * quarter;
  return turn;
}

}  // namespace ossa::depth
