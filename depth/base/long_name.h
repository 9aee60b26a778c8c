#pragma once
#include <cstddef>
#include <filesystem>
#include <string>

namespace ossa {

/// Shortens a name to `bytes` bytes, at a UTF-8 boundary, with a digest of the full name, so that
/// names with a common beginning differ, and its extension, which states the format.
std::string ShortenName(const std::string& name, size_t bytes);

/// Longest file name of the folder's file system, bytes; 0: unknown.
size_t LongestNameIn(const std::filesystem::path& folder);

}  // namespace ossa
