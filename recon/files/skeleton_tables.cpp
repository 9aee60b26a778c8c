// Tables of named joints, as custom programs write them: one joint per line, FRAME JOINT x y z
// [confidence]; or one frame per row under a header of NAME_x NAME_y NAME_z. The frame may be a
// time. Camera space. The unit is not stated; it is derived from limb lengths.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "recon/files/csv_fields_internal.h"
#include "recon/files/joint_table_internal.h"
#include "recon/files/skeleton_formats_internal.h"

namespace ossa::recon {
namespace {

// The fields of a line, which may be separated by blanks only.
class FieldsOf {
 public:
  explicit FieldsOf(std::string_view first)
      : csv_(first), has_separators_(first.find_first_of(",;\t") != std::string_view::npos) {}

  std::vector<std::string> operator()(std::string_view line) {
    if (has_separators_) return csv_.SplitRow(line, kFewest);
    const auto words = Words(line);
    return {words.begin(), words.end()};
  }

 private:
  static constexpr size_t kFewest = 5;  // minimum, by the format; the last may be blank
  CsvFields csv_;
  bool has_separators_;
};

// The joint's label, with the person's name as prefix, as in TRC and C3D.
std::string LabelOf(const std::vector<std::string>& fields, const RowColumns& columns,
                    const std::string& joint) {
  return columns.body ? fields[*columns.body] + ":" + joint : joint;
}

// --- One joint per line.

/// Columns of a line; the defaults are the order without a header.
struct LineColumns : RowColumns {
  size_t joint = 1;
  std::array<size_t, 3> place = {2, 3, 4};
  size_t confidence = 5;  // may not exist
  size_t fields = 5;      // minimum number of fields
};

constexpr std::string_view kLine = "FRAME JOINT x y z [confidence]";

std::optional<LineColumns> FindLineColumns(const std::vector<std::string>& names) {
  LineColumns columns{FindRowColumns(names)};
  const auto find = [&](std::initializer_list<std::string_view> called) {
    const auto found = std::find_if(names.begin(), names.end(), [&](const std::string& name) {
      return std::find(called.begin(), called.end(), PlainName(name)) != called.end();
    });
    return static_cast<size_t>(found - names.begin());
  };
  columns.joint = find({"joint", "jointname", "name", "jointtype"});
  columns.place = {find({"x", "positionx"}), find({"y", "positiony"}), find({"z", "positionz"})};
  columns.confidence = find({"confidence", "score"});
  const size_t last = std::max({columns.joint, columns.place[0], columns.place[1], columns.place[2],
                                columns.clock.value_or(names.size())});
  if (last >= names.size()) return std::nullopt;
  columns.fields = std::max(last, columns.body.value_or(0)) + 1;
  return columns;
}

bool IsJointLine(const std::vector<std::string>& fields) {
  if (fields.size() != 5 && fields.size() != 6) return false;
  const auto is_number = [](const std::string& f) { return LooksLikeNumber(f) || IsNan(f); };
  return LooksLikeNumber(fields[0]) && !fields[1].empty() && !is_number(fields[1]) &&
         std::all_of(fields.begin() + 2, fields.end(),
                     [&](const std::string& f) { return f.empty() || is_number(f); });
}

bool AreJointLines(const SkeletonSample& sample) {
  constexpr size_t kEnough = 3;  // lines, by hand
  if (sample.lines.size() < 2) return false;
  FieldsOf fields_of(sample.lines[0]);
  if (FindLineColumns(fields_of(sample.lines[0]))) return true;
  const size_t lines = std::min(kEnough, sample.lines.size());
  return std::all_of(sample.lines.begin(), sample.lines.begin() + static_cast<long>(lines),
                     [&](std::string_view line) { return IsJointLine(fields_of(line)); });
}

std::optional<double> ConfidenceIn(const TextLines& lines, const std::vector<std::string>& fields,
                                   size_t column) {
  if (column >= fields.size() || fields[column].empty() || IsNan(fields[column])) return {};
  const double value = NumberIn(lines, fields[column], "confidence");
  if (value < 0 || value > 1) lines.Fail("a confidence from 0 to 1", fields[column]);
  return value;
}

void TakeJointLine(const TextLines& lines, const std::vector<std::string>& fields,
                   const LineColumns& columns, JointTable& table) {
  if (fields.size() < columns.fields) lines.Fail(kLine, lines.line());
  table.Begin(lines, NumberIn(lines, fields[*columns.clock], "the frame or time"));
  const auto& [x, y, z] = columns.place;
  const std::string& joint = fields[columns.joint];
  table.Add(lines, LabelOf(fields, columns, joint),
            PlaceIn(lines, {fields[x], fields[y], fields[z]}, joint),
            ConfidenceIn(lines, fields, columns.confidence));
}

SkeletonSequence ReadJointLines(SkeletonInput& input) {
  TextLines lines(input.stream, input.name);
  lines.Expect(kLine);
  FieldsOf fields_of(lines.line());
  const auto header = FindLineColumns(fields_of(lines.line()));
  LineColumns columns = header.value_or(LineColumns{});
  if (!header) {
    columns.clock = 0;
    columns.time.is_stated = false;
  }
  JointTable table;
  for (bool more = !header || lines.NextFilled(); more; more = lines.NextFilled()) {
    TakeJointLine(lines, fields_of(lines.line()), columns, table);
  }
  return MakeSequence(input, table, columns);
}

// --- One frame per row.

struct NamedColumns {
  std::string joint;
  std::array<size_t, 3> place;
};

// Splits "SpineBase_x", "SpineBase.X", "SpineBase (x)", "SpineBase_Position_X" into joint and axis.
std::optional<std::pair<std::string, size_t>> JointAndAxis(std::string_view name) {
  constexpr std::string_view kBetween = " _.-:/([", kAxes = "xyz", kPosition = "position";
  while (name.ends_with(')') || name.ends_with(']')) name.remove_suffix(1);
  if (name.size() < 3) return std::nullopt;
  const std::string last = PlainName(name.substr(name.size() - 1));
  const size_t axis = last.empty() ? kAxes.npos : kAxes.find(last);
  name.remove_suffix(1);
  if (axis == kAxes.npos || kBetween.find(name.back()) == kBetween.npos) return std::nullopt;
  const auto trim = [&] { name = name.substr(0, name.find_last_not_of(kBetween) + 1); };
  trim();
  if (PlainName(name).ends_with(kPosition) && name.size() > kPosition.size()) {
    name.remove_suffix(kPosition.size());
    trim();
  }
  if (name.empty()) return std::nullopt;
  return std::pair{std::string(name), axis};
}

// Joints that lack an axis are left out: image key points are not joints.
std::vector<NamedColumns> FindJointColumns(const std::vector<std::string>& names) {
  std::vector<NamedColumns> joints;
  std::map<std::string, size_t> numbers;
  for (size_t c = 0; c < names.size(); ++c) {
    const auto found = JointAndAxis(names[c]);
    if (!found) continue;
    const auto& [joint, axis] = *found;
    const size_t number = numbers.emplace(joint, joints.size()).first->second;
    if (number == joints.size()) {
      joints.push_back({joint, {names.size(), names.size(), names.size()}});
    }
    size_t& column = joints[number].place[axis];
    column = std::min(column, c);
  }
  std::erase_if(joints, [&](const NamedColumns& j) {
    return std::any_of(j.place.begin(), j.place.end(), [&](size_t c) { return c == names.size(); });
  });
  return joints;
}

// Whether these are joint columns. Network key points are recognised by their noses; their axes and
// origins differ. Azure Kinect has a nose, too, and a spine.
bool AreJointColumns(const SkeletonSample& sample) {
  constexpr size_t kEnough = 3;  // joints, by hand
  if (sample.lines.empty()) return false;
  const auto names = ReadCsvHeader(sample.lines[0]);
  const auto has = [&](std::string_view part) {
    return std::any_of(names.begin(), names.end(), [part](const std::string& name) {
      return PlainName(name).find(part) != std::string::npos;
    });
  };
  return FindJointColumns(names).size() >= kEnough && (!has("nose") || has("spinenavel"));
}

SkeletonSequence ReadJointColumns(SkeletonInput& input) {
  constexpr std::string_view kHeader = "a header of columns NAME_x NAME_y NAME_z";
  TextLines lines(input.stream, input.name);
  lines.Expect(kHeader);
  CsvFields csv(lines.line());
  const auto names = ReadCsvHeader(lines.line());
  const auto joints = FindJointColumns(names);
  if (joints.empty()) lines.Fail(kHeader, lines.line());
  RowColumns columns = FindRowColumns(names);
  if (!columns.clock && columns.body) lines.Fail("a column frame or time, too", lines.line());
  if (!columns.clock) columns.time.counts_frames = true;
  JointTable table;
  for (size_t row = 0; lines.NextFilled(); ++row) {
    const auto fields = csv.SplitRow(lines.line(), names.size());
    if (fields.size() != names.size()) {
      lines.Fail(fmt::format("{} columns", names.size()), fmt::format("{} columns", fields.size()));
    }
    table.Begin(lines, columns.clock ? NumberIn(lines, fields[*columns.clock], "frame or time")
                                     : static_cast<double>(row));
    for (const auto& [joint, place] : joints) {
      const auto& [x, y, z] = place;
      table.Add(lines, LabelOf(fields, columns, joint),
                PlaceIn(lines, {fields[x], fields[y], fields[z]}, joint), {});
    }
  }
  return MakeSequence(input, table, columns);
}

constexpr SkeletonFormat kTableFormats[] = {
    {"joint-columns", AreJointColumns, ReadJointColumns},
    {"joint-lines", AreJointLines, ReadJointLines},
};

}  // namespace

std::span<const SkeletonFormat> TableFormats() { return kTableFormats; }

}  // namespace ossa::recon
