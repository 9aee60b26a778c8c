#include "depth/sensor/folder_listing_internal.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <system_error>

#include "depth/base/error.h"
#include "depth/base/lower_case.h"
#include "depth/image/depth_file.h"
#include "depth/sensor/frame_names.h"
#include "depth/sensor/source_internal.h"

namespace ossa::depth {
namespace {

namespace fs = std::filesystem;

constexpr double kFramePeriod_s = 1.0 / 30.0;  // without any times: by convention the Kinect's rate

// The files of a folder, sorted by use.
struct Sorted {
  std::vector<fs::path> depth;      // in natural order
  std::vector<fs::path> duplicate;  // in other formats
  std::vector<fs::path> other;
};

// Whether a file is expected beside images and needs no note.
bool IsExpectedBeside(const fs::path& path) {
  constexpr std::array<std::string_view, 11> kKnown = {
      "camera.json",           "depth.txt",      "manifest.json",         "truth.jsonl",
      "extrinsics.json",       "intrinsic.json", "camera_intrinsic.json", "intrinsic_depth.txt",
      "camera-intrinsics.txt", "intrinsics.txt", "camera_intrinsics.txt"};
  return std::find(kKnown.begin(), kKnown.end(), path.filename().string()) != kKnown.end();
}

// Whether a name has one of the words, delimited by non-letters.
bool HasWord(std::string_view family, std::span<const std::string_view> words) {
  const auto is_letter = [](char c) { return c >= 'a' && c <= 'z'; };
  for (size_t from = 0; from < family.size();) {
    const size_t begin = static_cast<size_t>(
        std::find_if(family.begin() + static_cast<ptrdiff_t>(from), family.end(), is_letter) -
        family.begin());
    size_t end = begin;
    while (end < family.size() && is_letter(family[end])) ++end;
    const std::string_view word = family.substr(begin, end - begin);
    if (std::find(words.begin(), words.end(), word) != words.end()) return true;
    from = end + 1;
  }
  return false;
}

enum class Rank { kDepth, kUnnamed, kNamedOther };

// The kind of image by its name: depth*.png is preferred over ir*.png beside it.
Rank RankByName(const fs::path& image) {
  constexpr std::array<std::string_view, 16> kOthers = {
      "ir",  "infrared", "color", "colour", "rgb",   "amp",   "amplitude", "intensity",
      "cnf", "mask",     "label", "labels", "index", "users", "conf",      "confidence"};
  const std::string family = StripNumbers(image.stem().string());
  if (family.find("depth") != std::string::npos) return Rank::kDepth;
  return HasWord(family, kOthers) ? Rank::kNamedOther : Rank::kUnnamed;
}

// Of images in several formats, which show the same, those in the commonest; of two as common PNGs,
// else those of the first name.
void KeepOneFormat(Sorted& sorted) {
  std::map<std::string, size_t> count;
  for (const fs::path& path : sorted.depth) ++count[LowerCaseExtension(path)];
  if (count.size() < 2) return;
  const auto commonest =
      std::max_element(count.begin(), count.end(), [](const auto& a, const auto& b) {
        return std::pair(a.second, a.first == ".png") < std::pair(b.second, b.first == ".png");
      });
  const auto others = std::stable_partition(
      sorted.depth.begin(), sorted.depth.end(),
      [&](const fs::path& path) { return LowerCaseExtension(path) == commonest->first; });
  std::move(others, sorted.depth.end(), std::back_inserter(sorted.duplicate));
  sorted.depth.erase(others, sorted.depth.end());
}

Sorted SortOut(const fs::path& folder) {
  Sorted sorted;
  std::map<Rank, std::vector<fs::path>> ranked;
  for (fs::path& path : FilesIn(folder)) {
    if (!IsDepthFileName(path) || IsOtherImage(path)) {
      if (!IsExpectedBeside(path)) sorted.other.push_back(std::move(path));
    } else {
      ranked[RankByName(path)].push_back(std::move(path));
    }
  }
  for (auto& [rank, paths] : ranked) {
    auto& to = sorted.depth.empty() ? sorted.depth : sorted.other;
    std::move(paths.begin(), paths.end(), std::back_inserter(to));
  }
  KeepOneFormat(sorted);
  return sorted;
}

void NoteIgnored(const fs::path& folder, const std::vector<fs::path>& others,
                 const SourceOptions& options) {
  constexpr size_t kNamed = 3;  // by hand: fits a line
  if (others.empty() || !options.note) return;
  std::string text = folder.string() + ": " + std::to_string(others.size()) +
                     (others.size() == 1 ? " file is not a depth image and is ignored: "
                                         : " files are not depth images and are ignored: ");
  for (size_t i = 0; i < std::min(others.size(), kNamed); ++i) {
    text += (i > 0 ? ", " : "") + others[i].filename().string();
  }
  options.note(NoteKind::kInfo, text + (others.size() > kNamed ? ", ..." : ""));
}

void NoteDuplicates(const fs::path& folder, const Sorted& sorted, const SourceOptions& options) {
  if (sorted.duplicate.empty() || !options.note) return;
  options.note(NoteKind::kInfo,
               folder.string() + ": images in another format are ignored, such as " +
                   sorted.duplicate.front().filename().string() + ", because there are more like " +
                   sorted.depth.front().filename().string() + " or as many");
}

// Notes if there seem to be two images per frame, such as depth_1.png and depth_filled_1.png. Names
// that all differ do not show it.
void NoteKinds(const fs::path& folder, const std::vector<fs::path>& depth,
               const SourceOptions& options) {
  std::map<std::string, int> count;
  for (const fs::path& path : depth) ++count[StripNumbers(path.stem().string())];
  const bool is_any_alone =
      std::any_of(count.begin(), count.end(), [](const auto& kind) { return kind.second == 1; });
  if (count.size() < 2 || is_any_alone || !options.note) return;
  std::string kinds;
  for (const auto& [kind, files] : count) kinds += (kinds.empty() ? "'" : ", '") + kind + "'";
  options.note(NoteKind::kInfo, folder.string() + ": depth images of " +
                                    std::to_string(count.size()) + " kinds by their names (" +
                                    kinds + ") are read as one sequence");
}

// The most frequent size: a single frame of another size, or a broken first one, must not decide.
ImageSize CommonSize(const std::vector<ListedFrame>& frames) {
  std::vector<std::pair<ImageSize, int>> counts;
  for (const ListedFrame& frame : frames) {
    ImageSize size;
    try {
      size = ReadDepthFileSize(frame.path);
    } catch (const InputError&) {
      continue;  // reported when it is read
    }
    const auto same = [&](const auto& count) { return count.first == size; };
    auto found = std::find_if(counts.begin(), counts.end(), same);
    if (found == counts.end()) found = counts.insert(counts.end(), {size, 0});
    ++found->second;
  }
  if (counts.empty()) return ReadDepthFileSize(frames.front().path);  // throws with the reason
  return std::max_element(counts.begin(), counts.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

void PutInOrderOfTime(std::vector<ListedFrame>& frames) {
  std::stable_sort(frames.begin(), frames.end(),
                   [](const auto& a, const auto& b) { return a.time_s < b.time_s; });
  for (size_t i = 0; i < frames.size(); ++i) frames[i].number = static_cast<int64_t>(i);
}

std::vector<ListedFrame> FramesByName(const fs::path& folder, const std::vector<fs::path>& paths,
                                      const SourceOptions& options) {
  std::vector<std::string> stems;
  for (const fs::path& path : paths) stems.push_back(path.stem().string());
  const NamedTimes times = ReadTimesFromNames(stems);
  NoteUnit(folder.string() + ": the numbers in its names", times.unit_s, options);
  const bool are_times = times.kind == NamedTimes::Kind::kTimes;
  std::vector<ListedFrame> frames;
  for (size_t i = 0; i < paths.size(); ++i) {
    ListedFrame frame{paths[i], static_cast<int64_t>(i), 0.0};
    if (times.kind == NamedTimes::Kind::kNumbers) frame.number = times.numbers[i];
    const int64_t first = frames.empty() ? frame.number : frames.front().number;
    frame.time_s =
        are_times ? times.times_s[i] : static_cast<double>(frame.number - first) * kFramePeriod_s;
    frames.push_back(std::move(frame));
  }
  if (are_times) PutInOrderOfTime(frames);
  return frames;
}

bool HasDepthImage(const fs::path& folder) {
  try {
    const std::vector<fs::path> files = FilesIn(folder);
    const auto image = std::find_if(files.begin(), files.end(), IsDepthFileName);
    if (image == files.end()) return false;
    ReadDepthFileSize(*image);
    return true;
  } catch (const InputError&) {  // another kind of image, or an unreadable folder
    return false;
  }
}

// The sub-folder of depth images that recorders create beside the colour one; "" if there is none.
std::string NameFolderOfDepthIn(const fs::path& folder) {
  std::vector<fs::path> folders;
  std::error_code error, unknown;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (it->is_directory(unknown) && HasDepthImage(it->path())) folders.push_back(it->path());
  }
  std::sort(folders.begin(), folders.end());
  const auto by_name = std::find_if(folders.begin(), folders.end(), [](const fs::path& path) {
    return RankByName(path) == Rank::kDepth;
  });
  if (folders.empty()) return "";
  return (by_name == folders.end() ? folders.front() : *by_name).string();
}

[[noreturn]] void FailEmpty(const fs::path& folder, const Sorted& sorted) {
  const auto image = std::find_if(sorted.other.begin(), sorted.other.end(), IsDepthFileName);
  if (image != sorted.other.end()) ReadDepthFileSize(*image);  // throws with the reason
  if (fs::is_directory(folder / "shards")) {
    throw InputError(
        folder.string() +
        ": expected a folder of 16-bit PNGs, found a packed data set, whose images are "
        "cut out around people: `ossa render --format png` or both keeps them whole");
  }
  for (const fs::path& path : sorted.other) {
    if (const char* how = DescribeConversion(path)) {
      throw InputError(path.string() + ": expected depth images, such as 16-bit PNGs, found " +
                       how);
    }
  }
  const std::string below = NameFolderOfDepthIn(folder);
  throw InputError(folder.string() +
                   ": expected a folder of depth images, such as 16-bit PNGs, found none in it" +
                   (below.empty() ? "" : ", but in " + below));
}

}  // namespace

std::vector<fs::path> FilesIn(const fs::path& folder) {
  std::vector<fs::path> paths;
  std::error_code error, unknown;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (!it->is_directory(unknown)) paths.push_back(it->path());
  }
  if (error) throw InputError(folder.string() + ": cannot be read: " + error.message());
  std::sort(paths.begin(), paths.end(), [](const fs::path& a, const fs::path& b) {
    return NaturalLess(a.filename().string(), b.filename().string());
  });
  return paths;
}

FolderListing ListDepthFolder(const fs::path& folder, const SourceOptions& options) {
  Sorted sorted = SortOut(folder);
  FolderListing listing;
  listing.frames = FramesByList(folder, sorted.depth.size(), options);
  if (!listing.frames.empty()) {
    std::set<fs::path> listed;
    for (const ListedFrame& frame : listing.frames) {
      listed.insert(fs::absolute(frame.path).lexically_normal());
    }
    for (const fs::path& path : sorted.depth) {
      if (!listed.contains(fs::absolute(path).lexically_normal())) sorted.other.push_back(path);
    }
  } else if (sorted.depth.empty()) {
    FailEmpty(folder, sorted);
  } else {
    NoteKinds(folder, sorted.depth, options);
    listing.frames = FramesByName(folder, sorted.depth, options);
  }
  NoteDuplicates(folder, sorted, options);
  NoteIgnored(folder, sorted.other, options);
  listing.size = CommonSize(listing.frames);
  return listing;
}

}  // namespace ossa::depth
