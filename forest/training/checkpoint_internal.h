#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "forest/training/grow_internal.h"

namespace ossa::forest {

/// Something that decides the bytes of the model, by the name that a user knows it by: an option
/// of `ossa train` without its dashes, or the data.
struct Setting {
  std::string name;
  std::string value;
};

/// Where a training run stands: trees grown, and the one being grown.
struct Checkpoint {
  std::vector<Setting> settings;  // a run of others is refused
  std::vector<std::vector<Node>> finished;
  GrowingTree growing;
};

void WriteCheckpoint(const std::filesystem::path& path, const Checkpoint& checkpoint);
/// Throws InputError when damaged, or of a run with other settings than these: it names the first
/// that differs and both values.
Checkpoint ReadCheckpoint(const std::filesystem::path& path, const std::vector<Setting>& settings);

}  // namespace ossa::forest
