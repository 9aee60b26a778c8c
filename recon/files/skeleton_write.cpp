#include <algorithm>
#include <array>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "recon/files/skeleton_formats_internal.h"
#include "recon/files/skeleton_io.h"
#include "recon/files/skeleton_jsonl.h"
#include "recon/motion/bvh.h"

namespace ossa::recon {
namespace {

namespace fs = std::filesystem;

bool IsAnyone(const BodyRecord&) { return true; }

bool IsSomewhere(const BodyRecord& body) {
  return std::any_of(body.joints.begin(), body.joints.end(),
                     [](const auto& joint) { return joint && HasPlace(*joint); });
}

// Of the bodies that `counts` holds for in some frame, as they appear.
std::vector<int> BodyIds(const SkeletonSequence& sequence, bool (*counts)(const BodyRecord&)) {
  std::vector<int> ids;
  for (const SkeletonFrame& frame : sequence.frames) {
    for (const BodyRecord& body : frame.bodies) {
      const bool is_new = std::find(ids.begin(), ids.end(), body.id) == ids.end();
      if (is_new && counts(body)) ids.push_back(body.id);
    }
  }
  return ids;
}

fs::path PathForBody(const fs::path& path, size_t index, int id) {
  if (index == 0) return path;
  fs::path other = path;
  other.replace_filename(path.stem().string() + "_" + std::to_string(id) +
                         path.extension().string());
  return other;
}

// Every frame of a BVH is a whole posture: of a body that has no joint in any it would be made up.
void WriteBvhs(const fs::path& path, const SkeletonSequence& sequence) {
  const std::vector<int> ids = BodyIds(sequence, IsSomewhere);
  if (ids.empty()) {
    throw InputError(path.string() +
                     ": expected somebody whose motion a .bvh can hold, found nobody in any frame "
                     "(.jsonl, .csv and .trc hold that, too)");
  }
  for (size_t i = 0; i < ids.size(); ++i) {
    BvhExportOptions options;
    options.body_id = ids[i];
    WriteBvhOfSkeleton(sequence, PathForBody(path, i, ids[i]), options);
  }
}

void WriteTrcs(const fs::path& path, const SkeletonSequence& sequence) {
  std::vector<int> ids = BodyIds(sequence, IsAnyone);
  if (ids.empty()) ids.push_back(1);  // a table of empty rows
  for (size_t i = 0; i < ids.size(); ++i) {
    const fs::path own = PathForBody(path, i, ids[i]);
    AtomicFile file(own);
    WriteTrc(file.stream(), sequence, ids[i], own.filename().string());
    file.Commit();
  }
}

}  // namespace

void CheckSkeletonExtension(const fs::path& path) {
  static constexpr std::array kKnown = {".jsonl", ".csv", ".trc", ".bvh"};
  if (std::find(kKnown.begin(), kKnown.end(), path.extension()) != kKnown.end()) return;
  throw InputError(path.string() + ": expected a name in .jsonl, .csv, .trc or .bvh, found " +
                   Quoted(path.extension().string()));
}

void WriteSkeletons(const fs::path& path, const SkeletonSequence& sequence) {
  CheckSkeletonExtension(path);
  if (path.extension() == ".jsonl" || path.extension() == ".csv") {
    AtomicFile file(path);
    if (path.extension() == ".csv") {
      WriteSkeletonCsv(file.stream(), sequence);
    } else {
      SkeletonJsonlWriter writer(file.stream());
      for (const SkeletonFrame& frame : sequence.frames) writer.Write(frame);
    }
    file.Commit();
    return;
  }
  if (path.extension() == ".bvh") {
    WriteBvhs(path, sequence);
  } else {
    WriteTrcs(path, sequence);
  }
}

}  // namespace ossa::recon
