#pragma once
#include <filesystem>
#include <vector>

#include "tests/robustness/damage.h"

namespace ossa::test {

/// All images of a SOURCE, their times and cameras; warned: a warning was given.
Reading ReadRecording(const std::filesystem::path& path);

/// Recordings whose images nothing vouches for: .mkv and, where rosbag is there, .bag plain and
/// compressed. A bit flipped in a depth is another depth; the rest of the file must hold.
std::vector<DamageSample> PlainRecordings();

}  // namespace ossa::test
