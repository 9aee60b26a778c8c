// ossa's own skeleton table: a header line, then a row a body (a frame without bodies is a row with
// an empty body). frame,time_s,body, then per joint NAME_x NAME_y NAME_z (camera space, metres),
// NAME_state, NAME_confidence, NAME_reliability; empty where unknown or absent.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "recon/files/csv_fields_internal.h"
#include "recon/files/skeleton_formats_internal.h"
#include "recon/motion/fixed_point_internal.h"

namespace ossa::recon {
namespace {

constexpr std::array<std::string_view, 6> kFields = {"x",     "y",          "z",
                                                     "state", "confidence", "reliability"};
constexpr size_t kLeading = 3;  // columns of the format
constexpr size_t kColumns = kLeading + kJointCount * kFields.size();

std::string MakeHeader() {
  std::string header = "frame,time_s,body";
  for (const std::string_view joint : kJointNames) {
    for (const std::string_view field : kFields) header += fmt::format(",{}_{}", joint, field);
  }
  return header;
}

void AppendJoint(std::string& row, const std::optional<JointRecord>& joint) {
  if (!joint) {
    row.append(kFields.size(), ',');
    return;
  }
  for (const double value : joint->position_m) row += fmt::format(",{:.7g}", value);
  row.push_back(',');
  if (joint->state) row += kStateNames[static_cast<size_t>(*joint->state)];
  row.push_back(',');
  if (joint->confidence) row += fmt::format("{:.6g}", *joint->confidence);
  row.push_back(',');
  if (joint->reliability) row += fmt::format("{:.6g}", *joint->reliability);
}

std::optional<TrackingState> StateIn(const TextLines& lines, std::string_view field) {
  if (field.empty()) return std::nullopt;
  const auto state = FindState(field);
  if (!state) lines.Fail("tracked, inferred or not_tracked", field);
  return state;
}

std::optional<double> ShareIn(const TextLines& lines, std::string_view field,
                              std::string_view what) {
  if (field.empty()) return std::nullopt;
  const double value = NumberIn(lines, field, what);
  if (value < 0 || value > 1) lines.Fail(std::string(what) + " from 0 to 1", field);
  return value;
}

std::optional<JointRecord> JointIn(const TextLines& lines, const std::string* fields,
                                   std::string_view name) {
  const auto place = PlaceIn(lines, {fields[0], fields[1], fields[2]}, name);
  if (!place) return std::nullopt;
  JointRecord joint;
  joint.position_m = *place;
  joint.state = StateIn(lines, fields[3]);
  joint.confidence = ShareIn(lines, fields[4], "confidence");
  joint.reliability = ShareIn(lines, fields[5], "reliability");
  return joint;
}

std::string FormatRowStart(const SkeletonFrame& frame) {
  constexpr int kDigits = 7;  // as in JSONL: enough for seconds since 1970
  std::string row = std::to_string(frame.frame) + ",";
  AppendFixed(row, frame.time_s, kDigits);
  row.push_back(',');
  return row;
}

// The body of a row; none if the row has none.
std::optional<BodyRecord> BodyIn(const TextLines& lines, const std::vector<std::string>& fields) {
  if (fields[2].empty()) return std::nullopt;
  BodyRecord body;
  body.id = static_cast<int>(WholeNumberIn(lines, fields[2], "body", INT32_MIN, INT32_MAX));
  for (size_t j = 0; j < kJointCount; ++j) {
    body.joints[j] = JointIn(lines, &fields[kLeading + j * kFields.size()], kJointNames[j]);
  }
  return body;
}

// Whether a row continues the previous frame with another body. Frame numbers and times may repeat,
// as in a JSONL whose "frame" is always 0.
bool BelongsTo(const SkeletonFrame& frame, int64_t number, double time_s,
               const std::optional<BodyRecord>& body) {
  return frame.frame == number && frame.time_s == time_s && body && !frame.bodies.empty() &&
         std::none_of(frame.bodies.begin(), frame.bodies.end(),
                      [&](const BodyRecord& other) { return other.id == body->id; });
}

}  // namespace

std::string SkeletonCsvHead() { return MakeHeader() + '\n'; }

std::string SkeletonCsvRows(const SkeletonFrame& frame) {
  const std::string begin = FormatRowStart(frame);
  if (frame.bodies.empty()) return begin + std::string(kColumns - kLeading, ',') + '\n';
  std::string rows;
  for (const BodyRecord& body : frame.bodies) {
    rows += begin + std::to_string(body.id);
    for (const auto& joint : body.joints) AppendJoint(rows, joint);
    rows += '\n';
  }
  return rows;
}

SkeletonSequence ReadSkeletonCsv(SkeletonInput& input) {
  TextLines lines(input.stream, input.name);
  lines.Expect("a header line");
  CsvFields csv(lines.line());
  if (ReadCsvHeader(lines.line()) != ReadCsvHeader(MakeHeader())) {
    lines.Fail("ossa's own header", lines.line());
  }
  SkeletonSequence sequence{input.name, {}};
  RowTimes times;
  while (lines.NextFilled()) {
    const std::vector<std::string> fields = csv.SplitRow(lines.line(), kColumns);
    // Spreadsheets leave rows of separators where rows were cleared.
    if (std::all_of(fields.begin(), fields.end(), [](const auto& f) { return f.empty(); })) {
      continue;
    }
    if (fields.size() != kColumns) {
      lines.Fail(fmt::format("{} columns", kColumns), fmt::format("{} columns", fields.size()));
    }
    const int64_t number = WholeNumberIn(lines, fields[0], "frame", INT64_MIN, INT64_MAX);
    const double time_s = NumberIn(lines, fields[1], "time_s");
    times.Take(lines, time_s);
    auto body = BodyIn(lines, fields);
    if (sequence.frames.empty() || !BelongsTo(sequence.frames.back(), number, time_s, body)) {
      sequence.frames.push_back({number, time_s, std::nullopt, {}});
    }
    if (body) sequence.frames.back().bodies.push_back(std::move(*body));
  }
  RequireFrames(sequence);
  return sequence;
}

}  // namespace ossa::recon
