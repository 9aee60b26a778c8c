// The frames that a recording's table states with their times.
#include <algorithm>
#include <optional>
#include <system_error>
#include <utility>

#include "depth/base/error.h"
#include "depth/image/depth_file.h"
#include "depth/sensor/depth_list.h"
#include "depth/sensor/folder_listing_internal.h"
#include "depth/sensor/stray_scanner.h"

namespace ossa::depth {
namespace {

namespace fs = std::filesystem;

// The images listed in a depth.txt.
struct FrameList {
  fs::path file;
  std::vector<ListedFrame> frames;
  std::string first;  // line and name of the first bad one
  std::vector<int> bad_lines;
  double unit_s = 1.0;  // unit of its times

  bool NamesAFile() const {
    std::error_code none;
    return std::any_of(frames.begin(), frames.end(),
                       [&](const auto& frame) { return fs::is_regular_file(frame.path, none); });
  }
};

fs::path FileOf(const fs::path& place, const DepthList::Entry& entry) {
  std::error_code none;
  const fs::path whole = (place / entry.rest).lexically_normal();
  const bool has_blanks = entry.rest != entry.file && fs::is_regular_file(whole, none);
  return has_blanks ? whole : (place / entry.file).lexically_normal();
}

// The frames of a list in `place`, of images anywhere or only of those in the folder `only`.
FrameList MakeFrameList(DepthList list, const fs::path& place,
                        const std::optional<fs::path>& only) {
  FrameList found{place / "depth.txt", {}, {}, std::move(list.bad_lines), list.unit_s};
  for (const DepthList::Entry& entry : list.entries) {
    const fs::path path = FileOf(place, entry);
    if (only && path.parent_path() != *only) continue;
    if (found.frames.empty()) {
      found.first = "line " + std::to_string(entry.line) + ": '" + entry.file + "'";
    }
    found.frames.push_back({path, static_cast<int64_t>(found.frames.size()), entry.time_s});
  }
  const double first_s = found.frames.empty() ? 0.0 : found.frames.front().time_s;
  for (ListedFrame& frame : found.frames) frame.time_s -= first_s;
  return found;
}

void NoteBadLines(const FrameList& list, const SourceOptions& options) {
  if (list.bad_lines.empty() || !options.note) return;
  options.note(NoteKind::kWarning, list.file.string() + ": line " +
                                       std::to_string(list.bad_lines.front()) +
                                       ": expected seconds and a file's name; lines ignored: " +
                                       std::to_string(list.bad_lines.size()));
}

// Frames by Stray Scanner's odometry.csv above the folder of so many images; none with a rate of
// the user's, which needs no times.
std::vector<ListedFrame> FramesOfScanner(const fs::path& folder, size_t images,
                                         const SourceOptions& options) {
  if (folder.filename() != "depth" || options.fps) return {};
  const fs::path recording = folder.parent_path();
  std::optional<DepthList> times = ReadScannerTimes(recording);
  if (!times) return {};
  auto frames = MakeFrameList(std::move(*times), recording, folder).frames;
  if (frames.size() < images && options.note) {
    options.note(NoteKind::kWarning,
                 (recording / "odometry.csv").string() + ": expected the times of " +
                     std::to_string(images) + " depth images, found " +
                     std::to_string(frames.size()) +
                     (frames.empty() ? ": 30 frames a second are assumed (--fps)"
                                     : ": the others are left out (--fps reads all)"));
  }
  return frames;
}

}  // namespace

void NoteUnit(const std::string& what, double unit_s, const SourceOptions& options) {
  if (unit_s == 1.0 || !options.note) return;
  const char* unit = unit_s == 1e-3   ? "milliseconds"
                     : unit_s == 1e-6 ? "microseconds"
                                      : "nanoseconds";
  options.note(NoteKind::kInfo, what + " are read as " + unit +
                                    ", because their steps are too long for seconds: --fps sets "
                                    "the rate");
}

std::vector<ListedFrame> FramesByList(const fs::path& folder, size_t images,
                                      const SourceOptions& options) {
  const fs::path here = fs::absolute(folder).lexically_normal();
  const fs::path plain = here.has_filename() ? here : here.parent_path();
  for (const bool above : {false, true}) {
    FrameList list =
        above ? MakeFrameList(ReadDepthList(plain.parent_path()), plain.parent_path(), plain)
              : MakeFrameList(ReadDepthList(folder), folder, std::nullopt);
    if (list.frames.empty()) continue;
    if (list.NamesAFile()) {
      NoteBadLines(list, options);
      NoteUnit(list.file.string() + ": its times", list.unit_s, options);
      return std::move(list.frames);
    }
    const std::string what =
        list.file.string() + ": expected seconds and files that are there, found " + list.first;
    if (images == 0) throw InputError(what);
    // With a list of images the frames lose their times.
    const bool has_times = IsDepthFileName(list.frames.front().path);
    if (options.note) {
      options.note(has_times ? NoteKind::kWarning : NoteKind::kInfo,
                   what + " and the like: ignored");
    }
  }
  return FramesOfScanner(plain, images, options);
}

}  // namespace ossa::depth
