#include "recon/models/prior_network.h"

namespace ossa::recon {

float ObservationQuality(double sd_m) {
  constexpr double kHalfClear_m = 0.1;  // by hand
  return sd_m > 0.0 ? static_cast<float>(kHalfClear_m / (kHalfClear_m + sd_m)) : 0.0F;
}

}  // namespace ossa::recon
