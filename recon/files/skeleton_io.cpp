#include "recon/files/skeleton_io.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "depth/base/error.h"
#include "depth/base/naming_the_file.h"
#include "recon/files/archive_bytes_internal.h"
#include "recon/files/check_sequence_internal.h"
#include "recon/files/mirrored_body_internal.h"
#include "recon/files/reading_internal.h"
#include "recon/files/recording_names_internal.h"
#include "recon/files/skeleton_formats_internal.h"
#include "recon/files/skeleton_source_internal.h"
#include "recon/files/unlikely_unit_internal.h"

namespace ossa::recon {
namespace {

namespace fs = std::filesystem;

/// Whether the format and columns are those of a Kinect SDK 2 recording; UI-PRMD's tables hold
/// Vicon data beside it.
bool IsKinectV2(std::string_view format, std::string_view columns) {
  if (format == "ui-prmd-csv") return columns != "truth";
  return format == "labanotation-csv" || format == "keraal-kinect" || format == "ntu" ||
         format == "ui-prmd-kinect" || format == "kinect-studio" || format == "pku-mmd";
}

bool AreRefinedJoints(const SkeletonSequence& sequence) {
  return std::any_of(sequence.frames.begin(), sequence.frames.end(), [](const auto& frame) {
    return std::any_of(frame.bodies.begin(), frame.bodies.end(),
                       [](const BodyRecord& body) { return body.bones_m.has_value(); });
  });
}

/// Whether the file states times that are not multiples of this step.
bool StatesOtherTimes(const SkeletonSequence& sequence, double frame_s) {
  constexpr double kOff = 0.01;  // steps, by hand: of rounded times
  const auto& frames = sequence.frames;
  return std::any_of(frames.begin(), frames.end(), [&](const SkeletonFrame& frame) {
    const double steps = (frame.time_s - frames.front().time_s) / frame_s;
    return std::abs(steps - std::round(steps)) > kOff;
  });
}

SkeletonSequence Read(SkeletonInput input, const SkeletonReadOptions& options) {
  const SkeletonFormat& format =
      options.format.empty() ? DetectFormat(input.stream, input.name) : FormatNamed(options.format);
  std::optional<BoneMapping> mapping;
  if (!options.mapping_file.empty()) {
    mapping = ReadBoneMapping(options.mapping_file);
    input.mapping = &*mapping;
  }
  SkeletonSequence sequence = format.read(input);
  CheckBodies(sequence, input.name);
  CheckPositions(sequence, input.name);
  CheckTimes(sequence, input.name);
  for (const std::string& unlikely : DescribeOddities(sequence)) {
    sequence.warnings.push_back(input.name + ": " + unlikely);
  }
  if (options.frame_s > 0 && StatesOtherTimes(sequence, options.frame_s)) {
    sequence.warnings.push_back(
        input.name + ": its frames have times of its own: the frame rate given is not used");
  }
  if (IsKinectV2(format.name, input.columns)) sequence.sensor = kKinectV2;
  if (AreRefinedJoints(sequence)) sequence.sensor = kRefinedJoints;
  return sequence;
}

std::optional<std::string> ReadMappingText(const std::string& name) {
  std::ifstream file(name, std::ios::binary);
  if (!file) return std::nullopt;
  std::ostringstream text;
  text << file.rdbuf();
  return std::move(text).str();
}

std::string Columns(const SkeletonReadOptions& options, const SkeletonPath& parts) {
  if (!parts.columns.empty()) return parts.columns;
  if (options.columns.empty()) return {};
  const std::string columns = ParseColumns(options.columns);
  if (columns.empty()) {
    throw InputError("columns " + Quoted(options.columns) + ": expected truth or observed");
  }
  return columns;
}

SkeletonSequence ReadText(const std::string& text, const std::string& name, const Reading& reading,
                          std::function<std::optional<std::string>(const std::string&)> sibling) {
  std::istringstream stream(text);
  return Read({stream, name, reading.columns, reading.options.frame_s, std::move(sibling)},
              reading.options);
}

SkeletonSequence ReadFile(const fs::path& path, const Reading& reading) {
  return NamingTheFile(path, [&] {
    if (IsGzip(path)) return ReadText(ReadGzip(path), path.string(), reading, {});
    WatchedFile file(path, reading);
    if (!file.is_open()) throw InputError(path.string() + ": cannot be opened for reading");
    std::istream stream(&file);
    return Read({stream, path.string(), reading.columns, reading.options.frame_s, ReadMappingText},
                reading.options);
  });
}

uint64_t SizeOf(const fs::path& file) {
  std::error_code unknown;
  const uintmax_t size = fs::file_size(file, unknown);
  return unknown ? 0 : size;
}

bool Stopped(const SkeletonReadOptions& options) { return options.stop && options.stop(); }

using Members = std::map<std::string, std::string>;

std::vector<RecordingPlace> PlacesIn(const Members& members, const std::string& file) {
  std::vector<RecordingPlace> places;
  for (const auto& [name, text] : members) {
    if (!IsIgnoredFile(name)) places.push_back({file, name});
  }
  return places;
}

// Reads the members of an archive at these places.
std::vector<SkeletonClip> ReadMembers(const fs::path& archive, const Members& members,
                                      const std::vector<RecordingPlace>& places,
                                      const Reading& reading) {
  const std::string prefix = archive.string() + "#";
  const auto sibling = [&](const std::string& name) -> std::optional<std::string> {
    const auto found = members.find(name.starts_with(prefix) ? name.substr(prefix.size()) : name);
    if (found == members.end()) return std::nullopt;
    return found->second;
  };
  std::vector<std::string> files;
  for (const RecordingPlace& place : places) files.push_back(place.member);
  const std::vector<std::string> names = ClipNames(files);
  const uint64_t size = SizeOf(archive);
  std::vector<SkeletonClip> clips;
  for (size_t i = 0; i < files.size() && !Stopped(reading.options); ++i) {
    clips.push_back(
        {names[i], ReadText(members.at(files[i]), prefix + files[i], reading, sibling)});
    reading.Tell(size * (i + 1) / files.size());
  }
  return clips;
}

std::vector<SkeletonClip> ReadArchiveClips(const SkeletonPath& parts, const Reading& reading) {
  const Members members = ReadArchive(parts.path);
  const auto places = SelectRecordings(PlacesIn(members, {}), parts.member);
  return ReadMembers(parts.path, members, places, reading);
}

std::vector<RecordingPlace> FilesIn(const fs::path& folder) {
  std::vector<RecordingPlace> files;
  fs::path latest = folder;
  try {
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      latest = entry.path();
      if (!entry.is_regular_file() || IsIgnoredFile(entry.path())) continue;
      files.push_back({entry.path().lexically_relative(folder).string(), {}});
    }
  } catch (const fs::filesystem_error& error) {  // the iterator's exception names no path
    throw InputError(latest.string() + ": " + error.code().message());
  }
  return files;
}

// Archives are opened to list their members only if no file has exactly that name.
std::vector<RecordingPlace> PlacesAskedFor(const SkeletonPath& parts) {
  const auto files = FilesIn(parts.path);
  if (parts.member.empty()) return files;
  if (auto named = SelectExactNames(files, parts.member); !named.empty()) return named;
  std::vector<RecordingPlace> places;
  for (const RecordingPlace& place : files) {
    const fs::path path = parts.path / place.file;
    const auto inside = IsArchive(path) ? PlacesIn(ReadArchive(path), place.file)
                                        : std::vector<RecordingPlace>{place};
    places.insert(places.end(), inside.begin(), inside.end());
  }
  return SelectRecordings(places, parts.member);
}

std::vector<SkeletonClip> ReadFolderClips(const SkeletonPath& parts, Reading& reading) {
  std::map<fs::path, std::vector<RecordingPlace>> files;
  for (const RecordingPlace& place : PlacesAskedFor(parts)) files[place.file].push_back(place);
  std::vector<std::string> inside;
  for (const auto& [file, places] : files) {
    inside.push_back(file.string());
    reading.of += SizeOf(parts.path / file);
  }
  const std::vector<std::string> names = ClipNames(inside);
  std::vector<SkeletonClip> clips;
  auto name = names.begin();
  for (auto file = files.begin(); file != files.end() && !Stopped(reading.options);
       ++file, ++name) {
    const fs::path path = parts.path / file->first;
    if (!IsArchive(path)) {
      clips.push_back({*name, ReadFile(path, reading)});
      reading.done += SizeOf(path);
      continue;
    }
    const Members members = ReadArchive(path);
    const bool is_whole = file->second.front().member.empty();
    const auto places = is_whole ? PlacesIn(members, {}) : file->second;
    for (SkeletonClip& clip : ReadMembers(path, members, places, reading)) {
      // Archives usually contain a folder of their own name: "s01/s01/x" adds nothing to "s01/x".
      if (!clip.name.starts_with(*name + "/")) clip.name = *name + "/" + clip.name;
      clips.push_back(std::move(clip));
    }
    reading.done += SizeOf(path);
  }
  return clips;
}

// Makes clip names unique: of a folder `s01` beside an archive `s01.tar`, or of names that are
// equal without their extensions, results would overwrite each other.
void MakeNamesDiffer(std::vector<SkeletonClip>& clips) {
  std::set<std::string> taken;
  for (SkeletonClip& clip : clips) {
    const std::string name = clip.name;
    for (int n = 2; !taken.insert(clip.name).second; ++n) clip.name = fmt::format("{}_{}", name, n);
  }
}

// Warns if '#kinect' or '#vicon' selects nothing: in files of one skeleton each, all.tar#kinect and
// all.tar#vicon are the same data, and comparing them gives 0.00 cm.
void WarnIfNothingIsChosen(const fs::path& path, const SkeletonPath& parts,
                           std::vector<SkeletonClip>& clips) {
  const auto is_chosen = [](const SkeletonClip& clip) { return !clip.sequence.columns.empty(); };
  if (parts.columns.empty() || clips.empty()) return;
  if (std::any_of(clips.begin(), clips.end(), is_chosen)) return;
  clips[0].sequence.warnings.push_back(
      path.string() + ": chooses nothing: no file there holds two skeletons side by side");
}

}  // namespace

