#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "depth/base/error.h"
#include "depth/sensor/openni2/runtime_folder.h"
#include "depth/sensor/readers/reader_pipe_internal.h"
#include "depth/sensor/recording_name_internal.h"
#include "depth/sensor/recording_pipe_internal.h"
#include "depth/sensor/sensor_clock.h"
#include "depth/sensor/source_internal.h"

namespace ossa::depth {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;

// The reader program of a file type, and the library that it needs.
struct Reader {
  const char* program;
  const char* library;   // Debian package
  fs::path folder = {};  // where a camera file may be; "": in none
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
        pipe_(name, {FindProgram(reader, name), arguments, reader.library},
              options.player_patience) {
    const ReaderMessage message = TakeMessage(ReaderKind::kHello, sizeof(ReaderHello));
    if (message.kind == ReaderKind::kEnd) {
      throw InputError(name_ + ": expected depth images, found none");
    }
    pipe_.Take(&hello_, sizeof(hello_));
    const int width = hello_.camera.width, height = hello_.camera.height;
    if (options.camera) {
      hello_.camera = ChosenCamera(options, width, height);
    } else if (!hello_.is_camera_stated) {
      const auto beside = reader.folder.empty()
                              ? std::nullopt
                              : CameraFileIn(reader.folder, {width, height}, options);
      hello_.camera = beside ? *beside : CameraByImageSize(name_, width, height, options);
    }
    CheckCamera(hello_.camera, name_ + ": camera");
  }

  ReadResult Read(milliseconds timeout) override {
    if (pipe_.ended()) return {.status = ReadStatus::kEnd, .frame = {}};
    if (!pipe_.Wait(timeout)) return {.status = ReadStatus::kTimeout, .frame = {}};
    const ReaderMessage message = TakeMessage(ReaderKind::kFrame, FrameSize());
    if (message.kind == ReaderKind::kFrame) return TakeFrame();
    pipe_.End();
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

  // The next message other than a note: one of this kind and size, or the end.
  ReaderMessage TakeMessage(ReaderKind wanted, size_t size) {
    for (;;) {
      ReaderMessage message;
      pipe_.Take(&message, sizeof(message));
      if (message.magic != ReaderMessage::kMagic) {
        pipe_.Fail(std::string(reader_.program) + " says of it what makes no sense: " +
                   reader_.library + " or the recording is damaged");
      }
      if (message.kind == ReaderKind::kEnd) return message;
      if (message.kind == wanted && message.size == size) return message;
      const std::string text = pipe_.TakeText(message.size);
      const bool is_warning = message.kind == ReaderKind::kWarning;
      if (message.kind != ReaderKind::kNote && !is_warning) pipe_.Fail(text);
      if (options_.note) {
        options_.note(is_warning ? NoteKind::kWarning : NoteKind::kInfo, name_ + ": " + text);
      }
    }
  }

  ReadResult TakeFrame() {
    ReaderFrame head;
    pipe_.Take(&head, sizeof(head));
    ReadResult result{.status = ReadStatus::kFrame, .frame = {}};
    result.frame.camera = hello_.camera;
    result.frame.depth_mm.resize((FrameSize() - sizeof(head)) / sizeof(uint16_t));
    pipe_.Take(result.frame.depth_mm.data(), FrameSize() - sizeof(head));
    result.dropped = head.dropped;
    result.frame.index = pipe_.next_frame() + head.dropped;
    result.frame.time_s = clock_.TimeOf(head.time_s);
    pipe_.RecordFrame(result.frame.index);
    return result;
  }

  Reader reader_;
  std::string name_;
  SourceOptions options_;
  RecordingPipe pipe_;
  ReaderHello hello_;
  SensorClock clock_;
};

std::unique_ptr<FrameSource> OpenWith(const Reader& reader, const std::string& name,
                                      const std::vector<std::string>& arguments,
                                      const SourceOptions& options) {
  if (!fs::is_regular_file(arguments.front())) {
    throw InputError(name + ": expected a recording, found a pipe or a device");
  }
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

std::unique_ptr<FrameSource> OpenArrayFile(const fs::path& path, const std::string& array,
                                           const SourceOptions& options) {
  const std::string name = path.string() + (array.empty() ? "" : "#" + array);
  const fs::path whole = fs::absolute(path);
  return OpenWith({"ossa_array_reader", "libmatio11", whole.parent_path()}, name,
                  {whole.string(), array}, options);
}

std::unique_ptr<FrameSource> OpenRos2Bag(const fs::path& path, const std::string& topic,
                                         const SourceOptions& options) {
  const std::string name = path.string() + (topic.empty() ? "" : "#" + topic);
  std::vector<std::string> arguments;
  for (const fs::path& file : ListRos2Files(path)) arguments.push_back(fs::absolute(file).string());
  arguments.push_back(topic);
  return OpenWith({"ossa_rosbag2_reader", "libsqlite3-0"}, name, arguments, options);
}

}  // namespace ossa::depth
