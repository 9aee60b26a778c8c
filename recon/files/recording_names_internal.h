#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace ossa::recon {

/// Where a recording lies in a folder or an archive.
struct RecordingPlace {
  std::string file;    // in the folder; "" in an archive that is not in one
  std::string member;  // of the archive that the file is; "": the whole file
};

/// What no skeleton is in by its name: extensions that never hold one, and what lies beside
/// recordings in the data sets we know.
bool IsPassedOver(const std::filesystem::path& path);

/// Names of recordings: without extensions, unless these alone tell two files apart.
std::vector<std::string> ClipNames(const std::vector<std::string>& files);

/// The recordings that `name` asks for: those of that very name, with or without extensions; if
/// there is none, those in whose path it is one or more whole names; if there is none either, those
/// in whose path it occurs. All when it is empty.
std::vector<RecordingPlace> AskedFor(const std::vector<RecordingPlace>& places,
                                     const std::string& name);
/// The first of these alone.
std::vector<RecordingPlace> ExactlyNamed(const std::vector<RecordingPlace>& places,
                                         const std::string& name);

}  // namespace ossa::recon
