// Tables that hold an estimate and the ground truth of the same frames, distinguished by column
// prefix: UI-PRMD as prepared with Vicon joint centres (K_ Kinect, G_ Vicon), and ITOP with a
// network's estimate (P_ estimate, G_ truth).
#include <fmt/format.h>

#include <algorithm>

#include "depth/base/error.h"
#include "recon/files/csv_fields_internal.h"
#include "recon/files/joint_names_internal.h"
#include "recon/files/skeleton_formats_internal.h"

namespace ossa::recon {
namespace {

struct PairedFormat {
  std::string_view time_column;  // "" : the first column counts frames
  std::string_view observed_prefix;
  double usual_step_s;
  Eigen::Vector3d metres_per_unit;  // per axis; negative: the axis is flipped
};

// UI-PRMD: centimetres, x to the subject's left, z towards the sensor (subjects stand at
// z = -240 cm, facing it): half a turn about the vertical gives camera space.
const PairedFormat kUiPrmd = {"t_s", "K_", 1.0 / 30.0, {-0.01, 0.01, -0.01}};
// ITOP: metres, x to the right of the image, left-handed: one axis is flipped. It has no times. 10
// Hz is assumed: at 30 Hz one true hand in twenty would move faster than 10 m/s, at 10 Hz faster
// than 3.4.
const PairedFormat kItop = {"", "P_", 1.0 / 10.0, {-1.0, 1.0, 1.0}};

// Of UI-PRMD's 22 names the second half is the SDK's. Its collars and second neck are not used, and
// its "Neck" is the SDK 2 neck, above ShoulderCenter.
std::optional<Joint> JointOfColumn(std::string_view name) {
  if (name == "Neck2_Neck" || name == "Neck_dup" || name.ends_with("Collar")) return std::nullopt;
  if (name == "LToes") return Joint::kFootLeft;
  if (name == "RToes") return Joint::kFootRight;
  const size_t mark = name.rfind('_');
  return FindJointByName(mark == std::string_view::npos ? name : name.substr(mark + 1));
}

struct JointColumns {
  Joint joint;
  size_t x;
};

std::string ChoosePrefix(const SkeletonInput& input, const PairedFormat& format) {
  if (input.columns == "truth") return "G_";
  if (input.columns == "observed") return std::string(format.observed_prefix);
  throw InputError(
      fmt::format("{}: holds two skeletons side by side: expected {}#truth or {}#observed",
                  input.name, input.name, input.name));
}

std::vector<JointColumns> FindColumns(const TextLines& lines,
                                      const std::vector<std::string>& header,
                                      const std::string& prefix) {
  std::vector<JointColumns> columns;
  for (size_t c = 0; c + 2 < header.size(); ++c) {
    if (!header[c].starts_with(prefix) || !header[c].ends_with("_x")) continue;
    const std::string name = header[c].substr(prefix.size(), header[c].size() - 2 - prefix.size());
    const auto joint = JointOfColumn(name);
    if (!joint) continue;
    if (header[c + 1] != fmt::format("{}{}_y", prefix, name) ||
        header[c + 2] != fmt::format("{}{}_z", prefix, name)) {
      lines.Fail(fmt::format("{0}{1}_y and {0}{1}_z", prefix, name), header[c + 1]);
    }
    columns.push_back({*joint, c});
  }
  if (columns.empty()) lines.Fail("columns that begin with " + prefix, lines.line());
  return columns;
}

SkeletonSequence ReadPaired(SkeletonInput& input, const PairedFormat& format) {
  const std::string prefix = ChoosePrefix(input, format);
  TextLines lines(input.stream, input.name);
  lines.Expect("a header line");
  CsvFields csv(lines.line());
  const std::vector<std::string> header = ReadCsvHeader(lines.line());
  const auto columns = FindColumns(lines, header, prefix);
  SkeletonSequence sequence{input.name, {}};
  sequence.columns = input.columns;
  RowTimes times;
  while (lines.NextFilled()) {
    const std::vector<std::string> fields = csv.SplitRow(lines.line(), header.size());
    if (fields.size() != header.size()) {
      lines.Fail(fmt::format("{} columns", header.size()),
                 fmt::format("{} columns", fields.size()));
    }
    BodyRecord body;
    for (const auto& [joint, x] : columns) {
      const auto place = PlaceIn(lines, {fields[x], fields[x + 1], fields[x + 2]}, header[x]);
      if (place) PutJoint(body, joint, place->cwiseProduct(format.metres_per_unit));
    }
    const double first = NumberIn(lines, fields[0], header[0]);
    const double time_s =
        format.time_column.empty() ? first * input.FrameTime_s(format.usual_step_s) : first;
    times.Take(lines, time_s);
    sequence.frames.push_back(OneBodyFrame(sequence.frames.size(), time_s, std::move(body)));
  }
  RequireFrames(sequence);
  return sequence;
}

// Whether the first column is `first` and the name of some column starts with `other`.
bool HasColumns(const SkeletonSample& sample, std::string_view first, std::string_view other) {
  if (sample.lines.empty()) return false;
  const std::vector<std::string> header = ReadCsvHeader(sample.lines[0]);
  return !header.empty() && header.front() == first &&
         std::any_of(header.begin(), header.end(),
                     [&](const std::string& name) { return name.starts_with(other); });
}

constexpr SkeletonFormat kPairedFormats[] = {
    {"ui-prmd-csv", [](const SkeletonSample& s) { return HasColumns(s, "t_s", "G_head_x"); },
     [](SkeletonInput& input) { return ReadPaired(input, kUiPrmd); }},
    {"itop-csv", [](const SkeletonSample& s) { return HasColumns(s, "frame", "P_"); },
     [](SkeletonInput& input) { return ReadPaired(input, kItop); }},
};

}  // namespace

std::span<const SkeletonFormat> PairedFormats() { return kPairedFormats; }

}  // namespace ossa::recon
