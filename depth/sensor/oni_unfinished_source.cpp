// Our recordings without an end, because the recorder was killed or the file was truncated. OpenNI2
// plays the former if no frame is truncated, and none of the latter; this source reads every
// complete frame.
#include "depth/base/error.h"
#include "depth/base/open_file.h"
#include "depth/image/camera_io.h"
#include "depth/sensor/oni_codec_internal.h"
#include "depth/sensor/source_internal.h"

namespace ossa::depth {
namespace {

class OniUnfinishedSource final : public FrameSource {
 public:
  OniUnfinishedSource(const std::filesystem::path& path, OniFile recording,
                      const SourceOptions& options)
      : name_(path.string()), file_(OpenFile(path)), frames_(std::move(*recording.unfinished)) {
    const Camera& own = *recording.camera;
    camera_ = options.camera ? ChosenCamera(options, own.width, own.height) : own;
  }

  ReadResult Read(std::chrono::milliseconds) override {
    if (next_ == frames_.size()) return {.status = ReadStatus::kEnd, .frame = {}};
    const OniFrameAt& at = frames_[next_];
    ReadResult result{.status = ReadStatus::kFrame, .frame = {}};
    result.frame.camera = camera_;
    result.frame.index = static_cast<int64_t>(next_++);
    result.frame.time_s = static_cast<double>(at.timestamp_us) * 1e-6;
    std::vector<uint8_t> data(at.data_size);
    file_.seekg(static_cast<std::streamoff>(at.data_at));
    const bool is_read = bool(file_.read(reinterpret_cast<char*>(data.data()),
                                         static_cast<std::streamsize>(data.size())));
    const auto pixels = static_cast<size_t>(camera_.width) * static_cast<size_t>(camera_.height);
    if (!is_read || !DecodeOniDepth(data, pixels, &result.frame.depth_mm)) {
      throw InputError(name_ + ": byte " + std::to_string(at.data_at) + ": frame " +
                       std::to_string(result.frame.index) + ": its depth is damaged");
    }
    return result;
  }
  const Camera& camera() const override { return camera_; }
  bool is_live() const override { return false; }
  std::optional<int64_t> frame_count() const override {
    return static_cast<int64_t>(frames_.size());
  }

 private:
  std::string name_;
  std::ifstream file_;
  std::vector<OniFrameAt> frames_;
  Camera camera_;
  size_t next_ = 0;
};

}  // namespace

std::unique_ptr<FrameSource> OpenUnfinishedOni(const std::filesystem::path& path, OniFile recording,
                                               const SourceOptions& options) {
  if (options.note) {
    options.note(
        NoteKind::kWarning,
        path.string() +
            ": the recording has no end: its recorder was killed, or it was cut short; the " +
            std::to_string(recording.unfinished->size()) +
            " frames that are whole are read, without the checksum that vouches for them");
  }
  return std::make_unique<OniUnfinishedSource>(path, std::move(recording), options);
}

}  // namespace ossa::depth
