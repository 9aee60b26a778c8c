// Follows everybody before a depth camera, or in a recording, and prints where their heads are.
//
//   live_tracker [SOURCE]     openni: (the first camera) if left out; else as `ossa track SOURCE`
#include <ossa/ossa.h>

#include <cstdio>
#include <exception>

using ossa::recon::Joint;
using ossa::recon::TrackingState;

int main(int argc, char** argv) {
  try {
    const auto source = ossa::depth::OpenSource(argc > 1 ? argv[1] : "openni:");
    ossa::tracker::Tracker tracker;
    tracker.Run(*source, [](const ossa::tracker::BodyFrame& frame) {
      for (const ossa::tracker::Body& body : frame.bodies) {
        const ossa::tracker::JointEstimate& head = body.joints[Joint::kHead];
        const bool seen = head.state == TrackingState::kTracked;
        std::printf("%.3f s: person %d has the head at %.2f %.2f %.2f m, %s\n", frame.time_s,
                    body.id, head.position_m.x(), head.position_m.y(), head.position_m.z(),
                    seen ? "seen" : "guessed");
      }
      return true;  // go on
    });
  } catch (const std::exception& error) {
    std::fprintf(stderr, "live_tracker: %s\n", error.what());
    return 1;
  }
}
