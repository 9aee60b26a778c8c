#include "recon/motion/mocap.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>

#include "depth/base/error.h"
#include "depth/base/lower_case.h"
#include "depth/base/naming_the_file.h"
#include "recon/motion/acclaim_internal.h"
#include "recon/motion/authored.h"
#include "recon/motion/authored_floor.h"
#include "recon/motion/bone_names_internal.h"
#include "recon/motion/bvh.h"
#include "recon/motion/bvh_source_internal.h"
#include "recon/motion/humanoid3d_internal.h"
#include "recon/motion/retarget_internal.h"
#include "recon/motion/text_scanner_internal.h"

namespace ossa::recon {
namespace {

namespace fs = std::filesystem;

/// CMU and HDM05 file names start with the performer: "05_03" is subject 5, "HDM_bk_01" is bk.
std::string ParseSubject(const std::string& stem) {
  const size_t first = stem.find('_');
  if (first == std::string::npos) return "";
  if (stem.starts_with("HDM_")) return stem.substr(4, stem.find('_', 4) - 4);
  return stem.starts_with("humanoid3d_") ? "humanoid3d" : stem.substr(0, first);
}

enum class Kind { kOther, kBvh, kAmc, kHumanoid3d };

Kind DetectKind(const fs::path& path) {
  const std::string extension = LowerCase(path.extension().string());
  if (extension == ".bvh") return Kind::kBvh;
  if (extension == ".amc") return Kind::kAmc;
  const bool humanoid = LowerCase(path.filename().string()).starts_with("humanoid3d_");
  return humanoid && (extension == ".txt" || extension == ".json") ? Kind::kHumanoid3d
                                                                   : Kind::kOther;
}

/// Hidden files of the operating system ("._walk.bvh").
bool IsHidden(const fs::path& path) { return path.filename().string().starts_with('.'); }

std::vector<fs::path> MotionFilesIn(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (auto it = fs::recursive_directory_iterator(folder, error);
       !error && it != fs::recursive_directory_iterator(); it.increment(error)) {
    if (it->is_regular_file(error) && DetectKind(it->path()) != Kind::kOther &&
        !IsHidden(it->path())) {
      files.push_back(it->path());
    }
  }
  if (error) throw InputError(folder.string() + ": cannot be listed: " + error.message());
  if (files.empty()) {
    throw InputError(folder.string() +
                     ": expected .bvh, .amc or humanoid3d_*.txt files in the folder, found none");
  }
  std::sort(files.begin(), files.end());
  return files;
}

constexpr double kUsualAmc_hz = 120.0;  // by convention: CMU's and HDM05's

/// Loads files one after another and caches each ASF.
class Loader {
 public:
  explicit Loader(const MocapOptions& options) : options_(options) {
    if (!options.mapping_file.empty()) mapping_ = ReadBoneMapping(options.mapping_file);
  }

  /// The clips of a file: one per root of a BVH.
  std::vector<MotionClip> Load(const fs::path& path) {
    const std::string name = path.string();
    switch (DetectKind(path)) {
      case Kind::kBvh:
        return LoadBvh(path);
      case Kind::kAmc:
        return {WarnOfRate(MakeClip(FindPerson(LoadAmc(path), mapping()), path), name)};
      case Kind::kHumanoid3d:  // has a fixed set of joints
        return {MakeClip(FindPerson(ParseHumanoid3d(ReadTextFile(path), name), nullptr), path)};
      case Kind::kOther:
        break;
    }
    throw InputError(name + ": expected a .bvh, .amc or humanoid3d_*.txt file");
  }

  /// Options that no file used, a warning each.
  std::vector<std::string> DescribeUnused() const {
    std::vector<std::string> unused;
    if (mapping_ && !is_mapping_used_) {
      unused.push_back(mapping_->file + ": is not used: no file has a joint of a name in it");
    }
    if (options_.amc_hz > 0.0 && skeletons_.empty()) {
      unused.push_back("--amc-fps is not used: no file is an AMC file");
    }
    return unused;
  }

 private:
  struct Person {
    SourceMotion motion;
    SourceBones bones;
  };

  const BoneMapping* mapping() const { return mapping_ ? &*mapping_ : nullptr; }

