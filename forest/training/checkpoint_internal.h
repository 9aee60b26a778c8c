#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "forest/training/grow_internal.h"

namespace ossa::forest {

/// A setting that affects the bytes of the model, under its user-visible name: an option of `ossa
/// train` without dashes, or the data.
struct Setting {
  std::string name;
  std::string value;
};

/// Progress of a training run: finished trees and the current one.
struct Checkpoint {
  std::vector<Setting> settings;  // runs with other settings are refused
  std::vector<std::vector<Node>> finished;
  GrowingTree growing;
};

void WriteCheckpoint(const std::filesystem::path& path, const Checkpoint& checkpoint);
/// Throws InputError if damaged, or from a run with other settings: it names the first difference
/// and both values.
Checkpoint ReadCheckpoint(const std::filesystem::path& path, const std::vector<Setting>& settings);

}  // namespace ossa::forest
