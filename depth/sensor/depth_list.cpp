#include "depth/sensor/depth_list.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <optional>
#include <utility>

#include "depth/base/error.h"
#include "depth/base/open_file.h"
#include "depth/base/statistics.h"
#include "depth/sensor/frame_names.h"

namespace ossa::depth {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kBlanks = " \t\r,";

std::string_view TakeWord(std::string_view& line) {
  line.remove_prefix(std::min(line.find_first_not_of(kBlanks), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(kBlanks));
  line.remove_prefix(word.size());
  return word;
}

// A file's name without quotes around it, and with the separators of this system.
std::string PathOf(std::string_view text) {
  constexpr std::string_view kAround = " \t\r,\"";
  const size_t begin = std::min(text.find_first_not_of(kAround), text.size());
  text.remove_prefix(begin);
  std::string path(text.substr(0, text.find_last_not_of(kAround) + 1));
  std::replace(path.begin(), path.end(), '\\', '/');
  return path;
}

std::optional<DepthList::Entry> ParseEntry(std::string_view line) {
  const std::string_view time = TakeWord(line);
  const std::string rest = PathOf(line);
  const std::string file = PathOf(TakeWord(line));
  double time_s = 0.0;
  const auto [end, error] = std::from_chars(time.data(), time.data() + time.size(), time_s);
  const bool whole = error == std::errc() && end == time.data() + time.size();
  constexpr double kLatest = 1e19;  // no unit: nanoseconds of three hundred years; an upper bound
  if (!whole || !(std::abs(time_s) < kLatest) || file.empty()) return std::nullopt;
  return DepthList::Entry{time_s, file, rest, 0};
}

// Converts times to seconds from the first entry.
void CountSeconds(DepthList& list) {
  std::vector<double> steps;
  for (size_t i = 1; i < list.entries.size(); ++i) {
    steps.push_back(list.entries[i].time_s - list.entries[i - 1].time_s);
  }
  if (!steps.empty()) list.unit_s = GuessTimeUnit(Median(std::move(steps))).value_or(1.0);
  const double first = list.entries.empty() ? 0.0 : list.entries.front().time_s;
  for (DepthList::Entry& entry : list.entries) entry.time_s = (entry.time_s - first) * list.unit_s;
}

}  // namespace

DepthList ParseDepthList(std::string_view text) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  // added by editors on Windows
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  DepthList list;
  for (int number = 1; !text.empty(); ++number) {
    std::string_view line = text.substr(0, text.find_first_of("\n"));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    if (line.find_first_not_of(kBlanks) == std::string_view::npos || line.front() == '#') continue;
    if (auto entry = ParseEntry(line)) {
      entry->line = number;
      list.entries.push_back(std::move(*entry));
    } else {
      list.bad_lines.push_back(number);
    }
  }
  std::stable_sort(list.entries.begin(), list.entries.end(),
                   [](const auto& a, const auto& b) { return a.time_s < b.time_s; });
  CountSeconds(list);
  return list;
}

DepthList ReadDepthList(const fs::path& folder) {
  constexpr std::uintmax_t kLargest = std::uintmax_t{256} << 20;  // ten times a day of frames
  const fs::path path = folder / "depth.txt";
  std::error_code none;
  if (!fs::is_regular_file(path, none)) return {};
  if (fs::file_size(path, none) > kLargest) return {};
  std::ifstream file = OpenFile(path);
  if (!file) throw InputError(path.string() + ": cannot be read: expected a list of frames");
  const std::string text((std::istreambuf_iterator<char>(file)), {});
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) {
    throw InputError(path.string() + ": expected text in UTF-8, found UTF-16: save it as UTF-8");
  }
  return ParseDepthList(text);
}

}  // namespace ossa::depth
