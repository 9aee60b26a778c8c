#pragma once
#include <filesystem>

namespace ossa::recon {

/// Throws InputError, naming the byte, unless a .zip is complete: a central directory at its end,
/// and local headers that agree with it on name, method and checksum. Without a central directory
/// libarchive reads whatever members it finds, and it takes names from either.
void CheckZipTable(const std::filesystem::path& path);

}  // namespace ossa::recon
