// Every method on every real recording; the SDK's own skeletons are the baseline.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "tools/experiments/experiments_internal.h"
#include "tools/experiments/metrics.h"
#include "tools/experiments/recordings.h"

namespace ossa::tools {
namespace {

std::string Number(const std::optional<double>& value, int digits = 2) {
  return value ? fmt::format("{:.{}f}", *value, digits) : "-";
}

ClipMetrics RawMetrics(const std::string& name, const std::vector<RecordedPair>& pairs) {
  std::vector<ClipMetrics> clips;
  for (const RecordedPair& recorded : pairs) {
    for (const PairedTracks& pair : PairUp(recorded.truth, recorded.observed)) {
      clips.push_back(Measure(pair));
    }
  }
  return MeanOverClips(name, clips);
}

std::vector<std::string> Row(const std::string& data, size_t clips, const ClipMetrics& m) {
  return {data,
          m.name,
          std::to_string(clips),
          std::to_string(m.frames),
          Number(m.mean_joint_error_cm),
          Number(m.parent_relative_error_cm),
          Number(m.offset_removed_error_cm),
          Number(m.acceleration_error_cm_per_frame2),
          Number(m.p99_cm, 1)};
}

}  // namespace

std::vector<Table> RunSdk(ExperimentContext& context) {
  Table table;
  table.title = "Methods on real recordings (cm, mean over clips)";
  table.columns = {"data",   "method",         "clips",        "frames", "mean error",
                   "eq. 18", "offset removed", "acceleration", "p99"};
  for (const bool incorrect : {false, true}) {
    const auto pairs = LoadUiPrmd(context.shared, incorrect);
    table.rows.push_back(Row(incorrect ? "UI-PRMD incorrect" : "UI-PRMD correct", pairs.size(),
                             RawMetrics("raw", pairs)));
  }
  const auto itop = LoadItop(context.shared);
  table.rows.push_back(Row("ITOP A2J", itop.size(), RawMetrics("raw", itop)));
  return {table};
}

}  // namespace ossa::tools
