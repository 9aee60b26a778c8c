#pragma once
#include <filesystem>
#include <map>
#include <string>

namespace ossa::recon {

/// True for .tar, .tar.gz, .tgz, .zip by content (a plain .gz is no archive).
bool IsArchive(const std::filesystem::path& path);

/// All members of an archive by name. Bounded: 1 GiB and 100 000 members in all, so that a small
/// file that unfolds without end is refused. Throws InputError for a damaged one: what carries a
/// checksum (.gz, .tar.gz, .zip) has it verified, and so have a zip's two headers of each member
/// and a tar's end.
std::map<std::string, std::string> ReadArchive(const std::filesystem::path& path);

/// True when the file begins with the gzip magic.
bool IsGzip(const std::filesystem::path& path);

/// The whole content of a .gz that holds one file. Bounded and verified as above.
std::string ReadGzip(const std::filesystem::path& path);

}  // namespace ossa::recon
