// Where a method is farthest off: the recordings by person and exercise.
#include <algorithm>
#include <map>

#include "tools/experiments/sdk/method_runs.h"
#include "tools/experiments/sdk/sdk_internal.h"

namespace ossa::tools {
namespace {

constexpr double kHard_cm = 10.0;  // twice what a sensor's own joints are off by; by hand

/// Of "s01/m03_s01_e09", "s01" and "m03".
std::pair<std::string, std::string> PersonAndExercise(const std::string& clip) {
  const size_t slash = std::min(clip.find('/'), clip.size());
  const size_t name = std::min(slash + 1, clip.size());
  return {clip.substr(0, slash), clip.substr(name, clip.find('_', name) - name)};
}

}  // namespace

Table HardestTable(const std::string& data, const std::vector<MethodScore>& scores) {
  Table table;
  table.title = data + ": persons and exercises that are 10 cm off and more, eq. 18, cm";
  table.columns = {"person", "exercise", "clips"};
  using Clips = std::vector<ClipMetrics>;
  std::map<std::pair<std::string, std::string>, std::vector<Clips>> groups;
  for (size_t m = 0; m < scores.size(); ++m) {
    table.columns.push_back(scores[m].method);
    for (const ClipMetrics& clip : scores[m].clips) {
      auto& of_methods = groups[PersonAndExercise(clip.name)];
      of_methods.resize(scores.size());
      of_methods[m].push_back(clip);
    }
  }
  const auto add = [&](const std::string& person, const std::string& exercise,
                       const std::vector<Clips>& of_methods) {
    table.rows.push_back({person, exercise, std::to_string(of_methods.back().size())});
    for (const Clips& clips : of_methods) {
      table.rows.back().push_back(MeanAndMedian(clips, &ClipMetrics::parent_relative_error_cm));
    }
  };
  std::vector<Clips> others(scores.size());
  for (const auto& [group, of_methods] : groups) {
    const auto last = Average(of_methods.back(), &ClipMetrics::parent_relative_error_cm);
    if (last && *last >= kHard_cm) {
      add(group.first, group.second, of_methods);
      continue;
    }
    for (size_t m = 0; m < scores.size(); ++m) {
      others[m].insert(others[m].end(), of_methods[m].begin(), of_methods[m].end());
    }
  }
  if (!scores.empty()) add("all others", "", others);
  table.note = "Mean over clips, median in brackets; 10 cm of the method in the last column.";
  return table;
}

}  // namespace ossa::tools
