// Sources of depth images, for ossa_c.h.
#include <algorithm>
#include <chrono>
#include <deque>
#include <functional>
#include <memory>
#include <string>

#include "depth/base/error.h"
#include "depth/base/one_line.h"
#include "depth/image/camera_io.h"
#include "depth/sensor/depth_coding.h"
#include "depth/sensor/frame_source.h"
#include "tools/tracker/c_interface_internal.h"
#include "tools/tracker/c_tracker_internal.h"
#include "tools/tracker/camera_search.h"

struct ossa_source {
  struct Note {
    ossa::depth::NoteKind kind;
    std::string text;
  };

  std::unique_ptr<ossa::depth::FrameSource> frames;
  ossa::depth::DepthFrame last;  // owns what the caller reads
  std::deque<Note> notes;        // not taken yet
  std::string taken_note;        // owns what the caller reads
  std::function<bool()> keep_waiting;
  int64_t dropped = 0;
};

namespace {

using ossa::tracker::ReadStruct;
using ossa::tracker::TextOr;
using std::chrono::duration;
using std::chrono::duration_cast;
using std::chrono::milliseconds;

// Far beyond any use, by hand: a wait of eleven days, depth units of a micrometre.
constexpr double kMost = 1e6;

void RequireInRange(double value, const char* member) {
  if (value >= 0 && value <= kMost) return;
  throw std::invalid_argument("ossa_source_options." + std::string(member) +
                              ": expected 0 to 1e6, found " + std::to_string(value));
}

// Without a callback: always continue.
std::function<bool()> KeepWaitingOf(const ossa_source_options& options) {
  if (options.keep_waiting == nullptr) return [] { return true; };
  return [ask = options.keep_waiting, user = options.keep_waiting_user] { return ask(user) != 0; };
}

ossa::depth::SourceOptions OptionsFrom(const ossa_source_options* given) {
  ossa::depth::SourceOptions options;
  options.keep_waiting = KeepWaitingOf({});
  if (given == nullptr) return options;
  const auto c = ReadStruct(*given);
  options.keep_waiting = KeepWaitingOf(c);
  if (c.camera != nullptr) options.camera = ossa::depth::ParseCamera(c.camera);
  RequireInRange(c.depth_scale, "depth_scale");
  RequireInRange(c.fps, "fps");
  RequireInRange(c.wait_s, "wait_s");
  if (c.depth_scale > 0) options.depth_scale = c.depth_scale;
  if (c.fps > 0) options.fps = c.fps;
  options.device_wait = duration_cast<milliseconds>(duration<double>(c.wait_s));
  const auto coding = ossa::depth::ParseDepthFormat(TextOr(c.depth_format, "plain"));
  options.depth_format = coding.format;
  options.inverted_from = coding.inverted_from;
  options.mirrored = c.mirrored != 0;
  return options;
}

ossa_depth_image ImageFrom(const ossa::depth::DepthFrame& frame) {
  ossa_depth_image image{};
  image.width = frame.camera.width;
  image.height = frame.camera.height;
  image.fx = frame.camera.fx;
  image.fy = frame.camera.fy;
  image.cx = frame.camera.cx;
  image.cy = frame.camera.cy;
  image.depth_mm = frame.depth_mm.data();
  image.time_s = frame.time_s;
  return image;
}

using Notes = std::deque<ossa_source::Note>;

// Errors are ignored here: opening the source reports them again.
void FindCamera(const std::string& name, ossa::depth::SourceOptions& options, Notes& notes) {
  if (options.camera) return;
  ossa::depth::SourceOptions silent = options;
  silent.note = {};
  try {
    const auto finding = ossa::tracker::FindNarrowerCamera(
        name, silent, [] { return ossa::tracker::TrackerOptions(); }, options.keep_waiting);
    if (!finding) return;
    options.camera = ossa::depth::ParseCamera(ossa::tracker::CameraText(finding->found));
    notes.push_back(
        {ossa::depth::NoteKind::kInfo, ossa::OnOneLine(name + ": " + Describe(*finding))});
  } catch (const ossa::InputError&) {
  }
}

std::unique_ptr<ossa_source> Opened(const std::string& name, const ossa_source_options* given) {
  auto source = std::make_unique<ossa_source>();
  ossa::depth::SourceOptions options = OptionsFrom(given);
  options.note = [&notes = source->notes](ossa::depth::NoteKind kind, const std::string& text) {
    notes.push_back({kind, ossa::OnOneLine(text)});
  };
  if (given != nullptr && ReadStruct(*given).find_camera != 0) {
    FindCamera(name, options, source->notes);
  }
  source->keep_waiting = options.keep_waiting;
  source->frames = ossa::depth::OpenSource(name, options);
  return source;
}

// In steps, between which the caller may end the wait.
ossa::depth::ReadResult Read(ossa_source& source, milliseconds timeout) {
  using ossa::depth::ReadStatus;
  constexpr milliseconds kStep{100};  // as while a device is waited for
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  for (;;) {
    const auto left = deadline - std::chrono::steady_clock::now();
    const auto step = std::clamp(duration_cast<milliseconds>(left), milliseconds{0}, kStep);
    auto read = source.frames->Read(step);
    source.dropped += read.dropped;
    const bool is_waiting =
        read.status == ReadStatus::kTimeout || read.status == ReadStatus::kDisconnected;
    if (!is_waiting || left <= kStep || !source.keep_waiting()) return read;
  }
}

ossa_status StatusOf(ossa::depth::ReadStatus status) {
  using ossa::depth::ReadStatus;
  if (status == ReadStatus::kFrame) return OSSA_OK;
  return status == ReadStatus::kEnd ? OSSA_END : OSSA_TIMEOUT;
}

}  // namespace

