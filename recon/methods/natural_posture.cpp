#include "recon/methods/natural_posture_internal.h"

#include <algorithm>

#include "recon/methods/bone_turns_internal.h"

namespace ossa::recon {

namespace {

/// The posture with each joint moved towards its observation by its reliability.
PostureVector WithReliableJoints(const PostureVector& posture, const EnergyInputs& energy) {
  const PostureVector r = CoordinateWeights(energy.reliability);
  return posture + r.cwiseProduct(energy.observed - posture);
}

/// Departure: without reliable joints all postures are equal by eq. 9, and eq. 14 alone would
/// continue the last motion forever.
bool IsNoneReliable(const JointWeights& reliability) {
  constexpr double kLeast = 0.05;  // R_i, a share; by hand
  return std::none_of(reliability.begin(), reliability.end(), [](double r) { return r > kLeast; });
}

/// Replaces the observation by the last posture: its neighbours are selected, at rest.
void HoldLast(EnergyInputs& energy) {
  energy.observed = *energy.last;
  energy.before_last = energy.last;
  energy.reliability.fill(1.0);
}

}  // namespace

ReconstructedPosture NaturalPostureMethod::Step(const ReconstructionInput& input) {
  const PreparedPosture prepared = person_.Prepare(input);
  if (prepared.restarted) {
    last_.reset();
    before_last_.reset();
    selected_.clear();
  }
  const EnergyInputs energy = Inputs(prepared);
  selected_ = Select(energy, prepared, input, std::move(selected_));
  const PostureSpace space = MakePostureSpace(*database_, selected_, options_.dimensions);
  const SearchResult found = Search(space, energy);
  ++frame_;
  before_last_ = last_;
  last_ = space.Posture(found.q);
  const PostureVector shown = options_.keep_reliable ? WithReliableJoints(*last_, energy) : *last_;
  ReconstructedPosture out{person_.InCamera(ToPosture(shown), prepared), prepared.reliability};
  const auto weights = InverseDistances(*database_, selected_, *last_, energy.reliability);
  out.orientation =
      TurnedOntoBones(*database_, selected_, weights, out.posture, prepared.placement.yaw_rad);
  person_.Remember(out.posture, prepared);
  return out;
}

void NaturalPostureMethod::Reset() {
  person_.Reset();
  last_.reset();
  before_last_.reset();
  selected_.clear();
  frame_ = 0;
}

EnergyInputs NaturalPostureMethod::Inputs(const PreparedPosture& prepared) const {
  EnergyInputs energy;
  energy.observed = ToVector(prepared.normalised);
  // Method B of Shum 2013: all observed joints have equal weight.
  energy.reliability = options_.use_reliability ? prepared.reliability : prepared.present;
  energy.lengths_m = database_->bone_lengths_m();
  energy.last = last_;
  energy.before_last = before_last_;
  if (last_ && IsNoneReliable(energy.reliability)) HoldLast(energy);
  return energy;
}

SearchResult NaturalPostureMethod::Search(const PostureSpace& space,
                                          const EnergyInputs& energy) const {
  // Sec. VI-E: start from the last result, so that similar postures are always explored.
  const Eigen::VectorXf start =
      last_ ? space.Project(*last_) : Eigen::VectorXf(space.neighbours.col(0));
  if (options_.solver == "ceres") return SearchCeres(space, energy, options_, start);
  return SearchStochastic(space, energy, options_, start, seed_ + frame_);
}

}  // namespace ossa::recon
