#include <algorithm>
#include <map>
#include <vector>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "recon/files/skeleton_writer_internal.h"
#include "recon/motion/sightings_internal.h"

namespace ossa::recon {
namespace {

namespace fs = std::filesystem;

bool IsSomewhere(const BodyRecord& body) {
  return std::any_of(body.joints.begin(), body.joints.end(),
                     [](const auto& joint) { return joint && HasPlace(*joint); });
}

// The head holds the bones' lengths, medians over all frames: files are made at the end.
class BvhWriter final : public SkeletonWriter::Format {
 public:
  BvhWriter(fs::path path, BvhNames names) : path_(std::move(path)) {
    options_.names = names;
    AtomicFile::CheckWritable(path_);
  }

  void Write(const SkeletonFrame& frame) override {
    if (!begin_s_) begin_s_ = frame.time_s;
    for (const BodyRecord& body : frame.bodies) {
      const bool is_new = std::find(ids_.begin(), ids_.end(), body.id) == ids_.end();
      // Every frame of a BVH is a whole posture: of a body that has no joint in any frame it would
      // be made up.
      if (is_new && IsSomewhere(body)) ids_.push_back(body.id);
      seen_.try_emplace(body.id, FolderOf(path_)).first->second.Append(body, frame.time_s);
    }
  }

  void Finish() override {
    if (ids_.empty()) {
      throw InputError(path_.string() +
                       ": expected somebody whose motion a .bvh can hold, found nobody in any "
                       "frame (.jsonl, .csv and .trc hold that, too)");
    }
    for (size_t i = 0; i < ids_.size(); ++i) {
      SightingLog& seen = seen_.at(ids_[i]);
      const double begin_s = std::min(*begin_s_, seen[0].time_s);
      WriteBvhOfSightings(std::move(seen), begin_s, PathForBody(path_, i, ids_[i]), options_);
    }
  }

  int64_t FinishWithWhatFits() override { return 0; }

 private:
  fs::path path_;
  BvhExportOptions options_;
  std::optional<double> begin_s_;  // the first frame's, whoever is in it
  std::vector<int> ids_;           // of those who were somewhere, as they appeared
  std::map<int, SightingLog> seen_;
};

}  // namespace

std::unique_ptr<SkeletonWriter::Format> NewBvhWriter(const fs::path& path, BvhNames names) {
  return std::make_unique<BvhWriter>(path, names);
}

}  // namespace ossa::recon
