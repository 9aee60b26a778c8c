#pragma once
#include <filesystem>
#include <optional>

#include "forest/forest.h"

namespace ossa::forest {

/// The model, to be run only, from tables that KeepTables left for it: a third of a model's start
/// is reading its file, the rest making its tables. Nothing where there are none for this very file
/// and this very build of the library, where they are damaged, or where the user wants none.
std::optional<ForestModel> ReadKeptTables(const std::filesystem::path& model_file);

/// Leaves the tables of a model that was read from `model_file` in $OSSA_CACHE (empty: none), else
/// $XDG_CACHE_HOME/ossa, else ~/.cache/ossa: some 120 MB of the shipped one; of others that are
/// there the newest stays. That they cannot be written is no failure.
void KeepTables(const std::filesystem::path& model_file, const ForestModel& model);

}  // namespace ossa::forest
