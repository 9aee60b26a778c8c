#include "recon/motion/authored_arms_internal.h"

namespace ossa::recon {

// Constants: of the authored body, anthropometry: a person of 1.75 m, rounded; the rest by eye.

Arms DrawArms(Moves& m) { return static_cast<Arms>(m.Count(0, 7)); }

void HoldArms(BodyKey& key, Arms arms, double lean) {
  for (size_t s = 0; s < 2; ++s) {
    ArmKey& arm = key.arm[s];
    switch (arms) {
      case Arms::kHanging:
        arm = {4.0 + 0.8 * lean, 15.0, 0.97, 0.0, 10.0};
        break;
      case Arms::kForwards:
        arm = {86.0 + lean, 2.0, 0.97, 0.0, 30.0};
        break;
      case Arms::kOverhead:
        arm = {166.0, 14.0, 0.97, 0.0, 0.0};
        break;
      case Arms::kCrossed:
        ReachFor(key, s, {-0.1, -0.13 - 0.04 * static_cast<double>(s), 0.22});
        arm.swivel = 25.0;
        arm.pronate = 40.0;
        break;
      case Arms::kOnHips:
        ReachFor(key, s, {0.22, -0.42, 0.03});
        arm.swivel = 45.0;
        break;
      case Arms::kSpread:
        arm = {0.0, 88.0, 0.97, 0.0, 10.0};
        break;
      case Arms::kBarOverhead:
        arm = {0.0, 146.0, 0.95, 0.0, 0.0};
        break;
      case Arms::kBarOnShoulders:
        ReachFor(key, s, {0.36, 0.08, -0.02});
        arm.swivel = -10.0;
        break;
    }
  }
}

void RaiseArmsFirst(Moves& m, Arms arms) {
  m.To(0.7, [&](BodyKey& key) { HoldArms(key, arms, 0.0); });
}

}  // namespace ossa::recon
