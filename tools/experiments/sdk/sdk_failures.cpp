// Gross failures of SDKs in recordings without truth: their number, how many the reliability of
// Shum 2013 detects without tracking states, and how many remain in a method's output.
#include <fmt/format.h>

#include "recon/reliability.h"
#include "tools/experiments/sdk/gross_failures.h"
#include "tools/experiments/sdk/method_runs.h"
#include "tools/experiments/sdk/sdk_internal.h"

namespace ossa::tools {
namespace {

/// The recordings of one source, without tracking states, so that failures are detected from motion
/// only.
std::map<std::string, std::vector<recon::SkeletonSequence>> Recordings(
    const ExperimentContext& context) {
  std::map<std::string, std::vector<recon::SkeletonSequence>> sources;
  const auto take = [&](const std::string& source, recon::SkeletonSequence sequence) {
    for (auto& frame : sequence.frames) {
      for (auto& body : frame.bodies) {
        for (auto& joint : body.joints) {
          if (joint) joint->state.reset();
        }
      }
    }
    sources[source].push_back(std::move(sequence));
  };
  for (auto& clip : LoadWithoutTruth(context.shared)) {
    const bool keraal = clip.clip.starts_with("kinect_only");
    take(keraal ? "KERAAL, Kinect v2" : clip.clip.substr(0, clip.clip.find('/')),
         std::move(clip.observed));
  }
  for (auto& clip : LoadKeraal(context.shared)) take("KERAAL, Kinect v2", std::move(clip.observed));
  return sources;
}

std::string Percent(int64_t part, int64_t whole, int digits) {
  return fmt::format(
      "{:.{}f}",
      100.0 * static_cast<double>(part) / static_cast<double>(std::max<int64_t>(whole, 1)), digits);
}

std::vector<std::string> Row(const std::string& source, const std::string& method,
                             const GrossFailures& raw, const GrossFailures& made) {
  const int64_t failures = raw.jumps + raw.snaps;
  const bool judged = method != "raw" && failures > 0;
  return {source,
          method,
          std::to_string(raw.frames),
          std::to_string(made.jumps),
          std::to_string(made.snaps),
          std::to_string(made.wrong_bones),
          judged ? Percent(raw.noticed, failures, 0) : "-",
          method != "raw" ? Percent(raw.doubted, raw.joints, 1) : "-",
          fmt::format("{:.2f}", made.jitter_cm)};
}

}  // namespace

Table GrossFailureTable(const ExperimentContext& context, const std::vector<std::string>& methods,
                        const recon::ReconstructorOptions& options) {
  Table table;
  table.title = "Gross failures in recordings without truth";
  table.columns = {"data",        "method",     "frames",     "jumps",     "hand snaps",
                   "wrong bones", "noticed, %", "doubted, %", "jitter, cm"};
  for (const auto& [source, clips] : Recordings(context)) {
    for (const std::string& method : methods) {
      if (IsLearned(method) && !HasOptionalCorrection(method)) continue;  // nothing to learn from
      GrossFailures raw, made;
      for (const recon::SkeletonSequence& clip : clips) {
        MethodRun run{method, options, {}};
        run.options.method = method;
        const auto result = recon::FindMethod(method) == nullptr ? RunMethod(clip, method, options)
                                                                 : RunMethod(context, run, clip);
        raw += CountGrossFailures(clip, result, clip);
        made += CountGrossFailures(result, result, clip);
      }
      table.rows.push_back(Row(source, method, raw, made));
    }
  }
  table.note =
      "Jumps: a joint leaves its parent's side by 25 cm between two frames. Hand snaps: hands 25 "
      "cm "
      "apart are within 10 cm in the next frame. Wrong bones: 40 % off the median of what the "
      "sensor "
      "said in the recording. Noticed: share of the sensor's jumps and snaps to whose joint the "
      "method gives a reliability below one half, in the frame after or before (one of the two is "
      "wrong); doubted: share of all joints that have one. Tracking states are taken away. Jitter: "
      "mean second difference.";
  return table;
}

}  // namespace ossa::tools
