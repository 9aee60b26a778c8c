#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "forest/train/grow_internal.h"

namespace ossa::forest {

/// Where a training run stands: trees grown, and the one being grown.
struct Checkpoint {
  std::string fingerprint;  // of data and options: another run's checkpoint is refused
  std::vector<std::vector<Node>> finished;
  GrowingTree growing;
};

void WriteCheckpoint(const std::filesystem::path& path, const Checkpoint& checkpoint);
/// Throws InputError when damaged or of another run.
Checkpoint ReadCheckpoint(const std::filesystem::path& path, const std::string& fingerprint);

}  // namespace ossa::forest
