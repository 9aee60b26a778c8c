#pragma once
#include "depth/image/depth_frame.h"
#include "tools/people/options.h"
#include "tools/tracker/tracker.h"

namespace ossa::tracker {

/// When it is worth finding out whether the camera hangs under the ceiling, and when that is
/// certain: never again once a floor was seen as level cameras see it, and not in every frame.
class MountFinder {
 public:
  /// Of a frame that was tracked as a level camera's: is it time to look?
  bool IsDue(const BodyFrame& tracked);
  /// What a look says; is it certain now? The first one decides alone, for stills and beginnings;
  /// later ones only three in a row, for who works before a wall all day is looked at often.
  bool Confirm(bool looks_down);

 private:
  bool is_level_ = false;
  double looked_s_ = -1e9;
  int looks_ = 0, agreeing_ = 0;
};

/// Whether a frame shows, from above, a floor that fills much of it and something with a head that
/// stands on it and does not go on below the image. Before a level camera a wall is as flat and as
/// far, but who stands there without a floor in view does go on.
bool MayBeFromAbove(const depth::DepthFrame& frame, const people::PeopleOptions& above);

}  // namespace ossa::tracker
