#include "tools/experiments/real/real_holes_internal.h"

#include "depth/base/random.h"

namespace ossa::tools {
namespace {

// Pixels of a row and of a column, by definition: a colour image with one and a half times as many.
constexpr int kGrid = 3;

bool IsOnGrid(size_t pixel, int width) {
  const auto w = static_cast<size_t>(width);
  return pixel % w % kGrid == 0 || pixel / w % kGrid == 0;
}

}  // namespace

std::string_view HolesName(Holes holes) {
  switch (holes) {
    case Holes::kTenth:
      return "10 % of the pixels";
    case Holes::kThird:
      return "30 % of the pixels";
    case Holes::kGrid:
      return "every third row and column";
  }
  return "";
}

RealSet WithHoles(RealSet set, Holes holes, uint64_t seed) {
  Random random(seed);
  const double share = holes == Holes::kTenth ? 0.1 : 0.3;
  for (RealStill& still : set.stills) {
    for (size_t i = 0; i < still.frame.depth_mm.size(); ++i) {
      const bool is_missing =
          holes == Holes::kGrid ? IsOnGrid(i, still.frame.camera.width) : random.Unit() < share;
      if (is_missing) still.frame.depth_mm[i] = 0;
    }
  }
  return set;
}

}  // namespace ossa::tools
