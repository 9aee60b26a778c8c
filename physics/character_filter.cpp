#include "physics/character_filter.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "recon/t_pose.h"

namespace ossa::physics {
namespace {

using recon::kJointCount;
using recon::Posture;

// Constants: chosen by hand.
constexpr double kLongestStep_s = 0.25;
constexpr double kFarthestTarget_m = 1000.0;  // farther targets are invalid

bool IsUsable(const Eigen::Vector3d& place_m) {
  return place_m.allFinite() && place_m.cwiseAbs().maxCoeff() <= kFarthestTarget_m;
}

}  // namespace

struct CharacterFilter::Impl {
  Impl(const recon::BoneLengths& bone_lengths, const CharacterFilterOptions& filter_options);

  bool MustPlace(const Posture& target, double dt_s);
  void PlaceAt(const Posture& target, const std::optional<recon::JointOrientations>& orientation);

  CharacterFilterOptions options;
  World world;
  int character = 0;
  bool alive = false;  // placed since construction or the last Reset
  int far_frames = 0;
};

namespace {

WorldOptions MakeWorldOptions(const CharacterFilterOptions& options) {
  WorldOptions world;
  world.substeps = options.substeps;
  world.seed = options.seed;
  return world;
}

CharacterOptions MakeCharacterOptions(const CharacterFilterOptions& options) {
  CharacterOptions character;
  character.control = options.control;
  character.gains = options.gains;
  character.lead = options.lead;
  character.pin_feet = options.pin_feet;
  character.self_collision = options.self_collision;
  character.hinges = options.hinges;
  character.joint_limits = options.joint_limits;
  character.stature_m = options.stature_m;
  character.mass_kg = options.mass_kg;
  return character;
}

}  // namespace

void CharacterFilterOptions::Check() const {
  MakeWorldOptions(*this).Check();
  MakeCharacterOptions(*this).Check(1.0 / 30.0 / substeps);
  if (!(teleport_m > 0.0) || teleport_frames < 1) {
    throw std::invalid_argument("teleport_m = " + std::to_string(teleport_m) +
                                ", teleport_frames = " + std::to_string(teleport_frames) +
                                ", must be positive");
  }
}

CharacterFilter::Impl::Impl(const recon::BoneLengths& lengths,
                            const CharacterFilterOptions& filter_options)
    : options(filter_options), world(MakeWorldOptions(filter_options)) {
  options.Check();
  // Initial posture if the first target is incomplete.
  character =
      world.AddCharacter(lengths, recon::BuildTPose(lengths), MakeCharacterOptions(options));
}

bool CharacterFilter::Impl::MustPlace(const Posture& target, double dt_s) {
  const bool gap = !(dt_s > 0.0 && dt_s <= kLongestStep_s);
  if (!alive || gap) return true;
  const bool far =
      recon::MeanDistance_m(world.StateOf(character).posture, target) > options.teleport_m;
  far_frames = far ? far_frames + 1 : 0;
  return far_frames >= options.teleport_frames;
}

/// Places the character at its target; unknown joints keep their bones' directions.
void CharacterFilter::Impl::PlaceAt(const Posture& target,
                                    const std::optional<recon::JointOrientations>& orientation) {
  Posture known = target;
  for (Eigen::Vector3d& p : known.position_m) {
    if (!IsUsable(p)) p.setConstant(std::nan(""));
  }
  const Posture start = recon::FilledFrom(world.StateOf(character).posture, known);
  world.Place(character, start, orientation);
  alive = true;
  far_frames = 0;
}

CharacterFilter::CharacterFilter(const recon::BoneLengths& lengths,
                                 const CharacterFilterOptions& options)
    : impl_(std::make_unique<Impl>(lengths, options)) {}
CharacterFilter::~CharacterFilter() = default;
CharacterFilter::CharacterFilter(CharacterFilter&&) noexcept = default;
CharacterFilter& CharacterFilter::operator=(CharacterFilter&&) noexcept = default;

FilteredPosture CharacterFilter::Step(const Posture& seen, std::span<const double> weight,
                                      const std::optional<Eigen::Vector4d>& floor, double dt_s,
                                      const std::optional<recon::JointOrientations>& orientation) {
  Impl& f = *impl_;
  Posture target = seen;
  // Untrusted joints must not determine the person's position, either.
  for (size_t i = 0; i < weight.size() && i < kJointCount; ++i) {
    if (!(weight[i] > 0.0)) target.position_m[i].setConstant(std::nan(""));
  }
  f.world.SetFloor(f.options.floor ? floor : std::nullopt);
  FilteredPosture result;
  result.placed = f.MustPlace(target, dt_s);
  if (result.placed) {
    f.PlaceAt(target, orientation);
    dt_s = 1.0 / 30.0;
  }
  f.world.SetTarget(f.character, target, weight, orientation);
  f.world.Step(dt_s);
  const CharacterState state = f.world.StateOf(f.character);
  result.posture = state.posture;
  result.orientation = state.orientation;
  result.left_foot_pinned = state.left_foot_pinned;
  result.right_foot_pinned = state.right_foot_pinned;
  result.max_anchor_gap_m = state.max_anchor_gap_m;
  result.max_solver_gap_m = state.max_solver_gap_m;
  result.floor_depth_m = f.world.Contacts().floor_depth_m;
  return result;
}

void CharacterFilter::Reset() { impl_->alive = false; }

}  // namespace ossa::physics
