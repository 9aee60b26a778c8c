#pragma once
#include <filesystem>
#include <map>
#include <string>

namespace ossa::recon {

/// True for .tar, .tar.gz, .tgz, .zip by content (a plain .gz is no archive).
bool IsArchive(const std::filesystem::path& path);

/// All members of an archive by name. Limited to 1 GiB and 100 000 members in total, so that
/// decompression bombs are refused. Throws InputError for a damaged archive: checksums (.gz,
/// .tar.gz, .zip), the two headers of each zip member, and the end of a tar are verified.
std::map<std::string, std::string> ReadArchive(const std::filesystem::path& path);

/// True when the file begins with the gzip magic.
bool IsGzip(const std::filesystem::path& path);

/// The whole content of a .gz that holds one file; limited and verified as above.
std::string ReadGzip(const std::filesystem::path& path);

}  // namespace ossa::recon
