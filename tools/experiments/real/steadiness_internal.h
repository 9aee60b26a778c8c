#pragma once
#include <deque>
#include <map>
#include <vector>

#include "tools/experiments/real/real_evaluation_internal.h"

namespace ossa::tools {

/// Where each stage puts the joints of one body, metres.
using BodyStages = std::map<RealStage, StageJoints>;

/// Steadiness of the bodies of a recording, for each stage.
class Steadiness {
 public:
  /// Adds a frame: its bodies by id. A body that is absent from a frame counts as new afterwards.
  void Add(const std::map<int, BodyStages>& bodies);

  /// RMS distance of resting joints from their mean over six frames, millimetres. A joint rests if
  /// the means of its raw positions over the first and over the last three frames are within a
  /// centimetre.
  std::map<RealStage, double> MeasureJitter() const;
  /// Standard deviation over mean of the bones' lengths, percent, mean over the bones.
  std::map<RealStage, double> MeasureBoneVariation() const;
  /// Joints per 100 frames that are more than half a metre from their position a frame before.
  std::map<RealStage, double> CountLeaps() const;

 private:
  using Window = std::deque<BodyStages>;  // of one body, the newest last

  void AddJitter(const Window& window);
  void AddLeaps(const Window& window);
  void AddBones(const BodyStages& body);

  int64_t frames_ = 0;
  std::map<int, Window> windows_;  // by body
  std::map<RealStage, double> jitter_squares_;
  std::map<RealStage, int64_t> jitter_count_, leaps_;
  std::map<RealStage, recon::JointArray<std::vector<double>>> bones_m_;
};

}  // namespace ossa::tools
