#pragma once
#include <filesystem>
#include <optional>

#include "forest/forest.h"

namespace ossa::forest {

/// Whether ReadKeptTables might find cached tables.
bool MayHaveKeptTables(const std::filesystem::path& model_file);

/// Loads a run-only model from tables cached by KeepTables: reading the model file is a third of
/// start-up, building its tables the rest. None if there is no cache for this file and this build
/// of the library, if it is damaged, or if the user disabled caching.
std::optional<ForestModel> ReadKeptTables(const std::filesystem::path& model_file);

/// Caches the tables of a model read from `model_file` in $OSSA_CACHE (empty: off), else
/// $XDG_CACHE_HOME/ossa, else ~/.cache/ossa: some 100 MB for the shipped one; of other caches the
/// newest is kept. If leaf tables are deferred, the cache is written by the thread that completes
/// them; if only a few images are classified, never. Failure to write is ignored. Precondition:
/// nothing has been classified yet.
void KeepTables(const std::filesystem::path& model_file, const ForestModel& model);

}  // namespace ossa::forest
