// What an application that links an installed ossa looks like.
#include <tools/tracker/tracker.h>

#include <cstdio>

int main() {
  const ossa::depth::Camera camera = ossa::depth::KinectV1Camera(640, 480);
  std::printf("ossa is installed: %.0f px\n", camera.fx);
  return 0;
}
