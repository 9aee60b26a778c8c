#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "recon/motion/authored.h"

namespace ossa::recon {

/// All variations of all actions, named PREFIX/ACTION/NN. `MovesOf` is the class an action performs
/// with, constructed from a seed; `seed_of` (action, variation) computes that seed.
template <typename MovesOf, typename Actions, typename SeedOf>
std::vector<MotionClip> PlayActions(std::string_view prefix, const Actions& actions,
                                    const AuthoredOptions& options, const SeedOf& seed_of) {
  std::vector<MotionClip> clips;
  for (size_t a = 0; a < actions.size(); ++a) {
    for (int v = 0; v < options.variations; ++v) {
      MovesOf moves(seed_of(static_cast<uint64_t>(a), static_cast<uint64_t>(v)));
      actions[a].perform(moves);
      MotionClip& clip = clips.emplace_back();
      clip.name.append(prefix).append("/").append(actions[a].name).append("/");
      clip.name.append(v < 10 ? "0" : "").append(std::to_string(v));
      clip.subject = "authored";
      clip.frame_s = options.frame_s;
      clip.frames = moves.Play(options.frame_s);
    }
  }
  return clips;
}

}  // namespace ossa::recon
