#pragma once
#include <array>
#include <cstdint>
#include <string_view>

namespace ossa::recon {

/// Labels of part images: 0 background, 1..31 the body parts of Shotton et al. 2011, 32 any object
/// in front of or held by the person. U/W: upper/lower, L/R: the person's left/right.
inline constexpr int kPartCount = 31;
/// The label of any object in front of or held by a person, by convention.
inline constexpr int kOtherPart = 32;
/// Background, 31 parts, objects: by definition.
inline constexpr int kLabelCount = 33;

/// Names by label.
inline constexpr std::array<std::string_view, kLabelCount> kPartNames = {
    "background", "LU head", "RU head", "LW head", "RW head",  "neck",     "L shoulder",
    "R shoulder", "LU arm",  "RU arm",  "LW arm",  "RW arm",   "L elbow",  "R elbow",
    "L wrist",    "R wrist", "L hand",  "R hand",  "LU torso", "RU torso", "LW torso",
    "RW torso",   "LU leg",  "RU leg",  "LW leg",  "RW leg",   "L knee",   "R knee",
    "L ankle",    "R ankle", "L foot",  "R foot",  "other"};

/// The label on the other side of the body; midline labels map to themselves.
inline constexpr std::array<uint8_t, kLabelCount> kMirroredPart = {
    0,  2,  1,  4,  3,  5,  7,  6,  9,  8,  11, 10, 13, 12, 15, 14, 17,
    16, 19, 18, 21, 20, 23, 22, 25, 24, 27, 26, 29, 28, 31, 30, 32};

/// A colour, 0 to 255 each.
struct Rgb {
  uint8_t r = 0, g = 0, b = 0;
};

/// A colour per label, for pictures; left and right differ in hue.
Rgb PartColour(int label);

}  // namespace ossa::recon
