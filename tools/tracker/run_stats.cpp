#include "tools/tracker/run_stats.h"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace ossa::tracker {
namespace {

double Quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  const auto last = static_cast<double>(values.size() - 1);
  return values[static_cast<size_t>(std::lround(share * last))];
}

}  // namespace

void RunStats::Add(const StageTimes& ms) { times_.push_back(ms); }

std::string RunStats::Json(int64_t dropped) const {
  const auto quantile = [&](double StageTimes::*stage, double share) {
    std::vector<double> values;
    for (const StageTimes& ms : times_) values.push_back(ms.*stage);
    return std::round(1000 * Quantile(std::move(values), share)) / 1000;
  };
  double sum_ms = 0;
  for (const StageTimes& ms : times_) sum_ms += ms.total;
  const double fps = sum_ms > 0 ? 1000.0 * static_cast<double>(times_.size()) / sum_ms : 0.0;
  const nlohmann::ordered_json json = {{"frames", frames()},
                                       {"dropped", dropped},
                                       {"fps", std::round(100 * fps) / 100},
                                       {"ms",
                                        {{"segment", quantile(&StageTimes::segment, 0.5)},
                                         {"classify", quantile(&StageTimes::classify, 0.5)},
                                         {"propose", quantile(&StageTimes::propose, 0.5)},
                                         {"reconstruct", quantile(&StageTimes::reconstruct, 0.5)},
                                         {"physics", quantile(&StageTimes::physics, 0.5)},
                                         {"total", quantile(&StageTimes::total, 0.5)},
                                         {"total_p99", quantile(&StageTimes::total, 0.99)}}},
                                       {"peak_rss_mb", std::round(10 * PeakRss_mb()) / 10}};
  return json.dump(2) + "\n";
}

double PeakRss_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

}  // namespace ossa::tracker
