#pragma once
#include <limits>

#include "depth/image/depth_frame.h"
#include "tools/people/options.h"
#include "tools/tracker/tracker.h"

namespace ossa::tracker {

/// Thresholds for detecting a camera under the ceiling. Constants: shares, or as said; by hand on
/// the dev stills of `ossa experiment real` and on rendered people, level and from above
/// (tests/tools/tracker/mount_test.cpp).
struct MountOptions {
  double every_s = 1.0;   // between checks, > 0: one costs some milliseconds
  double seldom_s = 5.0;  // ... by both kinds of models while nobody is in view: these take longer
  int agreeing = 3;       // consecutive checks, > 0, as in UprightOptions
  // Least score, [0, 1], and the same where the level models see a floor or a certain person. Real
  // stills from the ceiling have 0.80 and more, those with a certain level person 0.99. Of 880
  // rendered and real level images without a floor three have 0.94 and more, the others 0.63 and
  // less; with one two have 0.80 and 0.95. Behind a counter people before a wall have up to 0.97.
  double sure = 0.75, sure_despite_level = 0.97;
  // Person scores of the level models, [0, 1], and where the ceiling's models find nobody: of 188
  // real frames from the ceiling two have the second.
  double level_person = 0.98, only_level_person = 0.9;
  float min_head_m =
      1.0F;  // anthropometry: above the floor, of a sitting person; a wall has lower bumps
  double floor_share = 0.15;  // of the valid cells, [0, 1], that are floor
  float piece_m2 = 0.02F;     // anthropometry: a hand; smaller regions are ignored
  double cut_share = 0.65;    // of a body, [0, 1]: a level camera's image cuts off more of it
  double rim_share = 0.03;  // of the image's height, [0, 1]: sensors leave margins without readings
};

/// Whether the level tracking of a frame is evidence for a level camera: it has a person who was
/// not joined from pieces, which also happens from above.
bool ShowsPerson(const BodyFrame& tracked);

/// The highest person score, [0, 1]; 0 without bodies.
double HighestScore(const BodyFrame& tracked);

/// Whether what the level models found in a frame is evidence for a level camera: a floor or a
/// certain person.
bool SeemsLevel(const BodyFrame& tracked, const MountOptions& options);

/// Decides when to check for a camera under the ceiling and when the result is certain: not in
/// every frame, and never again after a person on a floor was tracked by the level models in
/// several consecutive checks. A floor alone is weak evidence: from the ceiling a wall is detected
/// as floor.
class MountFinder {
 public:
  /// The result of a check; unknown without people in view.
  enum class View { kUnknown, kLevel, kFromAbove };

  /// Whether a frame that was tracked with the level models is to be checked.
  bool IsDue(const BodyFrame& tracked);
  /// Whether regions cut off by the lower image border count: not in the first check, which decides
  /// alone, and not if a person was tracked by the level models.
  bool MayBeCutBelow(const BodyFrame& tracked) const;
  /// Adds a check; returns whether the camera is certainly under the ceiling. The first check
  /// decides alone, for stills; later ones only several in a row, because a person who works in
  /// front of a wall is checked often.
  bool Confirm(View seen);

  const MountOptions& options() const { return options_; }

 private:
  MountOptions options_;
  bool is_level_ = false;
  double checked_s_ = -std::numeric_limits<double>::infinity();
  int checks_ = 0, above_checks_ = 0;
  int level_checks_ = 0;  // checks with a person on a level floor
};

/// Reconsiders a camera that was decided to be under the ceiling: one image without a floor, such
/// as somebody near a camera on a table, may look so, and all after it would be lost. Both kinds of
/// models track a frame a second until they agree in several.
class MountRevision {
 public:
  explicit MountRevision(double decided_s) : checked_s_(decided_s) {}
  /// Whether the frame of this time is to be tracked by the level models, too.
  bool IsDue(double time_s);
  /// Adds what the level models, without earlier frames, and those for the ceiling found in a
  /// frame. Returns kFromAbove or kLevel if that is certain now, else kUnknown.
  MountFinder::View Add(const BodyFrame& level, const BodyFrame& from_above);

 private:
  MountOptions options_;
  double checked_s_;
  double every_s_ = options_.every_s;                     // grows while nobody is in view
  MountFinder::View seen_ = MountFinder::View::kUnknown;  // by the last checks that showed a person
  int agreeing_ = 0;                                      // consecutive ones
};

/// Whether a frame shows, seen from above, a floor that fills much of it and a candidate with a
/// head standing on it. For a level camera a wall is as flat and as far, but a person in front of
/// it without a visible floor is cut off by the lower image border: such candidates count only if
/// `may_be_cut_below`.
bool MayBeFromAbove(const depth::DepthFrame& frame, bool may_be_cut_below,
                    const people::PeopleOptions& above, const MountOptions& options = {});

}  // namespace ossa::tracker
