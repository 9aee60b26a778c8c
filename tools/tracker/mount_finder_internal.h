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
/// stands on it. Before a level camera a wall is as flat and as far. But who stands there without a
/// floor in view goes on below the image: where `somebody_is_level`, a body whose surface explains
/// what a level camera would see, such heads do not count.
bool MayBeFromAbove(const depth::DepthFrame& frame, const people::PeopleOptions& above,
                    bool somebody_is_level);

}  // namespace ossa::tracker
