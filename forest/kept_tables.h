#pragma once
#include <filesystem>
#include <optional>

#include "forest/forest.h"

namespace ossa::forest {

/// Whether ReadKeptTables may find some.
bool MayHaveKeptTables(const std::filesystem::path& model_file);

/// The model, to be run only, from tables that KeepTables left for it: a third of a model's start
/// is reading its file, the rest making its tables. Nothing where there are none for this very file
/// and this very build of the library, where they are damaged, or where the user wants none.
std::optional<ForestModel> ReadKeptTables(const std::filesystem::path& model_file);

/// Leaves the tables of a model that was read from `model_file` in $OSSA_CACHE (empty: none), else
/// $XDG_CACHE_HOME/ossa, else ~/.cache/ossa: some 100 MB of the shipped one; of others that are
/// there the newest stays. Of a model that defers its tables of leaves they are left as soon as all
/// are made, by the thread that makes them: of one that classifies a few images alone never. That
/// they cannot be written is no failure. Precondition: it classified nothing yet.
void KeepTables(const std::filesystem::path& model_file, const ForestModel& model);

}  // namespace ossa::forest
