#pragma once
#include <filesystem>
#include <map>
#include <string>

namespace ossa::recon {

/// A path with what was said after '#': `s01.tar.gz#truth`, `raw.tar.gz#m01_s01_e05`.
struct SkeletonPath {
  std::filesystem::path path;
  std::string columns;  // "truth", "observed" or ""
  std::string member;   // a name, or part of one, inside the folder or archive, or ""
};
/// Taken apart behind the longest part before a '#' that exists; a path of which none does is left
/// whole.
SkeletonPath TakeApart(const std::filesystem::path& path);

/// "truth" for truth, vicon, ...; "observed" for kinect, estimate, ...; "" for none of them.
std::string ColumnsNamed(const std::string& word);

/// True for .tar, .tar.gz, .tgz, .zip by content (a plain .gz is no archive).
bool IsArchive(const std::filesystem::path& path);

/// All members of an archive, or the one content of a .gz, by name. Bounded: 1 GiB in all, so that
/// a small file that unfolds without end is refused. Throws InputError for a damaged one.
std::map<std::string, std::string> ReadArchive(const std::filesystem::path& path);

/// True when the file begins with the gzip magic.
bool IsGzip(const std::filesystem::path& path);

/// The whole content of a .gz that holds one file.
std::string ReadGzip(const std::filesystem::path& path);

}  // namespace ossa::recon
