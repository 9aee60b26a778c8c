#include "tools/nite2/lone_hands.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace ossa::nite2 {
namespace {

// The image in cells, each with the point at its central pixel, camera space; z is 0 without a
// reading.
class Cells {
 public:
  Cells(const depth::DepthFrame& image, const depth::Image<uint8_t>& users,
        const LoneHandOptions& options);

  size_t count() const { return points_m_.size(); }
  bool Has(size_t cell) const { return points_m_[cell].z() > 0; }
  const Eigen::Vector3d& operator[](size_t cell) const { return points_m_[cell]; }
  bool IsAtBorder(size_t cell) const {
    const size_t x = cell % width_, y = cell / width_;
    return x == 0 || y == 0 || x + 1 == width_ || y + 1 == height_;
  }
  double Area_m2(size_t cell) const { return std::pow(points_m_[cell].z() * cell_rad_, 2); }

  // Calls visit(neighbour, whether the surface continues there) for the up to four neighbours of a
  // cell.
  template <typename Visit>
  void ForNeighbours(size_t cell, const Visit& visit) const {
    const size_t x = cell % width_, y = cell / width_;
    const auto tell = [&](size_t other) {
      visit(other,
            Has(other) && std::abs(points_m_[other].z() - points_m_[cell].z()) <= options_.jump_m);
    };
    if (x > 0) tell(cell - 1);
    if (x + 1 < width_) tell(cell + 1);
    if (y > 0) tell(cell - width_);
    if (y + 1 < height_) tell(cell + width_);
  }

  // The cell nearest to a point, within `most_m`.
  std::optional<size_t> Nearest(const Eigen::Vector3d& place_m, double most_m) const;

 private:
  LoneHandOptions options_;
  size_t width_, height_;
  double cell_rad_;
  std::vector<Eigen::Vector3d> points_m_;
};

Cells::Cells(const depth::DepthFrame& image, const depth::Image<uint8_t>& users,
             const LoneHandOptions& options)
    : options_(options) {
  const depth::Camera& camera = image.camera;
  const int step = std::max(1, camera.width / options.across);
  width_ = static_cast<size_t>(camera.width / step);
  height_ = static_cast<size_t>(camera.height / step);
  cell_rad_ = step / camera.fx;
  points_m_.assign(width_ * height_, Eigen::Vector3d::Zero());
  const depth::DepthView depth = image.view();
  for (size_t cell = 0; cell < points_m_.size(); ++cell) {
    const int u = static_cast<int>(cell % width_) * step + step / 2;
    const int v = static_cast<int>(cell / width_) * step + step / 2;
    const double z_m = 1e-3 * depth.at(u, v);
    const auto pixel =
        static_cast<size_t>(v) * static_cast<size_t>(camera.width) + static_cast<size_t>(u);
    if (z_m > options.farthest_m || (!users.data.empty() && users.data[pixel] != 0)) continue;
    points_m_[cell] = {(camera.cx - u) * z_m / camera.fx, (camera.cy - v) * z_m / camera.fy, z_m};
  }
}

std::optional<size_t> Cells::Nearest(const Eigen::Vector3d& place_m, double most_m) const {
  std::optional<size_t> nearest;
  double nearest_m2 = most_m * most_m;
  for (size_t cell = 0; cell < points_m_.size(); ++cell) {
    if (!Has(cell)) continue;
    const double distance_m2 = (points_m_[cell] - place_m).squaredNorm();
    if (distance_m2 > nearest_m2) continue;
    nearest_m2 = distance_m2;
    nearest = cell;
  }
  return nearest;
}

// The connected surface around a cell within a ball, and where it continues.
struct Piece {
  std::vector<size_t> cells;
  std::vector<size_t> ends;  // cells at the ball's surface or the image's border
  int border = 0;            // sides of cells where the piece ends
  int cut = 0;               // of these, sides where the surface continues beyond the ball
};

Piece GrowRegion(const Cells& cells, size_t seed, double radius_m) {
  Piece piece;
  std::vector<bool> taken(cells.count());
  taken[seed] = true;
  piece.cells.push_back(seed);
  for (size_t i = 0; i < piece.cells.size(); ++i) {
    const size_t cell = piece.cells[i];
    bool is_end = cells.IsAtBorder(cell);
    cells.ForNeighbours(cell, [&](size_t other, bool goes_on) {
      const bool is_inside = goes_on && (cells[other] - cells[seed]).norm() <= radius_m;
      if (!is_inside) ++piece.border;
      if (goes_on && !is_inside) {
        ++piece.cut;
        is_end = true;
      }
      if (!is_inside || taken[other]) return;
      taken[other] = true;
      piece.cells.push_back(other);
    });
    if (is_end) piece.ends.push_back(cell);
  }
  return piece;
}

Eigen::Vector3d ComputeMean(const Cells& cells, const std::vector<size_t>& some) {
  Eigen::Vector3d sum_m = Eigen::Vector3d::Zero();
  for (const size_t cell : some) sum_m += cells[cell];
  return sum_m / static_cast<double>(some.size());
}

struct HandAndElbow {
  Eigen::Vector3d hand_m, elbow_m;
};

// The hand of the arm that a cell belongs to, if that is one.
std::optional<HandAndElbow> FindHandOf(const Cells& cells, size_t seed,
                                       const LoneHandOptions& options) {
  const Piece arm = GrowRegion(cells, seed, options.arm_m);
  size_t tip = seed;
  // Without an end the arm points at the sensor, or is out of view.
  const Eigen::Vector3d elbow_m = ComputeMean(cells, arm.ends.empty() ? arm.cells : arm.ends);
  for (const size_t cell : arm.cells) {
    if ((cells[cell] - elbow_m).norm() > (cells[tip] - elbow_m).norm()) tip = cell;
  }
  const Piece hand = GrowRegion(cells, tip, options.hand_m);
  double area_m2 = 0.0;
  for (const size_t cell : hand.cells) area_m2 += cells.Area_m2(cell);
  if (area_m2 < options.least_m2 || area_m2 > options.most_m2) return std::nullopt;
  if (hand.cut > options.most_cut * hand.border) return std::nullopt;
  return HandAndElbow{ComputeMean(cells, hand.cells), elbow_m};
}

// Candidates for hands: the nearest point to the sensor and the top of each connected surface.
std::vector<size_t> FindCandidates(const Cells& cells) {
  std::vector<size_t> found;
  std::vector<bool> taken(cells.count());
  for (size_t seed = 0; seed < cells.count(); ++seed) {
    if (taken[seed] || !cells.Has(seed)) continue;
    taken[seed] = true;
    std::vector<size_t> piece{seed};
    size_t nearest = seed;  // the seed itself is the top
    for (size_t i = 0; i < piece.size(); ++i) {
      if (cells[piece[i]].z() < cells[nearest].z()) nearest = piece[i];
      cells.ForNeighbours(piece[i], [&](size_t other, bool goes_on) {
        if (!goes_on || taken[other]) return;
        taken[other] = true;
        piece.push_back(other);
      });
    }
    found.insert(found.end(), {seed, nearest});
  }
  return found;
}

bool IsNearAny(const Eigen::Vector3d& place_m, const std::vector<SeenHand>& hands, double near_m) {
  return std::any_of(hands.begin(), hands.end(), [&](const SeenHand& hand) {
    return (hand.sample.hand_m - place_m).norm() < near_m;
  });
}

}  // namespace