std::vector<std::string> DescribeOddities(const SkeletonSequence& sequence) {
  std::vector<std::string> oddities;
  for (const auto& describe : {DescribeUnlikelyUnit, DescribeUnlikelyTimes, DescribeMirrored}) {
    std::string oddity = describe(sequence);
    if (!oddity.empty()) oddities.push_back(std::move(oddity));
  }
  return oddities;
}

void RemoveEmptyBodies(SkeletonSequence& sequence) {
  for (const SkeletonFrame& frame : sequence.frames) {
    for (const BodyRecord& body : frame.bodies) {
      if (std::any_of(body.joints.begin(), body.joints.end(),
                      [](const auto& joint) { return joint.has_value(); })) {
        return;
      }
    }
  }
  for (SkeletonFrame& frame : sequence.frames) frame.bodies.clear();
}

void RequireFrames(const SkeletonSequence& sequence) {
  if (!sequence.frames.empty()) return;
  throw InputError(sequence.source + ": expected at least one frame, found none");
}

SkeletonSequence ReadSkeletonStream(std::istream& stream, const std::string& name,
                                    const SkeletonReadOptions& options) {
  return Read({stream, name, Columns(options, {}), options.frame_s, {}}, options);
}

fs::path FindSkeletonFile(const fs::path& path) { return TakeApart(path).path; }

