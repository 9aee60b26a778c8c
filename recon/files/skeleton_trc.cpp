// OpenSim's TRC marker table: five header lines, then a row a frame, tab separated.
#include <fmt/format.h>

#include <algorithm>

#include "depth/base/one_line.h"
#include "recon/files/joint_names_internal.h"
#include "recon/files/skeleton_formats_internal.h"

namespace ossa::recon {
namespace {

constexpr double kMillimetresPerMetre = 1000.0;

// The mean rate; OpenSim wants one even when frames were dropped (the Time column stays exact).
double DataRate_Hz(const SkeletonSequence& sequence) {
  constexpr double kUsualRate_Hz = 30.0;  // by convention, a Kinect SDK's rate
  if (sequence.frames.size() < 2) return kUsualRate_Hz;
  const double span_s = sequence.frames.back().time_s - sequence.frames.front().time_s;
  return span_s > 0 ? static_cast<double>(sequence.frames.size() - 1) / span_s : kUsualRate_Hz;
}

void WriteHeader(std::ostream& stream, const SkeletonSequence& sequence,
                 const std::string& file_name) {
  const double rate_Hz = DataRate_Hz(sequence);
  stream << "PathFileType\t4\t(X/Y/Z)\t" << OnOneLine(file_name) << '\n'
         << "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\t"
            "OrigDataStartFrame\tOrigNumFrames\n"
         << fmt::format("{0:.3f}\t{0:.3f}\t{1}\t{2}\tmm\t{0:.3f}\t1\t{1}\n", rate_Hz,
                        sequence.frames.size(), kJointCount);
  stream << "Frame#\tTime";
  for (const std::string_view name : kJointNames) stream << '\t' << name << "\t\t";
  stream << "\n\t";
  for (int j = 1; j <= kJointCount; ++j) stream << fmt::format("\tX{0}\tY{0}\tZ{0}", j);
  stream << "\n\n";
}

struct TrcHeader {
  double metres_per_unit = 0.0;
  size_t markers = 0;
  size_t frames = 0;                         // 0: the header does not say
  std::vector<std::optional<Joint>> joints;  // one entry per marker
};

TrcHeader ReadHeader(TextLines& lines) {
  lines.Expect("a TRC header");
  if (!lines.line().starts_with("PathFileType")) lines.Fail("PathFileType", lines.line());
  lines.Expect("the line that names the header's fields");
  const std::vector<std::string> keys = [&] {
    std::vector<std::string> copies;
    for (const auto field : Split(lines.line(), '\t')) copies.emplace_back(field);
    return copies;
  }();
  lines.Expect("the header's values");
  const auto values = Split(lines.line(), '\t');
  TrcHeader header;
  for (size_t i = 0; i < std::min(keys.size(), values.size()); ++i) {
    if (keys[i] == "NumMarkers") {
      header.markers = static_cast<size_t>(WholeNumberIn(lines, values[i], "NumMarkers", 1, 10000));
    } else if (keys[i] == "NumFrames" && !values[i].empty()) {
      header.frames = static_cast<size_t>(WholeNumberIn(lines, values[i], "NumFrames", 0, 1e9));
    } else if (keys[i] == "Units") {
      if (values[i] != "mm" && values[i] != "m") lines.Fail("Units mm or m", values[i]);
      header.metres_per_unit = values[i] == "mm" ? 1.0 / kMillimetresPerMetre : 1.0;
    }
  }
  if (header.markers == 0) lines.Fail("NumMarkers", lines.line());
  if (header.metres_per_unit == 0) lines.Fail("Units", lines.line());
  return header;
}

void ReadMarkerNames(TextLines& lines, TrcHeader& header) {
  lines.Expect("the line of marker names");
  if (!lines.line().starts_with("Frame#")) lines.Fail("Frame#, Time and names", lines.line());
  bool any = false;
  const auto fields = Split(lines.line(), '\t');
  for (size_t m = 0; m < header.markers; ++m) {
    const size_t column = 2 + 3 * m;
    if (column >= fields.size() || fields[column].empty()) {
      lines.Fail(fmt::format("{} marker names", header.markers), fmt::format("{} names", m));
    }
    header.joints.push_back(JointCalled(fields[column]));
    any = any || header.joints.back();
  }
  if (!any) lines.Fail("at least one marker named as a joint (e.g. ElbowLeft)", lines.line());
  lines.Expect("the line of column names");
  if (!Trimmed(lines.line()).starts_with("X1")) lines.Fail("X1, Y1, Z1, ...", lines.line());
}

BodyRecord BodyIn(const TextLines& lines, const std::vector<std::string_view>& fields,
                  const TrcHeader& header) {
  BodyRecord body;
  for (size_t m = 0; m < header.markers; ++m) {
    const size_t column = 2 + 3 * m;
    // Blank or cut-off columns are how TRC says that a marker was not seen.
    if (!header.joints[m] || column + 2 >= fields.size() || fields[column].empty()) continue;
    Eigen::Vector3d position;
    for (size_t axis = 0; axis < 3; ++axis) {
      position[static_cast<int>(axis)] = NumberIn(lines, fields[column + axis], "a marker");
    }
    PutJoint(body, *header.joints[m], position * header.metres_per_unit);
  }
  return body;
}

}  // namespace

void WriteTrc(std::ostream& stream, const SkeletonSequence& sequence, int id,
              const std::string& file_name) {
  WriteHeader(stream, sequence, file_name);
  for (size_t f = 0; f < sequence.frames.size(); ++f) {
    const SkeletonFrame& frame = sequence.frames[f];
    std::string row = fmt::format("{}\t{:.6f}", f + 1, frame.time_s);
    const auto body = std::find_if(frame.bodies.begin(), frame.bodies.end(),
                                   [&](const BodyRecord& b) { return b.id == id; });
    for (size_t j = 0; j < kJointCount; ++j) {
      if (body == frame.bodies.end() || !body->joints[j]) {
        row += "\t\t\t";
        continue;
      }
      for (const double value : body->joints[j]->position_m) {
        row += fmt::format("\t{:.4f}", value * kMillimetresPerMetre);
      }
    }
    stream << row << '\n';
  }
}

SkeletonSequence ReadTrc(SkeletonInput& input) {
  TextLines lines(input.stream, input.name);
  TrcHeader header = ReadHeader(lines);
  ReadMarkerNames(lines, header);
  SkeletonSequence sequence{input.name, {}};
  RowTimes times;
  while (lines.NextFilled()) {
    const auto fields = Split(lines.line(), '\t');
    if (fields.size() < 2 || fields.size() > 2 + 3 * header.markers) {
      lines.Fail(fmt::format("2 to {} columns", 2 + 3 * header.markers),
                 fmt::format("{} columns", fields.size()));
    }
    const double time_s = NumberIn(lines, fields[1], "Time");
    times.Take(lines, time_s);
    sequence.frames.push_back(
        OneBodyFrame(sequence.frames.size(), time_s, BodyIn(lines, fields, header)));
  }
  if (sequence.frames.size() < header.frames) {
    lines.Fail(fmt::format("{} frames as NumFrames says", header.frames),
               std::to_string(sequence.frames.size()));
  }
  RequireFrames(sequence);
  TakeOutNobody(sequence);
  return sequence;
}

}  // namespace ossa::recon
