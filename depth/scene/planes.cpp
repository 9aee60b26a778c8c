// Constants: where a line names no origin, set by hand while developing on rendered rooms with
// validation subjects (`ossa experiment indoor-scenes`); no sweep is recorded.
#include "depth/scene/planes.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

namespace ossa::depth {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kBlock = 4;    // cells a side
constexpr int kFewest = 11;  // minimum measured cells of a block's 16
constexpr int kReach = 2;    // blocks: farther from those of a piece, its cells may be another's
// Share of those cells, [0, 1], in squares of 2 x 2 filled blocks, by hand: of walls on real frames
// 0.4 to 0.9, of strips beside a person 0 to 0.35.
constexpr double kLeastBroad = 0.4;
constexpr double kMostTilted = 0.5;      // cosine of the normal to the vertical: a chest, leaning
constexpr double kFlatPersonFrom_m = 3;  // sensor: from here on a whole person appears flat
// Quantisation of the Kinect v1 in inverse depth, measured on real frames (`ossa experiment
// sensor`).
constexpr double kStep_per_m = 2.9e-3;
// A flat block has the quantisation error (0.29 steps) and jitter of about one step.
constexpr double kFlatRms_per_m = 1.1 * kStep_per_m;
constexpr double kJoinRms_per_m = 1.3 * kStep_per_m;  // of a block relative to its plane
constexpr double kCellOff_per_m = 2.6 * kStep_per_m;  // of a cell relative to the plane

// Accumulates the least-squares plane d = a x + b y + c of inverse depth over cells.
struct Sums {
  Matrix3d aa = Matrix3d::Zero();
  Vector3d ad = Vector3d::Zero();
  double dd = 0;
  double n = 0;

  void Add(double x, double y, double d) {
    const Vector3d row(x, y, 1.0);
    aa += row * row.transpose();
    ad += row * d;
    dd += d * d;
    n += 1;
  }
  void Add(const Sums& other) {
    aa += other.aa;
    ad += other.ad;
    dd += other.dd;
    n += other.n;
  }
  Vector3d Fit() const { return aa.inverse() * ad; }
  double Rms(const Vector3d& plane) const {
    const double square = dd - 2 * plane.dot(ad) + plane.dot(aa * plane);
    return std::sqrt(std::max(0.0, square / n));
  }
};

class PieceGrower {
 public:
  PieceGrower(const PointGrid& grid, const std::vector<uint8_t>& ignore, double person_m2)
      : grid_(grid),
        person_m2_(person_m2),
        width_(grid.width / kBlock),
        height_(grid.height / kBlock),
        sums_(static_cast<size_t>(width_ * height_)),
        rms_(sums_.size(), 1e9),
        block_taken_(sums_.size(), 0),
        stride_(grid.width + 2 * kRim),
        piece_of_(static_cast<size_t>(stride_ * (grid.height + 2 * kRim)), kTaken),
        inverse_depth_(piece_of_.size(), 0.0) {
    for (int y = 0; y < grid.height; ++y) {
      for (int x = 0; x < grid.width; ++x) {
        const int cell = grid.cell(x, y);
        if (ignore[static_cast<size_t>(cell)] || !grid.valid(cell)) continue;
        piece_of_[IndexWithRim(x, y)] = kFree;
        inverse_depth_[IndexWithRim(x, y)] = 1.0 / static_cast<double>(grid.z(cell));
      }
    }
    for (int by = 0; by < height_; ++by) {
      for (int bx = 0; bx < width_; ++bx) Measure(bx, by);
    }
  }

  std::vector<FlatPiece> Run() {
    std::vector<size_t> order;
    for (size_t block = 0; block < rms_.size(); ++block) {
      if (rms_[block] <= kFlatRms_per_m) order.push_back(block);
    }
    std::stable_sort(order.begin(), order.end(),
                     [&](size_t a, size_t b) { return rms_[a] < rms_[b]; });
    std::vector<FlatPiece> pieces;
    for (const size_t seed : order) {
      if (block_taken_[seed]) continue;
      Sums sums;
      const std::vector<size_t> blocks = Grow(seed, sums);
      constexpr size_t kFewBlocks = 4;  // fewer are not called flat
      if (blocks.size() < kFewBlocks) continue;
      const FlatPiece piece = MakePiece(sums.Fit());
      Claim(piece, seed, static_cast<int>(pieces.size()));
      const std::vector<uint8_t> near = FindReach(blocks);
      if (MayBePerson(piece, near)) ReleaseStrips(near);
      if (!front_.empty()) pieces.push_back(piece);
    }
    HandOutCells(pieces);
    std::stable_sort(pieces.begin(), pieces.end(),
                     [](const FlatPiece& a, const FlatPiece& b) { return a.area_m2 > b.area_m2; });
    return pieces;
  }