std::vector<SkeletonClip> ReadSkeletonClips(const fs::path& path,
                                            const SkeletonReadOptions& options) {
  const SkeletonPath parts = TakeApart(path);
  Reading reading{options, Columns(options, parts)};
  std::error_code unknown;
  if (!fs::exists(parts.path, unknown)) {
    throw InputError(parts.path.string() + ": no such file or folder");
  }
  if (!fs::is_directory(parts.path) && !fs::is_regular_file(parts.path)) {
    throw InputError(parts.path.string() +
                     ": expected a file or a folder, found a pipe or a device, which cannot be "
                     "read twice: save it to a file first");
  }
  std::vector<SkeletonClip> clips;
  if (fs::is_directory(parts.path)) {
    clips = ReadFolderClips(parts, reading);
  } else if (reading.of = SizeOf(parts.path); IsArchive(parts.path)) {
    clips = NamingTheFile(parts.path, [&] { return ReadArchiveClips(parts, reading); });
  } else if (parts.member.empty()) {
    clips.push_back({"", ReadFile(parts.path, reading)});
  } else {
    throw InputError(parts.path.string() + ": expected a folder or an archive before '#', or " +
                     "#truth or #observed after it, found #" + parts.member);
  }
  MakeNamesDiffer(clips);
  WarnIfNothingIsChosen(path, parts, clips);
  if (clips.empty() && !Stopped(options)) {
    throw InputError(path.string() + ": holds no skeleton recording");
  }
  return clips;
}

SkeletonSequence ReadSkeletons(const fs::path& path, const SkeletonReadOptions& options) {
  auto clips = ReadSkeletonClips(path, options);
  if (clips.empty()) return {path.string(), {}};  // cancelled
  if (clips.size() > 1) {
    const SkeletonPath parts = TakeApart(path);
    const std::string columns = parts.columns.empty() ? "" : "#" + parts.columns;
    throw InputError(path.string() + ": expected one recording, found " +
                     std::to_string(clips.size()) + ": name one, as " + parts.path.string() +
                     columns + "#" + clips[0].name);
  }
  return std::move(clips[0].sequence);
}

}  // namespace ossa::recon
