// What an application that links an installed ossa looks like: an empty room in, nobody out.
#include <tools/tracker/tracker.h>

#include <cstdio>

int main() {
  ossa::tracker::Tracker tracker;  // with the installed model and database
  ossa::depth::DepthFrame frame;
  frame.camera = ossa::depth::KinectV1Camera(640, 480);
  frame.depth_mm.assign(640 * 480, 3000);
  const auto seen = tracker.Track(frame);
  std::printf("ossa is installed and sees %zu people before a wall\n", seen.bodies.size());
  return seen.bodies.empty() ? 0 : 1;
}
