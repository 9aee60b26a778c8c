#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "tools/experiments/experiment.h"
#include "tools/synth/dataset.h"

namespace ossa::tools {

// Settings and functions of `ossa experiment person-classifier`.

/// Motion of people who lie, kneel or crawl, of whom the given one has few: the level forest's
/// weights are fitted on it, too. A word for recon::LoadMocap.
inline constexpr const char* kFloorMotion = "authored-floor";

struct PersonClassifierSettings {
  std::string train, check;  // motion
  int performances = 0;      // on which the forest's weights are fitted
  int images = 0;            // on which the pose network's are fitted
  double prior = 0.0;        // FitLogistic()
};
PersonClassifierSettings ReadPersonClassifierSettings(ExperimentContext& context);

/// Share of the region's pixels that belong to its main person, and share of that person's pixels
/// in the region: [0, 1].
struct PixelShares {
  double of_piece = 0.0, of_person = 0.0;
};
PixelShares MeasureShares(const std::vector<int32_t>& pixels, const LabelledFrame& truth);

/// Terms of a logistic regression, the constant first.
struct LogisticExample {
  bool person = false;
  Eigen::VectorXd terms;
};

/// Maximum likelihood with a normal prior on all weights but the constant's, by Newton's method
/// (iteratively reweighted least squares). Both classes have the same total weight.
Eigen::VectorXd FitLogistic(const std::vector<LogisticExample>& examples, double prior);
double ScoreLogistic(const Eigen::VectorXd& weights, const Eigen::VectorXd& terms);

/// Shares of both classes whose score reaches each threshold: rows of a table with kPassedColumns.
inline const std::vector<std::string> kPassedColumns = {"what", "threshold", "people passed",
                                                        "others passed"};
void AddPassedRows(const std::string& what, const Eigen::VectorXd& weights,
                   const std::vector<LogisticExample>& examples, Table& table);

/// The weights as a C++ array.
std::string ArrayText(const std::string& name, const Eigen::VectorXd& weights);

/// tools/people/person_classifier_weights.inc: weights of the forest's features.
Table FitForestWeights(ExperimentContext& context);
/// tools/people/person_classifier_weights_from_above.inc: the same under the ceiling.
Table FitForestWeightsFromAbove(ExperimentContext& context);
/// tools/people/pose_weights.inc: weights of the forest's score and the pose network.
Table FitPoseWeights(ExperimentContext& context);

}  // namespace ossa::tools
