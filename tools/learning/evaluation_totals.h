#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "recon/body/parts.h"
#include "recon/skeleton.h"
#include "tools/learning/calibration.h"
#include "tools/learning/common_parts.h"
#include "tools/learning/evaluate.h"

namespace ossa::tools {

/// A proposal of one joint somewhere in a data set, for average precision.
struct RatedProposal {
  double confidence = 0.0;
  bool is_hit = false;  // the first within 10 cm of its true joint
};

/// Area under the precision-recall curve, in [0, 1], with precision made monotone (as PASCAL VOC
/// 2010 does). `positives` true joints exist; NaN where none does.
double AveragePrecision(std::vector<RatedProposal> proposals, int64_t positives);

/// Sums over a data set for an Evaluation. Pixels by true label, joints by
/// recon::Joint.
struct EvaluationTotals {
  std::array<int64_t, recon::kLabelCount> pixels{};
  std::array<int64_t, recon::kLabelCount> right{};
  std::array<int64_t, recon::kLabelCount> right_first{};  // before Relabel
  recon::JointArray<std::vector<RatedProposal>> rated;
  recon::JointArray<std::vector<RatedProposal>> rated_visible;
  recon::JointArray<int64_t> joints{};
  recon::JointArray<int64_t> joints_visible{};
  std::array<std::array<int64_t, recon::kLabelCount>, recon::kLabelCount>
      confusion{};  // truth × label
  std::vector<Evaluation::Frame> by_frame;
  std::array<int64_t, kCommonPartCount> common_pixels{};
  std::array<int64_t, kCommonPartCount> common_right{};
  Calibration seen_joints, inferred_joints;
  int64_t frames = 0, people = 0, swapped = 0, turned = 0, turned_swapped = 0, classified = 0;
  double classify_ms = 0, propose_ms = 0, relabel_ms = 0;
};

Evaluation Summarise(EvaluationTotals totals);

}  // namespace ossa::tools
