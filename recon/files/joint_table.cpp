#include "recon/files/joint_table_internal.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "depth/base/error.h"
#include "depth/base/statistics.h"
#include "recon/files/origin_points_internal.h"
#include "recon/files/unlikely_unit_internal.h"

namespace ossa::recon {
namespace {

std::optional<RowClock> ClockCalled(std::string_view name) {
  const std::string plain = PlainName(name);
  if (plain.starts_with("frame") || plain == "index") return RowClock{true, {}};
  const bool is_time = plain.starts_with("time") || plain.starts_with("milli") ||
                       plain.starts_with("sec") || plain == "t";
  if (!is_time) return std::nullopt;
  if (plain.ends_with("ms") || plain.find("milli") != plain.npos) return RowClock{false, 1e-3};
  if (plain.ends_with("us") || plain.find("micro") != plain.npos) return RowClock{false, 1e-6};
  if (plain.ends_with("ns") || plain.find("nano") != plain.npos) return RowClock{false, 1e-9};
  const bool is_s = plain.ends_with("s") || plain.find("sec") != plain.npos;
  return RowClock{false, is_s ? std::optional(1.0) : std::nullopt};
}

bool IsBodyColumn(std::string_view name) {
  static const std::set<std::string> kNames = {"body",     "bodyid",    "id",         "person",
                                               "personid", "player",    "skeletonid", "user",
                                               "userid",   "trackingid"};
  return kNames.contains(PlainName(name));
}

// --- Time and length units.

/// Median time between rows, in the file's unit; 0 for a single row.
double MedianStep(const std::vector<TableFrame>& frames) {
  std::vector<double> steps;
  for (size_t m = 1; m < frames.size(); ++m) steps.push_back(frames[m].at - frames[m - 1].at);
  return steps.empty() ? 0.0 : Median(std::move(steps));
}

bool AreWhole(const std::vector<TableFrame>& frames) {
  return std::all_of(frames.begin(), frames.end(),
                     [](const TableFrame& m) { return m.at == std::floor(m.at); });
}

/// Whether the time column counts frames: by its header, or integers that grow by one or two.
bool CountsFrames(const RowClock& clock, const std::vector<TableFrame>& frames) {
  constexpr double kLongestFrames = 2.0;  // frames, by hand
  return clock.counts_frames ||
         (!clock.is_stated && AreWhole(frames) && MedianStep(frames) <= kLongestFrames);
}

/// The number of the first frame of a recording, which is at time 0. A table may also begin later.
double FirstNumber(const std::vector<TableFrame>& frames, SkeletonSequence& sequence) {
  if (frames.front().at != 1.0) return 0.0;
  sequence.warnings.push_back(sequence.source +
                              ": its first frame is number 1: frames are counted from there");
  return 1.0;
}

/// Seconds per unit of a time column.
double SecondsPerUnit(const RowClock& clock, const std::vector<TableFrame>& frames,
                      SkeletonSequence& sequence) {
  // By hand: recordings have at least one frame in two seconds.
  constexpr double kLongestStep_s = 2.0, kSecondsPerMillisecond = 1e-3;
  const double step = MedianStep(frames);
  if (clock.s_per_unit) return *clock.s_per_unit;
  if (step <= kLongestStep_s) return 1.0;
  if (step > kLongestStep_s / kSecondsPerMillisecond) {
    throw InputError(fmt::format(
        "{}: expected frames, seconds or milliseconds, found {:.6g} from frame to frame: a header "
        "says other units, such as time_us",
        sequence.source, step));
  }
  sequence.warnings.push_back(
      fmt::format("{}: times grow by {:.6g} from frame to frame: they are taken as milliseconds",
                  sequence.source, step));
  return kSecondsPerMillisecond;
}

/// Metres per unit of the file, derived from the limb lengths.
double MetresOfUnit(SkeletonSequence& sequence) {
  // By hand: from a toddler's upper arm to a giant's thigh.
  constexpr double kShortest_m = 0.08, kLongest_m = 0.8, kMetresPerCentimetre = 1e-2,
                   kMetresPerMillimetre = 1e-3;
  const auto limb = MedianLimb(sequence);
  if (!limb) {
    sequence.warnings.push_back(sequence.source +
                                ": no thigh, shin or upper arm shows the unit: it is taken as "
                                "metres");
    return 1.0;
  }
  const auto is_limb = [&](double unit_m) {
    return *limb * unit_m >= kShortest_m && *limb * unit_m < kLongest_m;
  };
  const bool in_cm = is_limb(kMetresPerCentimetre);
  if (!in_cm && !is_limb(kMetresPerMillimetre)) return 1.0;  // else Read() warns of the body size
  sequence.warnings.push_back(
      fmt::format("{}: thighs, shins and upper arms are {:.3g} long: they are taken as {}",
                  sequence.source, *limb, in_cm ? "centimetres" : "millimetres"));
  return in_cm ? kMetresPerCentimetre : kMetresPerMillimetre;
}

void Scale(SkeletonSequence& sequence, double by) {
  for (SkeletonFrame& frame : sequence.frames) {
    for (BodyRecord& body : frame.bodies) {
      for (auto& joint : body.joints) {
        if (joint) joint->position_m *= by;
      }
    }
  }
}

// --- The skeletons.

void PutConfidences(const PointBody& body, const std::vector<std::optional<double>>& confidences,
                    BodyRecord& record) {
  for (size_t j = 0; j < kJointCount; ++j) {
    if (!record.joints[j] || body.points[j].empty()) continue;
    record.joints[j]->confidence = confidences[body.points[j].front()];
  }
}

std::set<size_t> FindRoots(const JointTable& table, double metres_per_unit) {
  OriginPoints origin;
  for (const TableFrame& row : table.frames()) {
    for (const NamedPoint& point : row.seen) {
      origin.Add(point.label, point.place * metres_per_unit);
    }
  }
  return origin.FindRoots();
}

SkeletonFrame MakeTableFrame(const JointTable& table, const TableFrame& row,
                             const std::vector<PointBody>& bodies, const std::set<size_t>& roots,
                             size_t index) {
  std::vector<SeenPoint> points(table.labels().size());
  std::vector<std::optional<double>> confidences(points.size());
  for (const NamedPoint& one : row.seen) {
    if (one.place.isZero(0.0) && !roots.contains(one.label)) continue;  // not seen
    points[one.label] = one.place;
    confidences[one.label] = one.confidence;
  }
  SkeletonFrame frame = MakeFrame(bodies, points, index, row.at);
  for (size_t b = 0; b < bodies.size(); ++b) {
    PutConfidences(bodies[b], confidences, frame.bodies[b]);
  }
  return frame;
}

// Removes people who are not in the frame.
void LeaveOutAbsent(SkeletonFrame& frame) {
  std::erase_if(frame.bodies, [](const BodyRecord& body) {
    return std::none_of(body.joints.begin(), body.joints.end(),
                        [](const auto& joint) { return joint.has_value(); });
  });
}

}  // namespace

std::string PlainName(std::string_view name) {
  std::string plain;
  for (const char c : name) {
    if (c >= 'A' && c <= 'Z') plain.push_back(static_cast<char>(c - 'A' + 'a'));
    if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9')) plain.push_back(c);
  }
  return plain;
}

RowColumns FindRowColumns(const std::vector<std::string>& names) {
  RowColumns columns;
  for (size_t c = 0; c < names.size(); ++c) {
    if (!columns.body && IsBodyColumn(names[c])) columns.body = c;
    const auto clock = ClockCalled(names[c]);
    // Times are more informative than frame numbers.
    const bool is_better = columns.time.counts_frames && clock && !clock->counts_frames;
    if (!clock || (columns.clock && !is_better)) continue;
    columns.clock = c;
    columns.time = *clock;
  }
  return columns;
}

void JointTable::Begin(const TextLines& lines, double at) {
  if (!frames_.empty() && at < frames_.back().at) {
    lines.Fail(fmt::format("frames or times that grow, after {}", frames_.back().at),
               fmt::format("{}", at));
  }
  if (!frames_.empty() && at == frames_.back().at) return;
  frames_.push_back({at, {}});
  named_.clear();
}

void JointTable::Add(const TextLines& lines, const std::string& label,
                     const std::optional<Eigen::Vector3d>& place,
                     std::optional<double> confidence) {
  constexpr size_t kMostLabels = 4096;  // by hand: a hundred people
  const size_t number = numbers_.emplace(label, labels_.size()).first->second;
  if (number == labels_.size()) labels_.push_back(label);
  if (labels_.size() > kMostLabels) lines.Fail("at most 4096 names", label);
  if (!named_.insert(number).second) {
    lines.Fail("each joint once a frame (of several people a column 'body' says whose)", label);
  }
  if (place) frames_.back().seen.push_back({number, *place, confidence});
}

SkeletonSequence MakeSequence(const SkeletonInput& input, const JointTable& table,
                              const RowColumns& columns) {
  SkeletonSequence sequence{input.name, {}};
  if (table.frames().empty()) RequireFrames(sequence);
  const auto bodies =
      FindPointBodies(table.labels(), input.mapping, {input.name, "joints"}, sequence.warnings);
  const bool counts = CountsFrames(columns.time, table.frames());
  const double first = counts ? FirstNumber(table.frames(), sequence) : 0.0;
  const double s_per_unit = counts ? input.FrameTime_s(kKinectStep_s)
                                   : SecondsPerUnit(columns.time, table.frames(), sequence);
  const auto make_frames = [&](const std::set<size_t>& roots) {
    sequence.frames.clear();
    for (const TableFrame& row : table.frames()) {
      SkeletonFrame frame = MakeTableFrame(table, row, bodies, roots, sequence.frames.size());
      frame.time_s = (frame.time_s - first) * s_per_unit;
      if (columns.body) LeaveOutAbsent(frame);
      sequence.frames.push_back(std::move(frame));
    }
  };
  make_frames({});
  const double metres_per_unit = MetresOfUnit(sequence);
  if (const auto roots = FindRoots(table, metres_per_unit); !roots.empty()) make_frames(roots);
  RemoveEmptyBodies(sequence);
  Scale(sequence, metres_per_unit);
  TurnFromImageAxes(sequence);
  RotateUpright(sequence, {'z', Eigen::Vector3d::UnitZ()});
  return sequence;
}

}  // namespace ossa::recon
