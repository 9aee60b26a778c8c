#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace ossa::recon {

/// Where a recording lies in a folder or an archive.
struct RecordingPlace {
  std::string file;    // within the folder; "" if the archive is not in a folder
  std::string member;  // member of the archive `file`; "": the whole file
};

/// Whether a file cannot hold skeletons by its name: unrelated extensions, and auxiliary files of
/// known data sets.
bool IsIgnoredFile(const std::filesystem::path& path);

/// Names of recordings: without extensions, unless two files would get the same name.
std::vector<std::string> ClipNames(const std::vector<std::string>& files);

/// The recordings selected by `name`: those of exactly that name, with or without extension; else
/// those that have it as one or more complete path components; else those whose path contains it.
/// All if it is empty.
std::vector<RecordingPlace> SelectRecordings(const std::vector<RecordingPlace>& places,
                                             const std::string& name);
/// Only the exact matches.
std::vector<RecordingPlace> SelectExactNames(const std::vector<RecordingPlace>& places,
                                             const std::string& name);

}  // namespace ossa::recon
