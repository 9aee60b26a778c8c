#include "tests/support/places.h"

namespace ossa::test {

std::filesystem::path SourceFolder() { return OSSA_SOURCE_DIR; }

std::filesystem::path BinaryFolder() { return OSSA_BINARY_DIR; }

std::filesystem::path SharedFolder() { return SourceFolder() / ".." / "shared"; }

}  // namespace ossa::test
