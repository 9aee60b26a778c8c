#pragma once
#include "depth/image/depth_frame.h"
#include "tools/people/options.h"
#include "tools/tracker/tracker.h"

namespace ossa::tracker {

/// What tells a camera under the ceiling. Constants: shares, or as said; by hand on the dev stills
/// of `ossa experiment real` and on rendered people, level and from above
/// (tests/tools/tracker/mount_test.cpp).
struct MountOptions {
  double every_s = 1.0;  // between looks, > 0: one costs some milliseconds
  int agreeing = 3;      // looks in a row, > 0, as of UprightOptions
  // Score, [0, 1], where no floor is seen as level cameras see it, and where one is. Real stills
  // from the ceiling have 0.80 and more. Of 880 rendered and real level images without a floor
  // three have 0.94 and more, the others 0.63 and less; with one two have 0.80 and 0.95.
  double sure = 0.75, sure_despite_floor = 0.97;
  float min_head_m = 1.0F;    // anthropometry: over the floor, of who sits; a wall has lower bumps
  double floor_share = 0.15;  // of what is measured, [0, 1], that is floor
  float piece_m2 = 0.02F;     // anthropometry: a hand; smaller pieces say nothing
  double cut_share = 0.65;    // of a body, [0, 1]: more of it goes on below a level camera's image
  double rim_share = 0.03;    // of the image's height, [0, 1]: a sensor's rims are blind
};

/// Whether a frame that was tracked as a level camera's shows somebody who speaks for one: who had
/// to be joined of pieces may as well be one seen from above.
bool ShowsSomebody(const BodyFrame& tracked);

/// When it is worth finding out whether the camera hangs under the ceiling, and when that is
/// certain: not in every frame, and never again once somebody on a floor was tracked as level
/// cameras see them in several looks in a row. A floor alone says little: from the ceiling a wall
/// passes for one.
class MountFinder {
 public:
  /// What a look says of the camera; unknown where nobody is in view.
  enum class View { kUnknown, kLevel, kFromAbove };

  /// Of a frame that was tracked as a level camera's: is it time to look?
  bool IsDue(const BodyFrame& tracked);
  /// May what goes on below the image count? Not at the first look, which decides alone, and not
  /// where somebody was tracked as a level camera's.
  bool MayBeCutBelow(const BodyFrame& tracked) const;
  /// Is it certain now that the camera looks down? The first look decides alone, for stills and
  /// beginnings; later ones only several in a row, for who works before a wall all day is looked at
  /// often.
  bool Confirm(View seen);

  const MountOptions& options() const { return options_; }

 private:
  MountOptions options_;
  bool is_level_ = false;
  double looked_s_ = -1e9;
  int looks_ = 0, above_looks_ = 0;
  int level_looks_ = 0;  // at somebody on a level floor
};

/// Whether a frame shows, from above, a floor that fills much of it and something with a head that
/// stands on it. Before a level camera a wall is as flat and as far, but who stands there without a
/// floor in view goes on below the image: that counts only if it `may_be_cut_below`.
bool MayBeFromAbove(const depth::DepthFrame& frame, bool may_be_cut_below,
                    const people::PeopleOptions& above, const MountOptions& options = {});

}  // namespace ossa::tracker
