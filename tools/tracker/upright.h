#pragma once
#include <array>
#include <functional>
#include <limits>

#include "tools/tracker/tracker.h"

namespace ossa::tracker {

/// Transforms the result of a rotated image back into the camera's own space and image: positions,
/// floor, orientations, users, parts and clipped edges.
void TurnBack(BodyFrame& frame, int quarters);

/// The person with the highest score in a rotated frame.
struct TurnScore {
  double score = 0.0;  // [0, 1]; 0 without people
  // They may be on their side: cut off by the border of the image, or wider than high.
  bool is_doubtful = false;
};
/// The score of a frame after rotating it clockwise by `quarters`.
using ScoreOfTurn = std::function<TurnScore(const depth::DepthFrame& frame, int quarters)>;

/// Constants: by hand, between upright people and the same clips rotated
/// (tests/tools/tracker/upright_test.cpp).
struct UprightOptions {
  double sure = 0.8;       // person score, [0, 1], that counts as certain
  double clearly = 0.15;   // margin, score in [0, 1], of another rotation over the current one
  double every_s = 1.0;    // between searches while no person is tracked, > 0
  int agreeing = 3;        // searches, > 0, that must agree
  int most_contested = 9;  // searches, > 0, in which several rotations are compared by their means
  double shared_s = 0.1;   // frame interval, seconds, below which a search is spread over four
                           // frames: each rotation costs as much as a frame
};

/// Finds the image rotation of a camera. While a person is tracked nothing changes. Otherwise all
/// four rotations are scored about once a second, and three searches that agree change the
/// rotation. The current rotation is kept if it has a certain person; but at first, somebody near,
/// whom the image cuts off, may look like a person in several rotations, also on their side: then
/// the mean over the next searches decides, also while a person is tracked. The first search, and
/// one that confirms another, uses a single frame; others are spread over four consecutive frames.
class UprightFinder {
 public:
  int quarters() const { return quarters_; }
  /// Whether a certain person was found, so that no further search is needed.
  bool is_sure() const { return sure_; }

  /// Searches if it is time to; true if the rotation changed, which invalidates all tracks.
  bool Update(const depth::DepthFrame& frame, const ScoreOfTurn& score);
  void NoteTracked(double time_s) { tracked_s_ = time_s; }

 private:
  bool ScoreRotations(const depth::DepthFrame& frame, int most, const ScoreOfTurn& score);
  int FindBestTurn() const;
  bool IsContested() const;
  // The rotation by the means of a contested search and those after it; none: not decided yet.
  std::optional<int> CompareMeans();
  bool Choose(int turn);

  static constexpr int kTurns = 4;
  static constexpr double kNever = -std::numeric_limits<double>::infinity();
  UprightOptions options_;
  int quarters_ = 0;
  bool sure_ = false;
  int candidate_ = 0;                    // the rotation that the last searches agree on
  int agreeing_ = 0;                     // number of these searches
  std::array<double, kTurns> scores_{};  // of the rotations scored in this search
  std::array<double, kTurns> sums_{};    // over a contested search and those after it
  int contested_ = 0;                    // number of these searches
  int scored_ = 0;                       // number of rotations scored; 0: no search is in progress
  double previous_s_ = kNever;           // time of the frame before
  double searched_s_ = kNever;
  double tracked_s_ = kNever;
};

}  // namespace ossa::tracker