// Gestures are defined relative to a shoulder, which is not in view: it is assumed behind the hand.
SeenHand LoneHands::UpdateHand(Hand& hand, const Eigen::Vector3d& place_m,
                               const Eigen::Vector3d& elbow_m, double time_s) const {
  const double part = std::min(1.0, std::max(0.0, time_s - hand.seen_s) / options_.settle_s);
  hand.settled_m += part * (place_m - hand.settled_m);
  hand.place_m = place_m;
  hand.seen_s = time_s;
  const Eigen::Vector3d shoulder_m = hand.settled_m +
                                     options_.reach_m * hand.settled_m.normalized() +
                                     options_.above_m * Eigen::Vector3d::UnitY();
  const bool proven = time_s - hand.since_s >= options_.proven_s;
  return {hand.id, false, {time_s, place_m, elbow_m, shoulder_m}, proven};
}

std::vector<SeenHand> LoneHands::Step(const depth::DepthFrame& image,
                                      const tracker::BodyFrame& bodies,
                                      const std::vector<SeenHand>& of_bodies,
                                      const std::vector<Eigen::Vector3d>& asked_m) {
  const Cells cells(image, bodies.users, options_);
  std::vector<SeenHand> seen;
  const auto is_free = [&](const Eigen::Vector3d& place_m) {
    return !IsNearAny(place_m, seen, options_.apart_m) &&
           !IsNearAny(place_m, of_bodies, options_.apart_m);
  };
  std::vector<Hand> still_there;
  for (Hand& hand : hands_) {
    const double most_m = std::min(
        options_.near_m, options_.slack_m + options_.fastest_m_s * (bodies.time_s - hand.seen_s));
    const auto seed = cells.Nearest(hand.place_m, most_m);
    const auto found = seed ? FindHandOf(cells, *seed, options_) : std::nullopt;
    if (!found || (found->hand_m - hand.place_m).norm() > most_m || !is_free(found->hand_m)) {
      continue;
    }
    seen.push_back(UpdateHand(hand, found->hand_m, found->elbow_m, bodies.time_s));
    still_there.push_back(hand);
  }
  hands_ = std::move(still_there);
  std::vector<size_t> seeds;
  for (const Eigen::Vector3d& place_m : asked_m) {
    if (const auto seed = cells.Nearest(place_m, options_.near_m)) seeds.push_back(*seed);
  }
  const std::vector<size_t> outstanding = FindCandidates(cells);
  seeds.insert(seeds.end(), outstanding.begin(), outstanding.end());
  for (const size_t seed : seeds) {
    const auto found = FindHandOf(cells, seed, options_);
    if (!found || !is_free(found->hand_m)) continue;
    Hand hand{--last_id_, found->hand_m, found->hand_m, bodies.time_s, bodies.time_s};
    seen.push_back(UpdateHand(hand, found->hand_m, found->elbow_m, bodies.time_s));
    hands_.push_back(hand);
  }
  return seen;
}

}  // namespace ossa::nite2
