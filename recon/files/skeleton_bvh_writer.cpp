#include <utility>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "recon/files/people_log_internal.h"
#include "recon/files/skeleton_writer_internal.h"

namespace ossa::recon {
namespace {

namespace fs = std::filesystem;

// The header holds median bone lengths over all frames, so files are written at the end.
class BvhWriter final : public SkeletonWriter::Format {
 public:
  BvhWriter(fs::path path, BvhNames names) : path_(std::move(path)), people_(FolderOf(path_)) {
    options_.names = names;
    AtomicFile::CheckWritable(path_);
  }

  void Write(const SkeletonFrame& frame) override { people_.Append(frame); }

  void Finish() override {
    RequirePeople(people_, path_);
    WriteFiles(people_);
  }

  int64_t FinishWithWhatFits() override {
    return WriteWhatFits(people_, [this](const PeopleLog& people) { WriteFiles(people); });
  }

 private:
  /// All or none: if one file does not fit, the earlier ones are removed.
  void WriteFiles(const PeopleLog& people) {
    const std::vector<int>& ids = people.ids();
    for (size_t i = 0; i < ids.size(); ++i) {
      try {
        WriteSightingsAsBvh(people.SightingsOf(ids[i]), people.begin_s(),
                            PathForBody(path_, i, ids[i]), options_);
      } catch (const DiskFull&) {
        for (size_t k = 0; k < i; ++k) fs::remove(PathForBody(path_, k, ids[k]));
        throw;
      }
    }
  }

  fs::path path_;
  BvhExportOptions options_;
  PeopleLog people_;
};

}  // namespace

void RequirePeople(const PeopleLog& people, const fs::path& path) {
  if (!people.ids().empty()) return;
  throw InputError(
      path.string() +
      ": expected a person in one frame or more, found none (.jsonl, .csv and .trc can "
      "be written without people)");
}

std::unique_ptr<SkeletonWriter::Format> NewBvhWriter(const fs::path& path, BvhNames names) {
  return std::make_unique<BvhWriter>(path, names);
}

}  // namespace ossa::recon
