#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "tools/experiments/experiment.h"
#include "tools/synth/dataset.h"

namespace ossa::tools {

// What `ossa experiment person-classifier` fits, and how.

struct PersonClassifierSettings {
  std::string train, check;  // motion
  int performances = 0;      // of which the forest's weights are fitted
  int images = 0;            // of which the pose network's are
  double prior = 0.0;        // FitLogistic()
};
PersonClassifierSettings AskForPersonClassifier(ExperimentContext& context);

/// How much of a piece of the image is of the one person that it shows most of, and how much of
/// that person it is: [0, 1].
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
/// (iteratively reweighted least squares). Both kinds weigh the same however many there are.
Eigen::VectorXd FitLogistic(const std::vector<LogisticExample>& examples, double prior);
double ScoreLogistic(const Eigen::VectorXd& weights, const Eigen::VectorXd& terms);

/// What of both kinds has at least so much: a row a threshold, for a table of kPassedColumns.
inline const std::vector<std::string> kPassedColumns = {"what", "threshold", "people passed",
                                                        "others passed"};
void AddPassedRows(const std::string& what, const Eigen::VectorXd& weights,
                   const std::vector<LogisticExample>& examples, Table& table);

/// As a C++ array.
std::string ArrayText(const std::string& name, const Eigen::VectorXd& weights);

/// tools/people/person_classifier_weights.inc: by what the forest sees.
Table FitForestWeights(ExperimentContext& context);
/// tools/people/person_classifier_weights_from_above.inc: the same under the ceiling.
Table FitForestWeightsFromAbove(ExperimentContext& context);
/// tools/people/pose_weights.inc: by the forest's score and the pose network.
Table FitPoseWeights(ExperimentContext& context);

}  // namespace ossa::tools