 private:
  void Measure(int bx, int by) {
    const auto block = static_cast<size_t>(by * width_ + bx);
    Sums sums;
    for (int y = by * kBlock; y < (by + 1) * kBlock; ++y) {
      for (int x = bx * kBlock; x < (bx + 1) * kBlock; ++x) {
        const size_t place = IndexWithRim(x, y);
        if (piece_of_[place] != kTaken) sums.Add(x, y, inverse_depth_[place]);
      }
    }
    sums_[block] = sums;
    if (sums.n >= kFewest) rms_[block] = sums.Rms(sums.Fit());
  }

  // Region growing: blocks join while they are on the current plane, which is refitted whenever
  // their number has grown by half.
  std::vector<size_t> Grow(size_t seed, Sums& sums) {
    std::vector<size_t> front = {seed};
    block_taken_[seed] = 1;
    sums = sums_[seed];
    Vector3d plane = sums.Fit();
    size_t refit_at = 2;
    for (size_t i = 0; i < front.size(); ++i) {
      const int bx = static_cast<int>(front[i]) % width_, by = static_cast<int>(front[i]) / width_;
      constexpr int kSteps[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
      for (const auto& step : kSteps) {
        const int x = bx + step[0], y = by + step[1];
        if (x < 0 || y < 0 || x >= width_ || y >= height_) continue;
        const auto next = static_cast<size_t>(y * width_ + x);
        if (block_taken_[next] || rms_[next] > kFlatRms_per_m ||
            sums_[next].Rms(plane) > kJoinRms_per_m)
          continue;
        block_taken_[next] = 1;
        sums.Add(sums_[next]);
        front.push_back(next);
        if (front.size() < refit_at) continue;
        plane = sums.Fit();
        refit_at = front.size() * 3 / 2 + 1;
      }
    }
    return front;
  }

  // Assigns the cells on the plane that are connected to the seed block, in whole blocks or not, to
  // the piece.
  void Claim(const FlatPlane& plane, size_t seed, int piece) {
    front_.clear();
    const auto claim_if_on_plane = [&](size_t place, int x, int y) {
      if (piece_of_[place] != kFree) return;
      if (std::abs(inverse_depth_[place] - plane.At(x, y)) >= kCellOff_per_m) return;
      piece_of_[place] = piece;
      front_.push_back({x, y});
    };
    const int x0 = static_cast<int>(seed) % width_ * kBlock;
    const int y0 = static_cast<int>(seed) / width_ * kBlock;
    for (int i = 0; i < kBlock * kBlock; ++i) {
      const int x = x0 + i % kBlock, y = y0 + i / kBlock;
      claim_if_on_plane(IndexWithRim(x, y), x, y);
    }
    for (size_t i = 0; i < front_.size(); ++i) {
      const auto [x, y] = front_[i];
      const size_t place = IndexWithRim(x, y), row = static_cast<size_t>(stride_);
      for (const int step : {1, kRim}) {  // the border around the grid is never free
        const auto columns = static_cast<size_t>(step), rows = columns * row;
        claim_if_on_plane(place + columns, x + step, y);
        claim_if_on_plane(place - columns, x - step, y);
        claim_if_on_plane(place + rows, x, y + step);
        claim_if_on_plane(place - rows, x, y - step);
      }
    }
  }

  // Whether what is near the blocks of a piece may be a person and no more.
  bool MayBePerson(const FlatPiece& piece, const std::vector<uint8_t>& near) const {
    if (std::abs(piece.normal.dot(grid_.up.cast<double>())) > kMostTilted) return false;
    double area_m2 = 0, z_m = 0, cells = 0;
    for (const auto& at : front_) {
      if (!near[BlockOf(at)]) continue;
      const int cell = grid_.cell(at[0], at[1]);
      area_m2 += Area(cell, piece.normal);
      z_m += static_cast<double>(grid_.z(cell));
      cells += 1;
    }
    return area_m2 < person_m2_ && z_m > kFlatPersonFrom_m * cells;
  }

  // Takes the cells that Claim assigned far from the piece's blocks from it, unless they fill a
  // surface: the plane of a chest goes on in strips of a curtain beside the person, and with them
  // it would be as large as a wall.
  void ReleaseStrips(const std::vector<uint8_t>& near) {
    const std::vector<uint8_t> broad = FindBroadBlocks();
    const auto is_far = [&](const std::array<int, 2>& at) { return !near[BlockOf(at)]; };
    const auto far = std::ranges::count_if(front_, is_far);
    const auto filled = std::ranges::count_if(
        front_, [&](const auto& at) { return is_far(at) && broad[BlockOf(at)]; });
    if (static_cast<double>(filled) >= kLeastBroad * static_cast<double>(far)) return;
    for (const auto& at : front_) {
      if (is_far(at)) piece_of_[IndexWithRim(at[0], at[1])] = kFree;
    }
    std::erase_if(front_, is_far);
  }

  // The blocks within reach of these (1 = yes).
  std::vector<uint8_t> FindReach(const std::vector<size_t>& blocks) const {
    std::vector<uint8_t> near(sums_.size(), 0);
    for (const size_t block : blocks) {
      const int bx = static_cast<int>(block) % width_, by = static_cast<int>(block) / width_;
      for (int y = std::max(0, by - kReach); y <= std::min(height_ - 1, by + kReach); ++y) {
        for (int x = std::max(0, bx - kReach); x <= std::min(width_ - 1, bx + kReach); ++x)
          near[static_cast<size_t>(y * width_ + x)] = 1;
      }
    }
    return near;
  }

  // The blocks in squares of four that the cells of Claim fill (1 = yes).
  std::vector<uint8_t> FindBroadBlocks() const {
    std::vector<int> cells(sums_.size(), 0);
    for (const auto& at : front_) ++cells[BlockOf(at)];
    std::vector<uint8_t> broad(sums_.size(), 0);
    for (int y = 0; y + 1 < height_; ++y) {
      for (int x = 0; x + 1 < width_; ++x) {
        const auto first = static_cast<size_t>(y * width_ + x),
                   below = first + static_cast<size_t>(width_);
        const std::array<size_t, 4> square = {first, first + 1, below, below + 1};
        if (std::ranges::any_of(square, [&](size_t block) { return cells[block] < kFewest; }))
          continue;
        for (const size_t block : square) broad[block] = 1;
      }
    }
    return broad;
  }

  FlatPiece MakePiece(const Vector3d& plane) const {
    FlatPiece piece;
    piece.slope_x = plane.x(), piece.slope_y = plane.y(), piece.at_zero = plane.z();
    SetNormal(plane, piece);
    return piece;
  }

  // Distributes cells to pieces in one pass, in ascending order.
  void HandOutCells(std::vector<FlatPiece>& pieces) const {
    for (int y = 0; y < grid_.height; ++y) {
      for (int x = 0; x < grid_.width; ++x) {
        const int mine = piece_of_[IndexWithRim(x, y)];
        if (mine < 0) continue;
        FlatPiece& piece = pieces[static_cast<size_t>(mine)];
        piece.cells.push_back(grid_.cell(x, y));
        piece.area_m2 += Area(piece.cells.back(), piece.normal);
      }
    }
  }

  // 1 = n.p with d = 1/z, u = cx - fx x/z and v = cy - fy y/z put into the plane's equation.
  void SetNormal(const Vector3d& plane, FlatPiece& piece) const {
    const depth::Camera& camera = grid_.camera;
    const double step = grid_.step, middle = 0.5 * (step - 1);
    const double a = plane.x() / step, b = plane.y() / step;
    const double c = plane.z() - (a + b) * middle;
    const Vector3d n(-a * camera.fx, -b * camera.fy, a * camera.cx + b * camera.cy + c);
    if (n.norm() > 1e-9) piece.normal = -n.normalized();
  }

  double Area(int cell, const Vector3d& normal) const {
    const Vector3d p = grid_.at(cell).cast<double>();
    constexpr double kMostSlanted = 0.1;  // cosine; below, the area is undefined
    return static_cast<double>(grid_.Area(cell)) /
           std::max(kMostSlanted, std::abs(normal.dot(p)) / p.norm());
  }

  static constexpr int kFree = -1, kTaken = -2;  // unassigned; excluded
  static constexpr int kRim = 3;  // border around the grid, excluded: as wide as Claim reaches

  // The nearest for the last columns and rows, which are in none.
  size_t BlockOf(const std::array<int, 2>& at) const {
    const int bx = std::min(at[0] / kBlock, width_ - 1), by = std::min(at[1] / kBlock, height_ - 1);
    return static_cast<size_t>(by * width_ + bx);
  }
  size_t IndexWithRim(int x, int y) const {
    return static_cast<size_t>((y + kRim) * stride_ + x + kRim);
  }

  const PointGrid& grid_;
  double person_m2_;
  int width_, height_;  // blocks
  std::vector<Sums> sums_;
  std::vector<double> rms_;
  std::vector<uint8_t> block_taken_;
  int stride_;                             // of the two arrays with a border
  std::vector<int> piece_of_;              // piece index of a cell, kFree or kTaken
  std::vector<double> inverse_depth_;      // 1/m, 0 if not free
  std::vector<std::array<int, 2>> front_;  // cells assigned by Claim, (x, y)
};

}  // namespace

std::vector<FlatPiece> FlatPieces(const PointGrid& grid, const std::vector<uint8_t>& ignore,
                                  double person_m2) {
  return PieceGrower(grid, ignore, person_m2).Run();
}

}  // namespace ossa::depth
