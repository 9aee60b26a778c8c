#pragma once
#include <filesystem>
#include <string>

namespace ossa::recon {

/// A path and its selectors after '#': `s01.tar.gz#truth`, `raw.tar.gz#m01_s01_e05`.
struct SkeletonPath {
  std::filesystem::path path;
  std::string columns;  // "truth", "observed" or ""
  std::string member;   // full or partial name inside the folder or archive, or ""
};
/// Splits at the last '#' before which the path exists; a path that never exists is not split.
SkeletonPath TakeApart(const std::filesystem::path& path);

/// "truth" for truth, vicon, ...; "observed" for kinect, estimate, ...; "" for none of them.
std::string ParseColumns(const std::string& word);

}  // namespace ossa::recon
