#include "recon/motion/authored.h"

#include "depth/base/random.h"
#include "recon/motion/authored_clip_internal.h"
#include "recon/motion/authored_moves_internal.h"

namespace ossa::recon {
namespace {

std::vector<Action> AllActions() {
  // Append new groups at the end: a clip's seed depends on its index, and existing clips must not
  // change.
  std::vector<Action> all;
  for (const auto& group : {StandingActions(), WalkingActions(), HandActions(), SportActions(),
                            SeatedActions(), LegExerciseActions(), UpperBodyExerciseActions()}) {
    all.insert(all.end(), group.begin(), group.end());
  }
  return all;
}

/// One well-mixed seed per clip (SplitMix64), so that clips are independent of one another.
uint64_t ClipSeed(uint64_t seed, uint64_t action, uint64_t variation) {
  return Random::BitsAt(seed, action * 1000003u + variation);
}

}  // namespace

std::vector<std::string> AuthoredActions() {
  std::vector<std::string> names;
  for (const Action& action : AllActions()) names.emplace_back(action.name);
  return names;
}

std::vector<MotionClip> AuthoredClips(const AuthoredOptions& options) {
  return PlayActions<Moves>("authored", AllActions(), options, [&](uint64_t action, uint64_t v) {
    return ClipSeed(options.seed, action, v);
  });
}

}  // namespace ossa::recon
