#include <algorithm>
#include <map>
#include <set>
#include <string_view>

#include "depth/base/lower_case.h"
#include "recon/files/recording_names_internal.h"
#include "recon/files/skeleton_formats_internal.h"

namespace ossa::recon {
namespace {

std::string WithoutExtension(std::string name) {
  const size_t slash = name.rfind('/');
  for (const char* extension : {".gz", ".tar", ".tgz", ".zip"}) {
    if (HasEnding(name, extension)) name.resize(name.size() - std::string_view(extension).size());
  }
  const size_t dot = name.rfind('.');
  if (dot != std::string::npos && (slash == std::string::npos || dot > slash)) name.resize(dot);
  return name;
}

// The names of a recording, with and without extensions.
std::vector<std::string> ListNames(const RecordingPlace& place) {
  const auto& [file, member] = place;
  if (file.empty()) return {member, WithoutExtension(member)};
  if (member.empty()) return {file, WithoutExtension(file)};
  std::vector<std::string> names;
  for (const std::string& archive : {file, WithoutExtension(file)}) {
    names.push_back(archive + "/" + member);
    names.push_back(archive + "/" + WithoutExtension(member));
  }
  return names;
}

using Match = bool (*)(const std::string& name, const std::string& asked);

bool IsIt(const std::string& name, const std::string& asked) { return name == asked; }

bool HasItWhole(const std::string& name, const std::string& asked) {
  return ("/" + name + "/").find("/" + asked + "/") != std::string::npos;
}

bool HasIt(const std::string& name, const std::string& asked) {
  return name.find(asked) != std::string::npos;
}

std::vector<RecordingPlace> Matching(const std::vector<RecordingPlace>& places,
                                     const std::string& asked, Match matches) {
  std::vector<RecordingPlace> found;
  for (const RecordingPlace& place : places) {
    const auto names = ListNames(place);
    const bool any = std::any_of(names.begin(), names.end(),
                                 [&](const std::string& name) { return matches(name, asked); });
    if (any) found.push_back(place);
  }
  return found;
}

}  // namespace

bool IsIgnoredFile(const std::filesystem::path& path) {
  static const std::set<std::string> kOther = {
      ".md",   ".html", ".pdf", ".docx", ".pptx", ".py",  ".ipynb", ".m",
      ".sh",   ".bat",  ".yml", ".yaml", ".toml", ".png", ".jpg",   ".jpeg",
      ".bmp",  ".gif",  ".tif", ".tiff", ".mp4",  ".avi", ".mov",   ".mkv",
      ".webm", ".wav",  ".mp3", ".bag",  ".oni",  ".log",  // and of file managers:
      ".db",   ".ini",  ".lnk", ".url"};
  const std::string name = path.filename().string();
  for (const char* word : {"README", "LICENSE", "ORIGINAL_", "INDEX.", "PROVENANCE", "manifest.",
                           "camera.json", "SHA256"}) {
    if (name.starts_with(word)) return true;
  }
  return name.starts_with('.') || kOther.contains(LowerCaseExtension(path)) ||
         name == kSaverTimes || HoldsAngles(name);
}

std::vector<std::string> ClipNames(const std::vector<std::string>& files) {
  std::map<std::string, int> count;
  for (const std::string& file : files) ++count[WithoutExtension(file)];
  std::vector<std::string> names;
  for (const std::string& file : files) {
    const std::string name = WithoutExtension(file);
    names.push_back(count[name] > 1 ? file : name);
  }
  return names;
}

std::vector<RecordingPlace> SelectRecordings(const std::vector<RecordingPlace>& places,
                                             const std::string& name) {
  if (name.empty()) return places;
  for (const Match matches : {IsIt, HasItWhole, HasIt}) {
    auto found = Matching(places, name, matches);
    if (!found.empty()) return found;
  }
  return {};
}

std::vector<RecordingPlace> SelectExactNames(const std::vector<RecordingPlace>& places,
                                             const std::string& name) {
  return Matching(places, name, IsIt);
}

}  // namespace ossa::recon
