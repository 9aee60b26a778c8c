#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace ossa::forest {

/// Offsets of features are stored in 1/16 pixel·metre at the reference focal length of 575 pixels
/// (a Kinect v1 at 640 pixels width) and scaled by the focal length of the camera at hand: a model
/// serves every camera.
inline constexpr double kReferenceFocal_px = 575.0;
inline constexpr double kOffsetUnitsPerPixelMetre = 16.0;

/// One node, 16 bytes. Inner node: f = d(x + u/d(x)) - d(x + v/d(x)) in millimetres (Shotton et al.
/// 2011, eq. 1); the child is `left` when f <= threshold, `left + 1` otherwise. Leaf: left =
/// ~(number of the leaf in its tree). Breadth-first order, the root first; leaves count likewise.
struct Node {
  std::array<int16_t, 2> u{};  // offset units
  std::array<int16_t, 2> v{};
  int16_t threshold_mm = 0;
  int16_t unused = 0;
  int32_t left = -1;

  bool is_leaf() const { return left < 0; }
  int32_t leaf() const { return ~left; }
  bool operator==(const Node&) const = default;
};
static_assert(sizeof(Node) == 16);

/// The vote of a node's pixels for one target: its mean position relative to the pixel's surface
/// point, camera axes, centimetres, and the spread (root mean square distance to the mean).
/// Girshick et al. 2011, sec. 3.2, with one vote per target.
struct Vote {
  static constexpr uint8_t kNone = 255;  // by convention
  std::array<int8_t, 3> offset_cm{};
  uint8_t spread_cm = kNone;  // kNone: no vote

  bool operator==(const Vote&) const = default;
};

/// A decision tree whose leaves hold the joint distribution of (context, class), and whose nodes at
/// `vote_depth` (or leaves above it) hold a row of votes for each context, because chest seen from
/// the front and back seen from behind look alike but have different offsets to the hips.
struct Tree {
  std::vector<Node> nodes;
  /// Entries of leaf i are entries[entry_begin[i]] ... entries[entry_begin[i + 1] - 1]; an entry is
  /// weight << 9 | context * class_count + class, weight in 1..127 relative to its leaf.
  std::vector<uint32_t> entry_begin;
  std::vector<uint16_t> entries;
  int32_t vote_depth = 0;
  std::vector<Vote> votes;  // row × context × target, rows breadth-first; or empty

  size_t leaf_count() const { return entry_begin.empty() ? 0 : entry_begin.size() - 1; }
};

}  // namespace ossa::forest
