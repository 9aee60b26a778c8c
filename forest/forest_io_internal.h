#pragma once
#include <cstddef>
#include <span>
#include <string>

#include "forest/forest.h"

namespace ossa::forest {

/// A model out of a file's payload, unsealed and unpacked. Throws InputError.
ForestModel ParseForest(std::span<const std::byte> payload, const std::string& name);

}  // namespace ossa::forest
