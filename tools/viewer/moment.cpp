#include "tools/viewer/moment.h"

#include <utility>

#include "tools/tracker/skeleton_record.h"

namespace ossa::viewer {

Moment MakeMoment(depth::DepthFrame frame, tracker::BodyFrame bodies) {
  Moment moment;
  moment.layers = {ToRecord(bodies, tracker::PostureKind::kFinal),
                   ToRecord(bodies, tracker::PostureKind::kRefined),
                   ToRecord(bodies, tracker::PostureKind::kRaw)};
  moment.depth = std::move(frame);
  moment.users = std::move(bodies.users);
  moment.parts = std::move(bodies.parts);
  moment.ms = bodies.ms;
  for (const tracker::Body& body : bodies.bodies) {
    if (body.fit) moment.fits.push_back({body.id, body.fit->pose});
  }
  return moment;
}

Moment MakeMoment(recon::SkeletonFrame skeletons) {
  Moment moment;
  moment.depth.time_s = skeletons.time_s;
  moment.layers[0] = std::move(skeletons);
  return moment;
}

}  // namespace ossa::viewer
