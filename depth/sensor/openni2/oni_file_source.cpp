#include <optional>
#include <string>

#include "depth/base/error.h"
#include "depth/image/camera_io.h"
#include "depth/sensor/oni_format_internal.h"
#include "depth/sensor/oni_pipe_internal.h"
#include "depth/sensor/openni2/openni_depth_internal.h"
#include "depth/sensor/openni2/runtime_folder.h"
#include "depth/sensor/recording_pipe_internal.h"
#include "depth/sensor/sensor_clock.h"
#include "depth/sensor/source_internal.h"

namespace ossa::depth {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;

class OniFileSource final : public FrameSource {
 public:
  OniFileSource(const fs::path& path, const OniFile& recording, const SourceOptions& options)
      : name_(path.string()),
        own_camera_(recording.camera),
        pipe_(name_,
              {OpenNiRuntimeFolder() / "reader/ossa_oni_reader",
               {fs::absolute(path).string()},
               "the OpenNI2 library"},
              options.player_patience) {
    OniPipeHello hello;
    OniPipeMessage message;  // an error may replace the hello: read their common part
    pipe_.Take(&hello.magic, sizeof(hello.magic));
    if (hello.magic != OniPipeHello::kMagic) {
      message.kind = static_cast<OniPipeKind>(hello.magic);
      pipe_.Take(reinterpret_cast<char*>(&message) + sizeof(message.kind),
                 sizeof(message) - sizeof(message.kind));
      Fail(message);
    }
    pipe_.Take(reinterpret_cast<char*>(&hello) + sizeof(hello.magic),
               sizeof(hello) - sizeof(hello.magic));
    whole_ = ReadWholeCamera(hello, options);
    camera_ = CropToWindow(whole_, hello.window);
    if (hello.frame_count >= 0) {
      frame_count_ = hello.frame_count;
    } else if (options.note) {
      options.note(NoteKind::kWarning,
                   name_ + ": its recorder did not finish it: frames are read as far as they go");
    }
  }

  ReadResult Read(milliseconds timeout) override {
    if (pipe_.ended()) return {.status = ReadStatus::kEnd, .frame = {}};
    if (!pipe_.Wait(timeout)) return {.status = ReadStatus::kTimeout, .frame = {}};
    OniPipeMessage message;
    pipe_.Take(&message, sizeof(message));
    if (message.kind == OniPipeKind::kEnd) {
      pipe_.End();
      return {.status = ReadStatus::kEnd, .frame = {}};
    }
    if (message.kind != OniPipeKind::kFrame) Fail(message);
    return TakeFrame(message);
  }
  const Camera& camera() const override { return camera_; }
  bool is_live() const override { return false; }
  std::optional<int64_t> frame_count() const override { return frame_count_; }

 private:
  Camera ReadWholeCamera(const OniPipeHello& hello, const SourceOptions& options) const {
    const int width = hello.window.whole_width, height = hello.window.whole_height;
    if (!hello.window.IsSane()) {
      throw InputError(name_ + ": video mode: expected a size, found " + std::to_string(width) +
                       "x" + std::to_string(height));
    }
    if (options.camera) return ChosenCamera(options, width, height);
    if (own_camera_) return CameraForSize(*own_camera_, width, height);
    return CameraFromFieldOfView(width, height, hello.horizontal_fov_rad, hello.vertical_fov_rad);
  }

  ReadResult TakeFrame(const OniPipeMessage& message) {
    const ImageWindow& window = message.window;
    if (!window.IsSane()) {
      pipe_.Fail("expected a part of the image, found " + std::to_string(window.width) + "x" +
                 std::to_string(window.height) + " of " + std::to_string(window.whole_width) + "x" +
                 std::to_string(window.whole_height) + ": the recording is damaged");
    }
    ReadResult result{.status = ReadStatus::kFrame, .frame = {}};
    result.frame.camera = CropToWindow(whole_, window);
    result.frame.depth_mm.resize(static_cast<size_t>(window.width) *
                                 static_cast<size_t>(window.height));
    pipe_.Take(result.frame.depth_mm.data(), result.frame.depth_mm.size() * sizeof(uint16_t));
    result.frame.index = message.index;
    result.frame.time_s = clock_.TimeOf(message.timestamp_us);
    pipe_.RecordFrame(message.index);
    return result;
  }

  [[noreturn]] void Fail(const OniPipeMessage& message) {
    const std::string text = pipe_.TakeText(message.size);
    pipe_.End();
    throw InputError(name_ + ": " + text);
  }

  std::string name_;
  std::optional<Camera> own_camera_;  // as written by ossa
  RecordingPipe pipe_;
  Camera whole_;   // of the full image, of which frames may be a part
  Camera camera_;  // of the frames
  std::optional<int64_t> frame_count_;
  SensorClock clock_;
};

}  // namespace

std::unique_ptr<FrameSource> OpenOniFile(const fs::path& path, const SourceOptions& options) {
  OniFile recording = CheckOniFile(path);
  if (recording.unfinished) return OpenUnfinishedOni(path, std::move(recording), options);
  return std::make_unique<OniFileSource>(path, recording, options);
}

}  // namespace ossa::depth
