#pragma once
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

#include "depth/image/depth_frame.h"

namespace ossa::test {

/// The result of reading a file: all that was read, as bytes, and whether a warning said that
/// something is missing.
struct Reading {
  std::string content;
  bool warned = false;
};

/// Appends all fields of a frame.
void AppendFrame(const depth::DepthFrame& frame, std::string* content);

/// A whole file and how it is read.
struct DamageSample {
  std::string name;  // of the file: readers go by its extension
  std::string bytes;
  std::function<Reading(const std::filesystem::path&)> read;  // throws InputError
};

/// The outcomes of the damaged copies of a sample.
struct DamageOutcomes {
  size_t tried = 0;
  size_t refused = 0;  // by an InputError
  size_t same = 0;     // read as the undamaged one: the damaged bytes carry no content
  size_t warned = 0;   // less was read, with a note
  size_t silent = 0;   // something else was read as if it were right
  std::string first_silent;
};

/// Copies cut short to 0, `step`, 2 `step`, ... bytes.
DamageOutcomes CutShort(const DamageSample& sample, size_t step);
/// Copies of which the bits 0, `step`, 2 `step`, ... are flipped, one each.
DamageOutcomes FlipBits(const DamageSample& sample, size_t step);

}  // namespace ossa::test
