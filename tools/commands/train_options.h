#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "forest/training/train.h"

namespace ossa::commands {

/// The parsed arguments of `ossa train`.
struct TrainArguments {
  std::vector<std::filesystem::path> datasets;
  std::vector<std::filesystem::path> validation;
  std::vector<std::filesystem::path> refinement;
  std::vector<std::filesystem::path> import_pcl;
  std::filesystem::path trees_of;
  std::filesystem::path out;
  std::string command;                // for the model's card
  std::optional<uint64_t> max_bytes;  // of the model's file
  std::vector<std::string> terms;
  size_t validation_images = 800;
  forest::RefinementOptions second_stage;
  bool quiet = false;
  forest::TrainOptions options;

  std::filesystem::path checkpoint() const { return out.string() + ".checkpoint"; }
};

/// Throws UsageError for invalid arguments, InputError if the model cannot be written.
TrainArguments ParseTrainOptions(int argc, char** argv);

}  // namespace ossa::commands
