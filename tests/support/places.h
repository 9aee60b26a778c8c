#pragma once
#include <filesystem>

namespace ossa::test {

/// The checkout that this build was made from.
std::filesystem::path SourceFolder();
/// The build folder: bin/, lib/.
std::filesystem::path BinaryFolder();
/// Real recordings beside the checkout. May be absent: such tests skip visibly.
std::filesystem::path SharedFolder();

}  // namespace ossa::test
