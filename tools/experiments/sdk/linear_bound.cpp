// How good can a linear filter be? For every joint the best one there is: a finite filter that sees
// the frame, one frame after it and a number before it (N. Wiener 1949, in discrete time: its
// weights are the least-squares regression of the truth on what was seen), fitted on the other
// people and tried on those left out. What it leaves, no filter of fixed weights takes away.
#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <array>

#include "tools/experiments/sdk/method_runs.h"
#include "tools/experiments/sdk/sdk_internal.h"

namespace ossa::tools {
namespace {

// Constants: frames of the window, by hand.

constexpr int kAhead = 1, kBack = 12, kTaps = kAhead + 1 + kBack;
using Taps = Eigen::Matrix<double, kTaps, 1>;
using Positions = Eigen::Matrix3Xd;  // one column a frame
using JointTaps = recon::JointArray<Taps>;

/// What is to be small on the people learned from: the error without its mean, in position, and
/// `acceleration` times the error in second differences.
struct Goal {
  const char* name;
  double position, acceleration;
};
constexpr std::array<Goal, 6> kGoals = {{{"position", 1.0, 0.0},
                                         {"both", 1.0, 1.0},
                                         {"both", 1.0, 3.0},
                                         {"both", 1.0, 10.0},
                                         {"both", 1.0, 100.0},
                                         {"acceleration", 0.0, 1.0}}};

/// A joint's way through a clip; empty where it is missing in any frame.
Positions CollectPath(const std::vector<SparsePosture>& postures, size_t joint) {
  Positions way(3, postures.size());
  for (size_t f = 0; f < postures.size(); ++f) {
    if (!postures[f].present[joint]) return Positions(3, 0);
    way.col(static_cast<Eigen::Index>(f)) = postures[f].position_m[joint];
  }
  return way;
}

Positions Centred(const Positions& way) { return way.colwise() - way.rowwise().mean(); }

Positions SecondDifferences(const Positions& way) {
  const Eigen::Index n = way.cols() - 2;
  return way.rightCols(n) - 2.0 * way.middleCols(1, n) + way.leftCols(n);
}

/// The frame `offset` later in every column; the clip's ends stand still.
Positions Shifted(const Positions& way, int offset) {
  Positions out(3, way.cols());
  for (Eigen::Index f = 0; f < way.cols(); ++f) {
    out.col(f) = way.col(std::clamp<Eigen::Index>(f + offset, 0, way.cols() - 1));
  }
  return out;
}

/// The normal equations of one joint's filter.
struct Regression {
  Eigen::Matrix<double, kTaps, kTaps> square = Eigen::Matrix<double, kTaps, kTaps>::Zero();
  Taps product = Taps::Zero();

  void Add(const Positions& seen, const Positions& truth, const Goal& goal) {
    std::array<Positions, kTaps> shifted;
    for (int k = 0; k < kTaps; ++k) shifted[static_cast<size_t>(k)] = Shifted(seen, kAhead - k);
    AddAs(shifted, truth, goal.position, Centred);
    AddAs(shifted, truth, goal.acceleration, SecondDifferences);
  }

  /// Weights that sum to one: what stands still stays where it is.
  Taps Solve() const {
    const auto factors = (square + 1e-9 * Taps::Ones().asDiagonal().toDenseMatrix()).ldlt();
    const Taps free = factors.solve(product), rise = factors.solve(Taps::Ones());
    return free + (1.0 - free.sum()) / rise.sum() * rise;
  }

 private:
  template <typename Part>
  void AddAs(const std::array<Positions, kTaps>& shifted, const Positions& truth, double weight,
             Part part) {
    if (weight == 0.0) return;
    const Positions target = part(truth);
    Eigen::MatrixXd regressors(target.size(), kTaps);
    for (int k = 0; k < kTaps; ++k) {
      regressors.col(k) = part(shifted[static_cast<size_t>(k)]).reshaped();
    }
    square += weight * regressors.transpose() * regressors;
    product += weight * regressors.transpose() * target.reshaped();
  }
};

constexpr Eigen::Index kFewestFrames = kTaps;

JointTaps LearnFilters(const std::vector<const RecordedPair*>& recordings, const Goal& goal) {
  recon::JointArray<Regression> regressions;
  for (const RecordedPair* recorded : recordings) {
    for (const PairedTracks& pair : PairUp(recorded->truth, recorded->observed)) {
      for (size_t j = 0; j < recon::kJointCount; ++j) {
        const Positions seen = CollectPath(pair.result, j), truth = CollectPath(pair.truth, j);
        if (seen.cols() < kFewestFrames || truth.cols() < kFewestFrames) continue;
        regressions[j].Add(seen, truth, goal);
      }
    }
  }
  JointTaps taps;
  for (size_t j = 0; j < recon::kJointCount; ++j) taps[j] = regressions[j].Solve();
  return taps;
}

PairedTracks Filtered(PairedTracks pair, const JointTaps& taps) {
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    const Positions seen = CollectPath(pair.result, j);
    if (seen.cols() < kFewestFrames) continue;
    Positions made = Positions::Zero(3, seen.cols());
    for (int k = 0; k < kTaps; ++k) made += taps[j][k] * Shifted(seen, kAhead - k);
    for (size_t f = 0; f < pair.result.size(); ++f) {
      pair.result[f].position_m[j] = made.col(static_cast<Eigen::Index>(f));
    }
  }
  return pair;
}

}  // namespace

void AddLinearBound(const std::string& data, const std::vector<Fold>& folds, Table* table) {
  for (const Goal& goal : kGoals) {
    std::vector<ClipMetrics> clips;
    for (const Fold& fold : folds) {
      const JointTaps taps = LearnFilters(fold.train, goal);
      for (const RecordedPair* recorded : fold.test) {
        for (PairedTracks& pair : PairUp(recorded->truth, recorded->observed)) {
          clips.push_back(Measure(Filtered(std::move(pair), taps)));
        }
      }
    }
    table->rows.push_back({data, goal.name,
                           fmt::format("{:g} : {:g}", goal.position, goal.acceleration),
                           MeanAndMedian(clips, &ClipMetrics::mean_joint_error_cm),
                           MeanAndMedian(clips, &ClipMetrics::offset_removed_error_cm),
                           MeanAndMedian(clips, &ClipMetrics::acceleration_error_cm_per_frame2)});
  }
}

Table EmptyLinearBound() {
  Table table;
  table.title = "The best linear filter with one frame of look-ahead (cm; median in brackets)";
  table.columns = {"data",       "fitted for",     "position : acceleration",
                   "mean error", "offset removed", "acceleration"};
  table.note = fmt::format(
      "Each joint's {} weights are fitted by least squares on the other people (of ITOP: the other "
      "half) and sum to one.",
      kTaps);
  return table;
}

}  // namespace ossa::tools
