#include "recon/motion/authored.h"

#include "recon/motion/authored_clip_internal.h"
#include "recon/motion/authored_moves_internal.h"

namespace ossa::recon {
namespace {

std::vector<Action> AllActions() {
  // New groups at the end: a clip's seed is its place, and clips once made stay as they are.
  std::vector<Action> all;
  for (const auto& group : {StandingActions(), WalkingActions(), HandActions(), SportActions(),
                            SeatedActions(), ExerciseActions()}) {
    all.insert(all.end(), group.begin(), group.end());
  }
  return all;
}

/// One well-mixed seed per clip (SplitMix64), so that clips do not depend on one another.
uint64_t ClipSeed(uint64_t seed, uint64_t action, uint64_t variation) {
  uint64_t z = seed + 0x9E3779B97F4A7C15u * (1 + action * 1000003u + variation);
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
  return z ^ (z >> 31);
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
