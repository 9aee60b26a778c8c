#include <optional>
#include <string>

#include "depth/base/error.h"
#include "depth/image/camera_io.h"
#include "depth/sensor/child_process_internal.h"
#include "depth/sensor/oni_format_internal.h"
#include "depth/sensor/oni_pipe_internal.h"
#include "depth/sensor/openni2/openni_depth_internal.h"
#include "depth/sensor/openni2/runtime_folder.h"
#include "depth/sensor/source_internal.h"

namespace ossa::depth {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;

class OniFileSource final : public FrameSource {
 public:
  OniFileSource(const fs::path& path, const OniFile& recording, const SourceOptions& options)
      : name_(path.string()),
        patience_(options.player_patience),
        own_camera_(recording.camera),
        child_(OpenNiRuntimeFolder() / "reader/ossa_oni_reader", {fs::absolute(path).string()}) {
    OniPipeHello hello;
    OniPipeMessage message;  // an error may come in place of the hello: read what both begin with
    Take(&hello.magic, sizeof(hello.magic));
    if (hello.magic != OniPipeHello::kMagic) {
      message.kind = static_cast<OniPipeKind>(hello.magic);
      Take(reinterpret_cast<char*>(&message) + sizeof(message.kind),
           sizeof(message) - sizeof(message.kind));
      Fail(message);
    }
    Take(reinterpret_cast<char*>(&hello) + sizeof(hello.magic),
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
    if (ended_) return {.status = ReadStatus::kEnd, .frame = {}};
    if (child_.WaitForOutput(timeout) == ChildProcess::Outcome::kTimeout) {
      waited_ += timeout;
      if (waited_ > patience_) FailHung();
      return {.status = ReadStatus::kTimeout, .frame = {}};
    }
    waited_ = milliseconds{0};
    OniPipeMessage message;
    Take(&message, sizeof(message));
    if (message.kind == OniPipeKind::kEnd) {
      ended_ = true;
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
    if (options.camera) return CameraForSize(*options.camera, width, height);
    if (own_camera_) return CameraForSize(*own_camera_, width, height);
    return CameraFromFieldOfView(width, height, hello.horizontal_fov_rad, hello.vertical_fov_rad);
  }

  ReadResult TakeFrame(const OniPipeMessage& message) {
    const ImageWindow& window = message.window;
    if (!window.IsSane()) FailHung();
    ReadResult result{.status = ReadStatus::kFrame, .frame = {}};
    result.frame.camera = CropToWindow(whole_, window);
    result.frame.depth_mm.resize(static_cast<size_t>(window.width) *
                                 static_cast<size_t>(window.height));
    Take(result.frame.depth_mm.data(), result.frame.depth_mm.size() * sizeof(uint16_t));
    result.frame.index = message.index;
    result.frame.time_s = static_cast<double>(message.timestamp_us) * 1e-6;
    next_frame_ = message.index + 1;
    return result;
  }

  void Take(void* to, size_t size) {
    switch (child_.ReadExactly(to, size, patience_)) {
      case ChildProcess::Outcome::kRead:
        return;
      case ChildProcess::Outcome::kTimeout:
        FailHung();
      case ChildProcess::Outcome::kClosed:
        ended_ = true;
        throw InputError(Place() + "the OpenNI2 library crashed on it (" + child_.Ending() +
                         "): the recording is damaged");
    }
  }

  [[noreturn]] void FailHung() {
    ended_ = true;
    throw InputError(Place() + "the OpenNI2 library hangs on it: the recording is damaged");
  }

  [[noreturn]] void Fail(const OniPipeMessage& message) {
    constexpr uint32_t kLongest = 1000;  // a bound; by hand
    std::string text(std::min(message.size, kLongest), ' ');
    Take(text.data(), text.size());
    ended_ = true;
    throw InputError(name_ + ": " + text);
  }

  std::string Place() const {
    return name_ + ": " +
           (next_frame_ > 0 ? "after frame " + std::to_string(next_frame_ - 1) + ": " : "");
  }

  std::string name_;
  milliseconds patience_;
  std::optional<Camera> own_camera_;  // as ossa wrote it into the file
  ChildProcess child_;
  Camera whole_;   // of the whole image, of which frames may show a part
  Camera camera_;  // of the part
  std::optional<int64_t> frame_count_;
  milliseconds waited_{0};
  int64_t next_frame_ = 0;
  bool ended_ = false;
};

}  // namespace

std::unique_ptr<FrameSource> OpenOniFile(const fs::path& path, const SourceOptions& options) {
  OniFile recording = CheckOniFile(path);
  if (recording.unfinished) return OpenUnfinishedOni(path, std::move(recording), options);
  return std::make_unique<OniFileSource>(path, recording, options);
}

}  // namespace ossa::depth
