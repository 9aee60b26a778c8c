#include "tools/viewer/display_frame.h"

#include <utility>

#include "tools/tracker/skeleton_record.h"

namespace ossa::viewer {

DisplayFrame MakeDisplayFrame(depth::DepthFrame frame, tracker::BodyFrame bodies) {
  DisplayFrame display;
  display.layers = {ToRecord(bodies, tracker::PostureKind::kFinal),
                    ToRecord(bodies, tracker::PostureKind::kRefined),
                    ToRecord(bodies, tracker::PostureKind::kRaw)};
  display.depth = std::move(frame);
  display.users = std::move(bodies.users);
  display.parts = std::move(bodies.parts);
  display.ms = bodies.ms;
  for (const tracker::Body& body : bodies.bodies) {
    if (body.fit) display.fits.push_back({body.id, body.fit->pose});
  }
  return display;
}

DisplayFrame MakeDisplayFrame(recon::SkeletonFrame skeletons) {
  DisplayFrame display;
  display.depth.time_s = skeletons.time_s;
  display.layers[0] = std::move(skeletons);
  return display;
}

}  // namespace ossa::viewer
