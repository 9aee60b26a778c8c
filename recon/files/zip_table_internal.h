#pragma once
#include <filesystem>

namespace ossa::recon {

/// Throws InputError, naming the byte, unless a .zip is whole: its table of members at its end, and
/// each member's own header saying the same of its name, its method and its checksum. Without a
/// table libarchive takes what members it finds, and of a name it takes either's.
void CheckZipTable(const std::filesystem::path& path);

}  // namespace ossa::recon