ossa::depth::FrameSource& ossa::tracker::FramesOf(ossa_source& source) { return *source.frames; }

const std::function<bool()>& ossa::tracker::KeepWaitingFor(const ossa_source& source) {
  return source.keep_waiting;
}

ossa_source* ossa_source_open(const char* source, const ossa_source_options* options) {
  ossa_source* opened = nullptr;
  ossa::tracker::Guarded([&] {
    ossa::tracker::RequireNotNull(source, "ossa_source_open", "a source");
    opened = Opened(source, options).release();
    return OSSA_OK;
  });
  return opened;
}

void ossa_source_close(ossa_source* source) { delete source; }

ossa_status ossa_source_read(ossa_source* source, int32_t timeout_ms, ossa_depth_image* image) {
  return ossa::tracker::Guarded([&] {
    ossa::tracker::RequireNotNull(source, "ossa_source_read", "a source");
    ossa::tracker::RequireNotNull(image, "ossa_source_read", "an image");
    ossa::tracker::CheckSize(*image);  // before a frame is taken
    auto read = Read(*source, milliseconds(std::max(0, timeout_ms)));
    if (read.status == ossa::depth::ReadStatus::kFrame) {
      source->last = std::move(read.frame);
      ossa::tracker::FillStruct(ImageFrom(source->last), image);
    }
    return StatusOf(read.status);
  });
}

const char* ossa_source_take_note(ossa_source* source, int32_t* kind) {
  if (source == nullptr || source->notes.empty()) return nullptr;
  const bool is_warning = source->notes.front().kind == ossa::depth::NoteKind::kWarning;
  source->taken_note = std::move(source->notes.front().text);
  source->notes.pop_front();
  if (kind != nullptr) *kind = is_warning ? OSSA_NOTE_WARNING : OSSA_NOTE_INFO;
  return source->taken_note.c_str();
}

int64_t ossa_source_frame_count(const ossa_source* source) {
  return source == nullptr ? -1 : source->frames->frame_count().value_or(-1);
}

int64_t ossa_source_dropped(const ossa_source* source) {
  return source == nullptr ? 0 : source->dropped;
}
