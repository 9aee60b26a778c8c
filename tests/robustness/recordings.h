#pragma once
#include <filesystem>
#include <vector>

#include "tests/robustness/damage.h"

namespace ossa::test {

/// All images of a SOURCE, their times and cameras; warned: a warning was given.
Reading ReadRecording(const std::filesystem::path& path);

/// Recordings whose images have no checksum: .mkv and, where their libraries are installed, bags of
/// ROS 1 and ROS 2, plain and compressed. A bit flipped in a depth gives another depth; damage
/// elsewhere must be detected.
std::vector<DamageSample> PlainRecordings();

/// Images of their kinds without a checksum over all: PGM, TIFF. PlainRecordings has them too.
std::vector<DamageSample> PlainImages();

}  // namespace ossa::test
