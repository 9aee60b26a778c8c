#pragma once
#include "recon/motion/authored_moves_internal.h"

namespace ossa::recon {

/// Motion of the arms during leg exercises; drawn once per clip.
enum class Arms {
  kHanging,
  kForwards,
  kOverhead,
  kCrossed,
  kOnHips,
  kSpread,
  kBarOverhead,     // a long bar held up with a wide grip
  kBarOnShoulders,  // ... behind the neck: elbows bent, hands beside the shoulders or above
};

Arms DrawArms(Moves& m);

/// `lean`: forward lean of the chest, degrees, compensated so that arms are level in the room.
void HoldArms(BodyKey& key, Arms arms, double lean);

/// Moves the arms before an exercise begins.
void RaiseArmsFirst(Moves& m, Arms arms);

}  // namespace ossa::recon
