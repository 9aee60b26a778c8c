#include <utility>

#include "depth/image/turn.h"
#include "depth/sensor/source_internal.h"

namespace ossa::depth {
namespace {

class UnmirroredFrames final : public FrameSource {
 public:
  explicit UnmirroredFrames(std::unique_ptr<FrameSource> source)
      : source_(std::move(source)), camera_(Unmirrored(source_->camera())) {}

  ReadResult Read(std::chrono::milliseconds timeout) override {
    ReadResult read = source_->Read(timeout);
    if (read.status == ReadStatus::kFrame) read.frame = Unmirrored(read.frame);
    camera_ = Unmirrored(source_->camera());  // a reconnected device may be another one
    return read;
  }
  const Camera& camera() const override { return camera_; }
  bool is_live() const override { return source_->is_live(); }
  std::optional<int64_t> frame_count() const override { return source_->frame_count(); }

 private:
  std::unique_ptr<FrameSource> source_;
  Camera camera_;
};

}  // namespace

std::unique_ptr<FrameSource> UnmirroredSource(std::unique_ptr<FrameSource> source) {
  return std::make_unique<UnmirroredFrames>(std::move(source));
}

}  // namespace ossa::depth
