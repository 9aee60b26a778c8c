#pragma once
#include <array>
#include <functional>
#include <limits>

#include "tools/tracker/tracker.h"

namespace ossa::tracker {

/// What was found in the turned image, in the camera's own space and image: positions, floor,
/// orientations, users and parts, and the borders that cut bodies off.
void TurnBack(BodyFrame& frame, int quarters);

/// How surely somebody stands upright in the frame once it is turned clockwise by so many quarters;
/// 0: nobody is found.
using ScoreOfTurn = std::function<double(const depth::DepthFrame& frame, int quarters)>;

/// Constants: by hand, between people upright and the same clips turned
/// (tests/tools/tracker/upright_test.cpp).
struct UprightOptions {
  double sure = 0.8;      // score, [0, 1], of somebody who is there
  double clearly = 0.15;  // score by which another turn must beat the present one, [0, 1]
  double every_s = 1.0;   // between looks while nobody is followed, > 0
  int agreeing = 3;       // looks, > 0, that must agree
  double shared_s =
      0.1;  // frames that follow sooner, seconds, share a look: each way costs a frame
};

/// Finds out how far a camera's images must be turned for people to stand in them. As long as
/// somebody is followed nothing is asked and nothing changes. Else, about once a second, all four
/// ways are looked at; three looks that agree turn the images. An upright camera wins whenever
/// somebody sure is seen upright. The first look, and one that is to confirm another, is at one
/// frame; where nobody is in view four frames in a row share it.
class UprightFinder {
 public:
  int quarters() const { return quarters_; }
  /// Whether somebody was surely seen the way it is: no other need be tried.
  bool is_sure() const { return sure_; }

  /// Looks if it is time to; true if the turn changed, so that all that is followed is void.
  bool Look(const depth::DepthFrame& frame, const ScoreOfTurn& score);
  void Followed(double time_s) { followed_s_ = time_s; }

 private:
  bool AskWays(const depth::DepthFrame& frame, int most, const ScoreOfTurn& score);
  int BestTurn() const;

  static constexpr int kTurns = 4;
  static constexpr double kNever = -std::numeric_limits<double>::infinity();
  UprightOptions options_;
  int quarters_ = 0;
  bool sure_ = false;
  int candidate_ = 0;                    // the turn that the last looks were for
  int agreeing_ = 0;                     // so many of them
  std::array<double, kTurns> scores_{};  // of the ways asked in this look
  int asked_ = 0;                        // so many; 0: none goes on
  double before_s_ = kNever;             // the frame before
  double looked_s_ = kNever;
  double followed_s_ = kNever;
};

}  // namespace ossa::tracker
