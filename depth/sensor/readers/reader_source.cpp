#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "depth/base/error.h"
#include "depth/sensor/child_process_internal.h"
#include "depth/sensor/openni2/runtime_folder.h"
#include "depth/sensor/readers/reader_pipe_internal.h"
#include "depth/sensor/source_internal.h"

namespace ossa::depth {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;

// Which program reads a kind of file, and whose library it needs.
struct Reader {
  const char* program;
  const char* library;  // Debian's package
};

fs::path FindProgram(const Reader& reader, const std::string& name) {
  const fs::path program = OpenNiRuntimeFolder() / "reader" / reader.program;
  if (fs::exists(program)) return program;
  throw InputError(
      name + ": expected " + program.string() +
      " to read it, found none: install the Debian package ossa-readers (built without " +
      reader.library + " it has none)");
}

class ReaderSource final : public FrameSource {
 public:
  ReaderSource(const Reader& reader, const std::string& name,
               const std::vector<std::string>& arguments, const SourceOptions& options)
      : reader_(reader),
        name_(name),
        options_(options),
        child_(FindProgram(reader, name), arguments) {
    const ReaderMessage message = TakeMessage(ReaderKind::kHello, sizeof(ReaderHello));
    if (message.kind == ReaderKind::kEnd) {
      throw InputError(name_ + ": expected depth images, found none");
    }
    Take(&hello_, sizeof(hello_));
    const int width = hello_.camera.width, height = hello_.camera.height;
    if (options.camera) {
      hello_.camera = CameraForSize(*options.camera, width, height);
    } else if (!hello_.is_camera_stated) {
      hello_.camera = CameraByImageSize(name_, width, height, options);
    }
    CheckCamera(hello_.camera, name_ + ": camera");
  }

  ReadResult Read(milliseconds timeout) override {
    if (ended_) return {.status = ReadStatus::kEnd, .frame = {}};
    if (child_.WaitForOutput(timeout) == ChildProcess::Outcome::kTimeout) {
      waited_ += timeout;
      if (waited_ > options_.player_patience) FailHung();
      return {.status = ReadStatus::kTimeout, .frame = {}};
    }
    waited_ = milliseconds{0};
    const ReaderMessage message = TakeMessage(ReaderKind::kFrame, FrameSize());
    if (message.kind == ReaderKind::kFrame) return TakeFrame();
    ended_ = true;
    return {.status = ReadStatus::kEnd, .frame = {}};
  }
  const Camera& camera() const override { return hello_.camera; }
  bool is_live() const override { return false; }
  std::optional<int64_t> frame_count() const override {
    return hello_.frame_count < 0 ? std::nullopt : std::optional(hello_.frame_count);
  }
  UnitStated unit() const { return hello_.is_unit_stated ? UnitStated::kYes : UnitStated::kNo; }

 private:
  size_t FrameSize() const {
    return sizeof(ReaderFrame) + sizeof(uint16_t) * static_cast<size_t>(hello_.camera.width) *
                                     static_cast<size_t>(hello_.camera.height);
  }

  // The next message that is not a note: one of this kind and size, or the end.
  ReaderMessage TakeMessage(ReaderKind wanted, size_t size) {
    for (;;) {
      ReaderMessage message;
      Take(&message, sizeof(message));
      if (message.magic != ReaderMessage::kMagic) FailHung();
      if (message.kind == ReaderKind::kEnd) return message;
      if (message.kind == wanted && message.size == size) return message;
      const std::string text = TakeText(message.size);
      const bool is_warning = message.kind == ReaderKind::kWarning;
      if (message.kind != ReaderKind::kNote && !is_warning) {
        ended_ = true;
        throw InputError(Place() + text);
      }
      if (options_.note) {
        options_.note(is_warning ? NoteKind::kWarning : NoteKind::kInfo, name_ + ": " + text);
      }
    }
  }

  ReadResult TakeFrame() {
    ReaderFrame head;
    Take(&head, sizeof(head));
    ReadResult result{.status = ReadStatus::kFrame, .frame = {}};
    result.frame.camera = hello_.camera;
    result.frame.depth_mm.resize((FrameSize() - sizeof(head)) / sizeof(uint16_t));
    Take(result.frame.depth_mm.data(), FrameSize() - sizeof(head));
    result.frame.index = next_frame_++;
    result.frame.time_s = head.time_s;
    return result;
  }

  std::string TakeText(uint64_t size) {
    constexpr uint64_t kLongest = 1000;  // characters, by hand
    std::string text(static_cast<size_t>(std::min(size, kLongest)), ' ');
    Take(text.data(), text.size());
    return text;
  }

  void Take(void* to, size_t size) {
    switch (child_.ReadExactly(to, size, options_.player_patience)) {
      case ChildProcess::Outcome::kRead:
        return;
      case ChildProcess::Outcome::kTimeout:
        FailHung();
      case ChildProcess::Outcome::kClosed:
        FailEnded(child_.Ending());
    }
  }

  [[noreturn]] void FailEnded(const std::string& ending) {
    ended_ = true;
    // What the loader of programs says where a library is missing.
    if (ending == "status 127") {
      throw InputError(name_ + ": to read such files install " + reader_.library);
    }
    throw InputError(Place() + reader_.library + " crashed on it (" + ending +
                     "): the recording is damaged");
  }

  [[noreturn]] void FailHung() {
    ended_ = true;
    throw InputError(Place() + reader_.library + " hangs on it: the recording is damaged");
  }

  std::string Place() const {
    return name_ + ": " +
           (next_frame_ > 0 ? "after frame " + std::to_string(next_frame_ - 1) + ": " : "");
  }

  Reader reader_;
  std::string name_;
  SourceOptions options_;
  ChildProcess child_;
  ReaderHello hello_;
  milliseconds waited_{0};
  int64_t next_frame_ = 0;
  bool ended_ = false;
};

std::unique_ptr<FrameSource> OpenWith(const Reader& reader, const std::string& name,
                                      const std::vector<std::string>& arguments,
                                      const SourceOptions& options) {
  auto source = std::make_unique<ReaderSource>(reader, name, arguments, options);
  const UnitStated unit = source->unit();
  return Prepared(name, std::move(source), unit, options);
}

}  // namespace

std::unique_ptr<FrameSource> OpenMkvFile(const fs::path& path, const SourceOptions& options) {
  return OpenWith({"ossa_mkv_reader", "libavformat59"}, path.string(),
                  {fs::absolute(path).string()}, options);
}

std::unique_ptr<FrameSource> OpenBagFile(const fs::path& path, const std::string& topic,
                                         const SourceOptions& options) {
  const std::string name = path.string() + (topic.empty() ? "" : "#" + topic);
  return OpenWith({"ossa_bag_reader", "librosbag-storage4d"}, name,
                  {fs::absolute(path).string(), topic}, options);
}

}  // namespace ossa::depth
