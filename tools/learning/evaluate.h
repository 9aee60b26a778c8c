#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "forest/forest.h"
#include "forest/proposals/propose.h"
#include "tools/learning/calibration.h"
#include "tools/synth/dataset.h"

namespace ossa::tools {

/// The result of `ossa evaluate` (docs/architecture.md, "Reports"). NaN: the accuracy of a class or
/// the average precision of a joint that does not occur in the data.
struct Evaluation {
  /// A frame with many wrong pixels, as a picture.
  struct Frame {
    int64_t index = 0;
    double pixel_accuracy = 1.0;
    std::vector<uint8_t> png;  // depth | true parts | the model's
  };
  int64_t frames = 0;
  int64_t people = 0;
  double pixel_accuracy = 0.0;  // over pixels of the 31 parts; NaN for a model of PCL's classes
  double mean_class_accuracy = 0.0;              // of the 31 parts that occur
  double mean_class_accuracy_first_stage = 0.0;  // of labels before relabelling
  std::vector<double> class_accuracy;            // by label
  std::vector<double> ap_10cm;                   // by joint
  std::vector<double> ap_10cm_visible;
  double map_10cm = 0.0;  // means over the joints that occur
  double map_10cm_visible = 0.0;
  std::vector<double> common_accuracy;  // of parts told by PCL's people trees too
  double mean_common_accuracy = 0.0;
  double map_10cm_common = 0.0;     // over joints that lie within one class of either
  Calibration seen_joints;          // of each joint's best proposal within 10 cm
  Calibration inferred_joints;      // the same where no surface of the joint's own voted
  double swapped_left_right = 0.0;  // share of people most of whose paired parts are mirrored
  double swapped_left_right_turned = 0.0;  // of those turned by more than 60°
  double ns_per_pixel = 0.0;               // person pixel, all trees, one thread
  double classify_ms = 0.0;                // a person
  double propose_ms = 0.0;
  double relabel_ns_per_pixel = 0.0;
  std::vector<std::vector<int64_t>> confusion;  // pixels, by true label and by the model's
  std::vector<Frame> worst_frames;              // of fewest pixels right first
};

/// `step` > 1 looks at every step-th frame. `progress(done, total)` returns false to stop early.
/// Throws InputError that names the model by `name` where it is none of people.
Evaluation Evaluate(const forest::ForestModel& model, const std::string& name,
                    const DatasetReader& dataset, int64_t step,
                    const std::function<bool(int64_t, int64_t)>& progress);

std::string EvaluationJson(const Evaluation& evaluation);
/// One page that stands by itself: bars of accuracy by class and joint, which part is taken for
/// which, how far confidences are to be trusted, and the worst frames.
std::string EvaluationHtml(const Evaluation& evaluation, const std::string& title);

}  // namespace ossa::tools
