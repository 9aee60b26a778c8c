#pragma once
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "recon/files/skeleton_formats_internal.h"

namespace ossa::recon {

/// Lower-case letters and digits only: "Time [ms]" becomes "timems".
std::string PlainName(std::string_view name);

/// The time column of a row: times or frame numbers.
struct RowClock {
  bool counts_frames = false;
  std::optional<double> s_per_unit;  // if these are times; none: not stated
  bool is_stated = true;             // whether a header states it
};

/// Indices of the columns that are not joints.
struct RowColumns {
  std::optional<size_t> clock, body;
  RowClock time{};
};

/// Finds them by the names in a header.
RowColumns FindRowColumns(const std::vector<std::string>& names);

/// A joint with a position; one at the origin was not seen, unless it is the root.
struct NamedPoint {
  size_t label = 0;
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  // in the file's unit
  std::optional<double> confidence;
};

/// The joints of one frame or time.
struct TableFrame {
  double at = 0.0;
  std::vector<NamedPoint> seen;
};

/// Collects named joints, frame by frame, from the rows of a table.
class JointTable {
 public:
  /// Starts a row. Rows must be in order of time; several rows of one frame must be consecutive.
  /// Throws with the line.
  void Begin(const TextLines& lines, double at);
  /// Adds a joint to the current row; without a position it was not seen. Throws with the line if
  /// the frame already has that joint.
  void Add(const TextLines& lines, const std::string& label,
           const std::optional<Eigen::Vector3d>& place, std::optional<double> confidence);

  const std::vector<std::string>& labels() const { return labels_; }
  const std::vector<TableFrame>& frames() const { return frames_; }

 private:
  std::vector<std::string> labels_;
  std::map<std::string, size_t> numbers_;
  std::vector<TableFrame> frames_;
  std::set<size_t> named_;  // joints named in the last frame, seen or not
};

/// The people of a table, in metres and seconds. Assumptions about units and times are in the
/// warnings. Throws InputError for a table without rows or without a known joint name.
SkeletonSequence MakeSequence(const SkeletonInput& input, const JointTable& table,
                              const RowColumns& columns);

}  // namespace ossa::recon
