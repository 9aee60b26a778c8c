#pragma once
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "recon/files/skeleton_formats_internal.h"

namespace ossa::recon {

/// Small letters and digits alone: "Time [ms]" is "timems".
std::string PlainName(std::string_view name);

/// What tells when a row was.
struct RowClock {
  bool counts_frames = false;
  std::optional<double> s_per_unit;  // of one that does not; none: not stated
  bool is_stated = true;             // by a header
};

/// Where the columns are that are not a joint's.
struct RowColumns {
  std::optional<size_t> clock, body;
  RowClock time{};
};

/// By the names of a header.
RowColumns FindRowColumns(const std::vector<std::string>& names);

/// A joint that was seen.
struct NamedPoint {
  size_t label = 0;
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  // in the file's unit
  std::optional<double> confidence;
};

/// The joints that stand together at one frame or time.
struct TableFrame {
  double at = 0.0;
  std::vector<NamedPoint> seen;
};

/// Joints by name, frame by frame, as a table's rows bring them.
class JointTable {
 public:
  /// Rows come in order, and several of one frame or time after each other: throws with the line.
  void Begin(const TextLines& lines, double at);
  /// A joint of the row begun last; without a place it was not seen. Throws with the line where
  /// that frame has it already.
  void Add(const TextLines& lines, const std::string& label,
           const std::optional<Eigen::Vector3d>& place, std::optional<double> confidence);

  const std::vector<std::string>& labels() const { return labels_; }
  const std::vector<TableFrame>& frames() const { return frames_; }

 private:
  std::vector<std::string> labels_;
  std::map<std::string, size_t> numbers_;
  std::vector<TableFrame> frames_;
  std::set<size_t> named_;  // in the last frame, seen or not
};

/// The people of a table, metres, at their times; what was assumed of the unit and of times is in
/// the warnings. Throws InputError of a table without rows or without a known name.
SkeletonSequence MakeSequence(const SkeletonInput& input, const JointTable& table,
                              const RowColumns& columns);

}  // namespace ossa::recon
