#pragma once
#include <filesystem>
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

}  // namespace ossa::recon