  Person FindPerson(SourceMotion motion, const BoneMapping* mapping) {
    is_mapping_used_ = is_mapping_used_ || (mapping != nullptr && NamesAny(*mapping, motion));
    SourceBones bones = FindBones(motion, mapping);
    return {std::move(motion), std::move(bones)};
  }

  std::vector<MotionClip> LoadBvh(const fs::path& path) {
    BvhFile bvh = ReadBvh(path);
    std::vector<std::string> warnings = bvh.warnings;
    std::vector<Person> people;
    ForEachPerson(std::move(bvh), path.string(), warnings, [&](BvhFile root) {
      people.push_back(FindPerson(ToSourceMotion(std::move(root), path.string()), mapping()));
    });
    std::vector<MotionClip> clips;
    for (const Person& person : people) {
      MotionClip clip = MakeClip(person, path);
      if (!clips.empty()) clip.name.append("_").append(std::to_string(clips.size() + 1));
      clips.push_back(std::move(clip));
    }
    auto& all = clips.front().warnings;
    all.insert(all.begin(), warnings.begin(), warnings.end());
    return clips;
  }

  MotionClip MakeClip(const Person& person, const fs::path& path) const {
    MotionClip clip = Retarget(person.motion, person.bones, options_.frame_s);
    clip.name = path.stem().string();
    clip.subject = ParseSubject(clip.name);
    return clip;
  }

  MotionClip WarnOfRate(MotionClip clip, const std::string& file) {
    if (options_.amc_hz > 0.0 || is_rate_told_) return clip;
    is_rate_told_ = true;
    clip.warnings.push_back(
        file +
        ": AMC files state no rate: read at 120 frames a second (--amc-fps sets another rate)");
    return clip;
  }

  SourceMotion LoadAmc(const fs::path& path) {
    const double hz = options_.amc_hz > 0.0 ? options_.amc_hz : kUsualAmc_hz;
    return ParseAmc(ReadTextFile(path), path.string(), LoadSkeleton(path), 1.0 / hz);
  }

  std::shared_ptr<const AcclaimSkeleton> LoadSkeleton(const fs::path& amc) {
    const std::string asf = AsfBeside(amc).string();
    auto& skeleton = skeletons_[asf];
    if (!skeleton) {
      skeleton = std::make_shared<const AcclaimSkeleton>(ParseAsf(ReadTextFile(asf), asf));
    }
    return skeleton;
  }

  const MocapOptions& options_;
  std::optional<BoneMapping> mapping_;
  bool is_mapping_used_ = false;
  bool is_rate_told_ = false;  // warn once for all files
  std::map<std::string, std::shared_ptr<const AcclaimSkeleton>> skeletons_;
};

}  // namespace

std::vector<MotionClip> LoadMocap(const std::vector<std::string>& sources,
                                  const MocapOptions& options) {
  Loader loader(options);
  std::vector<MotionClip> clips;
  for (const std::string& source : sources) {
    if (source == "authored" || source == "authored-floor") {
      AuthoredOptions authored;
      authored.seed = options.seed;
      authored.frame_s = options.frame_s;
      auto own = source == "authored" ? AuthoredClips(authored) : AuthoredFloorClips(authored);
      for (MotionClip& clip : own) clips.push_back(std::move(clip));
      continue;
    }
    if (!fs::exists(source)) {
      throw InputError(source + ": no such folder or file; expected mocap or the word 'authored'");
    }
    const auto files =
        fs::is_directory(source) ? MotionFilesIn(source) : std::vector<fs::path>{source};
    for (const fs::path& file : files) {
      if (options.stop && options.stop()) break;
      auto people = NamingTheFile(file, [&] { return loader.Load(file); });
      for (MotionClip& clip : people) clips.push_back(std::move(clip));
    }
  }
  for (std::string& unused : loader.DescribeUnused()) {
    if (!clips.empty()) clips.front().warnings.push_back(std::move(unused));
  }
  std::stable_sort(clips.begin(), clips.end(),
                   [](const MotionClip& a, const MotionClip& b) { return a.name < b.name; });
  return clips;
}

}  // namespace ossa::recon
