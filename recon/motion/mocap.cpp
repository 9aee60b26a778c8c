#include "recon/motion/mocap.h"

#include <algorithm>
#include <filesystem>
#include <optional>

#include "depth/error.h"
#include "recon/motion/authored.h"
#include "recon/motion/bone_names_internal.h"
#include "recon/motion/bvh.h"
#include "recon/motion/bvh_source_internal.h"
#include "recon/motion/retarget_internal.h"
#include "recon/motion/text_scanner_internal.h"

namespace ossa::recon {
namespace {

namespace fs = std::filesystem;

/// CMU and HDM05 file names begin with the performer: "05_03" is subject 5, "HDM_bk_01" is bk.
std::string SubjectOf(const std::string& stem) {
  const size_t first = stem.find('_');
  if (first == std::string::npos) return "";
  if (stem.starts_with("HDM_")) return stem.substr(4, stem.find('_', 4) - 4);
  return stem.substr(0, first);
}

std::vector<fs::path> MotionFilesIn(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (auto it = fs::recursive_directory_iterator(folder, error);
       !error && it != fs::recursive_directory_iterator(); it.increment(error)) {
    if (it->is_regular_file(error) && Lower(it->path().extension().string()) == ".bvh") {
      files.push_back(it->path());
    }
  }
  if (error) throw InputError(folder.string() + ": cannot be listed: " + error.message());
  std::sort(files.begin(), files.end());
  return files;
}

MotionClip LoadFile(const fs::path& path, const std::optional<BoneMapping>& mapping,
                    double frame_s) {
  const SourceMotion motion = SourceOf(ReadBvh(path), path.string());
  MotionClip clip = Retarget(motion, FindBones(motion, mapping), frame_s);
  clip.name = path.stem().string();
  clip.subject = SubjectOf(clip.name);
  return clip;
}

}  // namespace

std::vector<MotionClip> LoadMocap(const std::vector<std::string>& sources,
                                  const MocapOptions& options) {
  std::optional<BoneMapping> mapping;
  if (!options.mapping_file.empty()) mapping = ReadBoneMapping(options.mapping_file);
  std::vector<MotionClip> clips;
  for (const std::string& source : sources) {
    if (source == "authored") {
      AuthoredOptions authored;
      authored.seed = options.seed;
      authored.frame_s = options.frame_s;
      for (MotionClip& clip : AuthoredClips(authored)) clips.push_back(std::move(clip));
      continue;
    }
    if (!fs::exists(source)) {
      throw InputError(source + ": no such folder or file; expected mocap or the word 'authored'");
    }
    const auto files =
        fs::is_directory(source) ? MotionFilesIn(source) : std::vector<fs::path>{source};
    if (files.empty()) throw InputError(source + ": expected .bvh files in the folder, found none");
    for (const fs::path& file : files) clips.push_back(LoadFile(file, mapping, options.frame_s));
  }
  std::stable_sort(clips.begin(), clips.end(),
                   [](const MotionClip& a, const MotionClip& b) { return a.name < b.name; });
  return clips;
}

}  // namespace ossa::recon
