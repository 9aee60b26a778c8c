// Recordings of Kinect Studio, of a Kinect v2.
#include <cstring>
#include <fstream>
#include <optional>
#include <utility>

#include "depth/base/error.h"
#include "depth/base/open_file.h"
#include "depth/sensor/sensor_clock.h"
#include "depth/sensor/source_internal.h"
#include "depth/sensor/xef_file.h"

namespace ossa::depth {
namespace {

class XefSource final : public FrameSource {
 public:
  XefSource(std::string name, std::ifstream file, std::vector<XefEvent> images,
            const SourceOptions& options)
      : name_(std::move(name)), file_(std::move(file)), images_(std::move(images)) {
    camera_ = options.camera ? ChosenCamera(options, kXefWidth, kXefHeight)
                             : CameraByImageSize(name_, kXefWidth, kXefHeight, options);
  }

  ReadResult Read(std::chrono::milliseconds) override {
    if (next_ == images_.size()) return {.status = ReadStatus::kEnd, .frame = {}};
    const XefEvent& image = images_[next_++];
    ReadResult result{.status = ReadStatus::kFrame, .frame = {}};
    result.dropped = CountDropped(image.number);
    frame_ += result.dropped + 1;
    result.frame.camera = camera_;
    result.frame.index = frame_;
    result.frame.time_s = clock_.TimeOf(image.time_s - images_.front().time_s);
    try {
      const std::vector<uint8_t> bytes = ReadXefBytes(file_, image);
      result.frame.depth_mm.resize(bytes.size() / sizeof(uint16_t));
      std::memcpy(result.frame.depth_mm.data(), bytes.data(), bytes.size());
    } catch (const InputError& error) {
      throw InputError(name_ + ": byte " + std::to_string(image.at) + ": frame " +
                       std::to_string(frame_) + ": " + error.what());
    }
    return result;
  }
  const Camera& camera() const override { return camera_; }
  bool is_live() const override { return false; }
  std::optional<int64_t> frame_count() const override {
    return static_cast<int64_t>(images_.size());
  }

 private:
  // Images that the sensor counted between the last one and this; a count that starts again, or
  // that leaps, is another recording's.
  int64_t CountDropped(int64_t number) {
    constexpr int64_t kMost = 300;  // images, by hand: ten seconds
    const int64_t step = last_number_ && number >= 0 ? number - *last_number_ : 1;
    last_number_ = number;
    return step > 1 && step <= kMost ? step - 1 : 0;
  }

  std::string name_;
  std::ifstream file_;
  std::vector<XefEvent> images_;
  Camera camera_;
  SensorClock clock_;
  std::optional<int64_t> last_number_;
  size_t next_ = 0;
  int64_t frame_ = -1;  // the last one's index
};

void TellOf(const std::string& name, const XefIndex& index, const SourceOptions& options) {
  if (!options.note) return;
  if (!options.mirrored) {
    options.note(NoteKind::kInfo, name +
                                      ": images of Kinect Studio are mirrored, as the SDK delivers "
                                      "them: --mirrored exchanges left and right");
  }
  if (index.is_cut_short) {
    options.note(NoteKind::kWarning, name + ": cut short: " + std::to_string(index.depth.size()) +
                                         " depth images are complete");
  }
  if (index.lost_bytes > 0) {
    options.note(NoteKind::kWarning, name + ": damaged: " + std::to_string(index.lost_bytes) +
                                         " bytes are no event and are left out");
  }
}

}  // namespace

std::unique_ptr<FrameSource> OpenXefFile(const std::filesystem::path& path,
                                         const SourceOptions& options) {
  if (!std::filesystem::is_regular_file(path)) {
    throw InputError(path.string() + ": expected a recording, found a pipe or a device");
  }
  std::ifstream file = OpenFile(path);
  XefIndex index = ReadXefIndex(file, path.string());
  if (index.depth.empty()) {
    throw InputError(path.string() +
                     ": expected depth images (in Kinect Studio the stream 'Nui Depth'), found "
                     "none in its streams: " +
                     index.StreamNames());
  }
  TellOf(path.string(), index, options);
  return std::make_unique<XefSource>(path.string(), std::move(file), std::move(index.depth),
                                     options);
}

}  // namespace ossa::depth
