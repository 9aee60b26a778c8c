#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

#include "recon/skeleton_sequence.h"

namespace ossa::recon {

/// How recorded skeletons are read; for what a file does not state.
struct SkeletonReadOptions {
  /// For files with two skeletons side by side (UI-PRMD derived K_ and G_ columns, ITOP G_ and P_):
  /// "truth" (also vicon) or "observed" (also kinect, estimate); without it they are refused. Also
  /// possible after the path: `s01.tar.gz#truth`.
  std::string columns;
  /// One of SkeletonFormats(); "": recognised by content.
  std::string format;
  /// Time step of formats that carry no time, seconds; 0: the format's own usual rate. A file that
  /// states other times keeps them, and has a warning.
  double frame_s = 0.0;
  /// Mapping file of unknown names of joints or points, for files in which they occur: lines
  /// `ElbowLeft = name` (docs/files.md); "": none.
  std::string mapping_file;
  /// Called before each recording of a folder or an archive; true ends the reading, and the
  /// recordings read so far are returned.
  std::function<bool()> stop = {};
  /// Called while reading with the bytes read so far and in all; may be empty.
  std::function<void(uint64_t done, uint64_t of)> progress = {};
};

/// The names of all formats that are read, e.g. "jsonl", "ui-prmd-kinect".
std::vector<std::string> SkeletonFormats();

/// Reads one recording in any known format, recognised by content. The result has the 20 SDK joints
/// in camera space (x to the sensor's left, y up, z forward), metres, with the person's own left
/// and right. `path` may end in `#truth` or `#observed` (see options) and, for a folder or an
/// archive, in `#MEMBER`: the recording of that name, with or without extension; else one with that
/// name as a component of its path; else one whose path contains it. The file is `path` itself if
/// it exists, else the longest part before a '#' that exists. Throws InputError in one line, also
/// for several recordings. Returns no frames if options.stop ended it.
SkeletonSequence ReadSkeletons(const std::filesystem::path& path,
                               const SkeletonReadOptions& options = {});

/// The file or folder of such a path, without the part after '#'.
std::filesystem::path FindSkeletonFile(const std::filesystem::path& path);

/// One recording of several.
struct SkeletonClip {
  // Path inside the folder or archive; without its extension, where that tells no two apart; "" for
  // one file.
  std::string name;
  SkeletonSequence sequence;
};

/// All recordings of a file, a folder (searched through) or an archive (.tar .tar.gz .zip), sorted
/// by name; equal names on both sides of a comparison belong together. Files in a folder that are
/// no skeletons by their extension (.md, LICENSE, README...) are ignored.
std::vector<SkeletonClip> ReadSkeletonClips(const std::filesystem::path& path,
                                            const SkeletonReadOptions& options = {});

/// As ReadSkeletons, from a stream; `name` stands for the file in messages and helps tell formats
/// apart. Formats that need a second file (UI-PRMD positions) cannot be read this way.
SkeletonSequence ReadSkeletonStream(std::istream& stream, const std::string& name,
                                    const SkeletonReadOptions& options = {});

/// What cannot be right about the unit of the positions, that of the times, or left and right, a
/// sentence each; empty if all is plausible. The functions above add it to the warnings.
std::vector<std::string> DescribeOddities(const SkeletonSequence& sequence);

/// Writes by extension: .jsonl, .csv, .trc, .bvh, .glb (skeleton_writer.h). TRC and BVH hold one
/// person per file: of several, the first is written to `path` and each other one to `path` with
/// `_ID` before the extension; all begin with the sequence's first frame. Files appear under their
/// names only when complete. Throws InputError for a BVH that would be too long to be read, because
/// gaps are filled there.
void WriteSkeletons(const std::filesystem::path& path, const SkeletonSequence& sequence);

/// Throws InputError if WriteSkeletons would refuse the extension; to be called before a long run.
void CheckSkeletonExtension(const std::filesystem::path& path);

}  // namespace ossa::recon
