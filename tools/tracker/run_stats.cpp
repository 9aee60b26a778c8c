#include "tools/tracker/run_stats.h"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace ossa::tracker {
namespace {

constexpr double kShortest_ms = 1e-3;  // by hand
const double kBinLog = std::log(1.01);

double ThreeDecimals(double value) { return std::round(1000 * value) / 1000; }

}  // namespace

void TimeHistogram::Add(double ms) {
  // Bin 0 holds durations below the shortest (stages that did not run), the last all longer ones.
  const double bin = 1 + std::floor(std::log(std::max(ms, 0.0) / kShortest_ms) / kBinLog);
  const double last = static_cast<double>(bins_.size()) - 1;
  ++bins_[static_cast<size_t>(std::clamp(bin, 0.0, last))];
  ++count_;
  sum_ms_ += ms;
}

double TimeHistogram::Quantile(double share) const {
  const auto rank = std::llround(share * static_cast<double>(count_ - 1));
  int64_t passed = 0;
  for (size_t bin = 0; bin < bins_.size(); ++bin) {
    passed += bins_[bin];
    if (passed <= rank) continue;
    return bin == 0 ? 0.0 : kShortest_ms * std::exp((static_cast<double>(bin) - 0.5) * kBinLog);
  }
  return 0.0;  // nothing was added
}

void RunStats::Add(const StageTimes& ms) {
  segment_.Add(ms.segment);
  classify_.Add(ms.classify);
  propose_.Add(ms.propose);
  reconstruct_.Add(ms.reconstruct);
  physics_.Add(ms.physics);
  total_.Add(ms.total);
}

std::string RunStats::Json(int64_t dropped) const {
  const double sum_ms = total_.sum_ms();
  const double fps = sum_ms > 0 ? 1000.0 * static_cast<double>(frames()) / sum_ms : 0.0;
  const auto median = [](const TimeHistogram& ms) { return ThreeDecimals(ms.Quantile(0.5)); };
  const nlohmann::ordered_json json = {{"frames", frames()},
                                       {"dropped", dropped},
                                       {"fps", std::round(100 * fps) / 100},
                                       {"ms",
                                        {{"segment", median(segment_)},
                                         {"classify", median(classify_)},
                                         {"propose", median(propose_)},
                                         {"reconstruct", median(reconstruct_)},
                                         {"physics", median(physics_)},
                                         {"total", median(total_)},
                                         {"total_p99", ThreeDecimals(total_.Quantile(0.99))}}},
                                       {"peak_rss_mb", std::round(10 * PeakRss_mb()) / 10}};
  return json.dump(2) + "\n";
}

double PeakRss_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

}  // namespace ossa::tracker
