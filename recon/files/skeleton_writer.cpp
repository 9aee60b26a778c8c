#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "depth/base/line_file.h"
#include "depth/base/long_name.h"
#include "depth/base/lower_case.h"
#include "recon/files/skeleton_formats_internal.h"
#include "recon/files/skeleton_io.h"
#include "recon/files/skeleton_jsonl.h"
#include "recon/files/skeleton_writer_internal.h"

namespace ossa::recon {
namespace {

namespace fs = std::filesystem;

// Formats that do not state the number of their lines.
class LineWriter final : public SkeletonWriter::Format {
 public:
  using LinesOf = std::string (*)(const SkeletonFrame&);

  LineWriter(const fs::path& path, const std::string& head, LinesOf lines)
      : file_(path, head), lines_(lines) {}

  void Write(const SkeletonFrame& frame) override {
    file_.Append(lines_(frame));
    ++frames_;
  }
  void Finish() override { file_.Finish(); }
  int64_t FinishWithWhatFits() override {
    if (frames_ > 0) file_.FinishWithWhatFits();
    return frames_;
  }

 private:
  LineFile file_;
  LinesOf lines_;
  int64_t frames_ = 0;
};

std::string JsonlLine(const SkeletonFrame& frame) { return SkeletonJsonLine(frame) + '\n'; }

std::unique_ptr<SkeletonWriter::Format> NewWriter(const fs::path& path,
                                                  const SkeletonWriteOptions& options) {
  CheckSkeletonExtension(path);
  const std::string extension = LowerCaseExtension(path);
  if (extension == ".trc") return NewTrcWriter(path);
  if (extension == ".bvh") return NewBvhWriter(path, options.names);
  if (extension == ".glb") return NewGltfWriter(path, options);
  if (extension == ".csv") {
    return std::make_unique<LineWriter>(path, SkeletonCsvHead(), SkeletonCsvRows);
  }
  return std::make_unique<LineWriter>(path, "", JsonlLine);
}

}  // namespace

SkeletonWriter::SkeletonWriter(const fs::path& path, const SkeletonWriteOptions& options)
    : path_(path), format_(NewWriter(path, options)) {}
SkeletonWriter::~SkeletonWriter() = default;

// Files with times that fall are read by no one, and a BVH loses the frames.
void SkeletonWriter::Write(const SkeletonFrame& frame) {
  if (last_s_ && frame.time_s < *last_s_) {
    throw InputError(fmt::format("{}: frame {}: expected times that grow, found {} after {}",
                                 path_.string(), frame.frame, frame.time_s, *last_s_));
  }
  last_s_ = frame.time_s;
  ++frame_count_;
  format_->Write(frame);
}

void SkeletonWriter::SetShape(int id, const ShapeVector& shape) { format_->SetShape(id, shape); }

void SkeletonWriter::Finish() { format_->Finish(); }

int64_t SkeletonWriter::FinishWithWhatFits() { return format_->FinishWithWhatFits(); }

fs::path PathForBody(const fs::path& path, size_t index, int id) {
  if (index == 0) return path;
  std::string name = path.stem().string();
  const std::string end = fmt::format("_{}{}", id, path.extension().string());
  // Shortens the base name if the added `_ID` would make it too long.
  const size_t most = LongestNameIn(FolderOf(path));
  if (path.filename().string().size() <= most && name.size() + end.size() > most) {
    name = ShortenName(name, most - end.size());
  }
  fs::path other = path;
  return other.replace_filename(name + end);
}

void CheckSkeletonExtension(const fs::path& path) {
  static constexpr std::array kKnown = {".jsonl", ".csv", ".trc", ".bvh", ".glb"};
  if (std::find(kKnown.begin(), kKnown.end(), LowerCaseExtension(path)) != kKnown.end()) return;
  throw InputError(path.string() + ": expected a name in .jsonl, .csv, .trc, .bvh or .glb, found " +
                   Quoted(path.extension().string()));
}

void WriteSkeletons(const fs::path& path, const SkeletonSequence& sequence) {
  WriteSkeletons(path, sequence, {});
}

void WriteSkeletons(const fs::path& path, const SkeletonSequence& sequence,
                    const SkeletonWriteOptions& options) {
  SkeletonWriter writer(path, options);
  for (const SkeletonFrame& frame : sequence.frames) writer.Write(frame);
  writer.Finish();
}

}  // namespace ossa::recon
