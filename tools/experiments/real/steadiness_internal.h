#pragma once
#include <deque>
#include <map>
#include <vector>

#include "tools/experiments/real/real_evaluation_internal.h"

namespace ossa::tools {

/// Where each stage puts the joints of one body, metres.
using BodyStages = std::map<RealStage, StageJoints>;

/// How steady the bodies of a recording are, stage by stage.
class Steadiness {
 public:
  /// Everybody in the next frame, by number. Who is not among them is new when they come back.
  void Add(const std::map<int, BodyStages>& bodies);

  /// Root mean square distance from their mean over six frames, millimetres, of joints that hold
  /// still: whose raw places of the first three and of the last three frames have means within a
  /// centimetre of each other.
  std::map<RealStage, double> MeasureJitter() const;
  /// Standard deviation over mean of bones' lengths, per cent, averaged over the bones.
  std::map<RealStage, double> MeasureBoneVariation() const;
  /// In 100 frames so many joints are more than half a metre from where they were a frame before.
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
