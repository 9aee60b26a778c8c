#include "tools/learning/evaluation_totals.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

namespace ossa::tools {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

double Share(int64_t part, int64_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : kUnknown;
}

std::vector<double> Shares(std::span<const int64_t> parts, std::span<const int64_t> wholes) {
  std::vector<double> shares;
  for (size_t i = 0; i < parts.size(); ++i) shares.push_back(Share(parts[i], wholes[i]));
  return shares;
}

// Of what occurs: numbers that are not NaN.
double AverageKnown(std::span<const double> values) {
  double sum = 0;
  int count = 0;
  for (const double value : values) {
    if (std::isnan(value)) continue;
    sum += value;
    ++count;
  }
  return count > 0 ? sum / count : kUnknown;
}

// The 31 parts of a table by label: without background and `other`.
template <typename Table>
auto PartsOf(const Table& by_label) {
  return std::span(by_label).subspan(1, recon::kPartCount);
}

int64_t SumOf(std::span<const int64_t> counts) {
  return std::accumulate(counts.begin(), counts.end(), int64_t{0});
}

void SummarisePixels(const EvaluationTotals& totals, Evaluation* e) {
  e->pixel_accuracy = Share(SumOf(PartsOf(totals.right)), SumOf(PartsOf(totals.pixels)));
  e->class_accuracy = Shares(totals.right, totals.pixels);
  e->mean_class_accuracy = AverageKnown(PartsOf(e->class_accuracy));
  const std::vector<double> first = Shares(totals.right_first, totals.pixels);
  e->mean_class_accuracy_first_stage = AverageKnown(PartsOf(first));
  e->common_accuracy = Shares(totals.common_right, totals.common_pixels);
  e->mean_common_accuracy = AverageKnown(e->common_accuracy);
  e->swapped_left_right = Share(totals.swapped, SumOf(totals.pixels) > 0 ? totals.people : 0);
  e->swapped_left_right_turned = Share(totals.turned_swapped, totals.turned);
}

void SummariseJoints(EvaluationTotals totals, Evaluation* e) {
  std::vector<double> common;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    e->ap_10cm.push_back(AveragePrecision(std::move(totals.rated[j]), totals.joints[j]));
    e->ap_10cm_visible.push_back(
        AveragePrecision(std::move(totals.rated_visible[j]), totals.joints_visible[j]));
    if (IsCommonJoint(static_cast<recon::Joint>(j))) common.push_back(e->ap_10cm.back());
  }
  e->map_10cm = AverageKnown(e->ap_10cm);
  e->map_10cm_visible = AverageKnown(e->ap_10cm_visible);
  e->map_10cm_common = AverageKnown(common);
  e->seen_joints = totals.seen_joints;
  e->inferred_joints = totals.inferred_joints;
}

void SummariseTimes(const EvaluationTotals& totals, Evaluation* e) {
  const auto people = static_cast<double>(std::max<int64_t>(totals.people, 1));
  const auto classified = static_cast<double>(std::max<int64_t>(totals.classified, 1));
  e->ns_per_pixel = totals.classify_ms * 1e6 / classified;
  e->relabel_ns_per_pixel = totals.relabel_ms * 1e6 / classified;
  e->classify_ms = totals.classify_ms / people;
  e->propose_ms = totals.propose_ms / people;
}

}  // namespace

double AveragePrecision(std::vector<RatedProposal> proposals, int64_t positives) {
  if (positives == 0) return kUnknown;
  std::stable_sort(proposals.begin(), proposals.end(),
                   [](const auto& a, const auto& b) { return a.confidence > b.confidence; });
  std::vector<double> precision;
  int64_t hits = 0;
  for (size_t i = 0; i < proposals.size(); ++i) {
    hits += proposals[i].is_hit ? 1 : 0;
    precision.push_back(static_cast<double>(hits) / static_cast<double>(i + 1));
  }
  // Divided once, at the end: a sum of shares 1 / positives can round to more than 1.
  double area = 0;
  double best = 0;
  for (size_t i = proposals.size(); i-- > 0;) {
    best = std::max(best, precision[i]);
    if (proposals[i].is_hit) area += best;
  }
  return area / static_cast<double>(positives);
}

Evaluation Summarise(EvaluationTotals totals) {
  constexpr size_t kWorst = 12;  // frames, by eye: what one looks at
  Evaluation e;
  for (const auto& row : totals.confusion) e.confusion.emplace_back(row.begin(), row.end());
  std::stable_sort(
      totals.by_frame.begin(), totals.by_frame.end(),
      [](const auto& a, const auto& b) { return a.pixel_accuracy < b.pixel_accuracy; });
  totals.by_frame.resize(std::min(kWorst, totals.by_frame.size()));
  e.worst_frames = std::move(totals.by_frame);
  e.frames = totals.frames;
  e.people = totals.people;
  SummarisePixels(totals, &e);
  SummariseTimes(totals, &e);
  SummariseJoints(std::move(totals), &e);
  return e;
}

}  // namespace ossa::tools
