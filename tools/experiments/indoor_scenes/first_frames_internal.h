#pragma once
#include <array>
#include <cstdint>
#include <string_view>

#include "tools/synth/frame_maker.h"

namespace ossa::tools {

// Images of one person in any clothes, with a given occluder and background.

struct FirstFrameKind {
  std::string_view name;  // of the table
  Occluders occluders;
};
inline constexpr std::array kFirstFrameKinds = {
    FirstFrameKind{"nothing", Occluders::kNone},
    FirstFrameKind{"an object in the hands", Occluders::kHeld},
    FirstFrameKind{"an object in front", Occluders::kScene},
    FirstFrameKind{"cloth, boards, paper, boxes held up", Occluders::kHeldUp},
    FirstFrameKind{"a desk or a chair's arms", Occluders::kDesk},
    FirstFrameKind{"a wheelchair", Occluders::kWheelchair},
    FirstFrameKind{"crutches", Occluders::kCrutches},
};

struct FirstFramePlace {
  std::string_view name;
  Background background;
};
inline constexpr std::array kFirstFramePlaces = {
    FirstFramePlace{"cut out", Background::kNone},
    FirstFramePlace{"lived-in room", Background::kLivedIn},
};

FrameOptions FirstFrameOptions(const FirstFrameKind& kind, const FirstFramePlace& place,
                               Split split, uint64_t seed);

}  // namespace ossa::tools
