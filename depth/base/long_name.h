#pragma once
#include <cstddef>
#include <filesystem>
#include <string>

namespace ossa {

/// A name cut to so many bytes, between two characters of UTF-8, with a digest of all of it, so
/// that others that begin alike are told apart, and its extension, by which it is known what it
/// holds.
std::string ShortenName(const std::string& name, size_t bytes);

/// Bytes of the longest name that the folder's file system takes; 0: unknown.
size_t LongestNameIn(const std::filesystem::path& folder);

}  // namespace ossa
