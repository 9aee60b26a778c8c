#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <string>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "depth/sensor/fakenect_dump.h"
#include "depth/sensor/frame_source.h"
#include "depth/sensor/oni_recorder.h"
#include "tools/commands/checks.h"
#include "tools/commands/command.h"
#include "tools/commands/commands.h"
#include "tools/commands/outputs.h"
#include "tools/commands/process.h"
#include "tools/commands/source_options.h"

namespace ossa::commands {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

// Constants: 30 Hz, a Kinect SDK's rate; by hand.

constexpr double kPeriod_s = 1.0 / 30.0;

struct RecordOptions {
  SourceArguments source;
  std::string out;
  double seconds = 0.0;  // 0: to the end, or Ctrl-C
  bool fakenect = false;
  bool quiet = false;
};

enum class Ending { kComplete, kUnplugged, kSilent, kInterrupted };

struct Recorded {
  int64_t frames = 0;
  int64_t dropped = 0;
  std::optional<int64_t> of;  // frames to record
  double seconds = 0.0;       // from the start of the first frame to the end of the last
  Ending ending = Ending::kComplete;
};

RecordOptions ParseOptions(int argc, char** argv) {
  CLI::App app(
      "Record any SOURCE to an .oni file that OpenNI2, NiViewer and ossa play bit for bit");
  RecordOptions options;
  AddSourceOptions(app, options.source);
  app.add_option("--out", options.out, "the recording, FILE.oni, or a folder with --fakenect")
      ->required();
  app.add_option("--seconds", options.seconds,
                 "stop after this time (default: at the end, or Ctrl-C)")
      ->check(Positive());
  AddDeviceOptions(app, options.source);
  app.add_flag(
      "--fakenect", options.fakenect,
      "write a dump that libfreenect's fakenect plays as a Kinect v1; --out is its folder");
  app.add_flag("--quiet", options.quiet, "no progress");
  Parse(app, argc, argv);
  if (!options.fakenect) CheckExtension("--out", options.out, ".oni");
  CheckOutputs({options.out}, {options.source.name});
  PrintUnreadDeviceOptions(app, options.source, options.quiet);
  if (app.count("--rotate") > 0 && !options.quiet) {
    PrintError("ossa: --rotate is not read by record: images are recorded as they are\n");
  }
  return options;
}

std::optional<int64_t> FramesWanted(const depth::FrameSource& source,
                                    const RecordOptions& options) {
  const std::optional<int64_t> known = source.frame_count();
  if (!(options.seconds > 0)) return known;
  const int64_t asked = std::llround(options.seconds / kPeriod_s);
  return std::min(asked, known.value_or(asked));
}

// Records frames until the source ends, the time is over, Ctrl-C, or a device does not come back.
template <typename Recorder>
void RecordFrames(depth::FrameSource& source, const RecordOptions& options, Recorder& recorder,
                  Recorded& recorded) {
  Progress progress("recording", options.quiet);
  auto last_frame_at = Clock::now();
  std::optional<double> first_time_s;
  recorded.of = FramesWanted(source, options);
  const auto total = static_cast<double>(recorded.of.value_or(0));
  while (!Interrupted()) {
    const depth::ReadResult result = source.Read(milliseconds(100));
    recorded.dropped += result.dropped;
    if (result.status == depth::ReadStatus::kEnd) return;
    if (result.status == depth::ReadStatus::kFrame) {
      last_frame_at = Clock::now();
      if (!first_time_s) first_time_s = result.frame.time_s;
      recorder.Write(result.frame);
      ++recorded.frames;
      recorded.seconds = result.frame.time_s - *first_time_s + kPeriod_s;
      if (total > 0) progress.Update(static_cast<double>(recorded.frames), total, "frames");
      if (options.seconds > 0 && recorded.seconds > options.seconds - kPeriod_s / 2) return;
    } else if (source.is_live() &&
               Clock::now() - last_frame_at > Milliseconds(options.source.patience_s)) {
      recorded.ending =
          result.status == depth::ReadStatus::kDisconnected ? Ending::kUnplugged : Ending::kSilent;
      return;
    }
  }
  const bool has_end = !source.is_live() && recorded.frames != recorded.of;
  if (has_end) recorded.ending = Ending::kInterrupted;
}

// A disconnected device ends a recording; that is a failure only if it was to be longer.
int Report(const RecordOptions& options, const Recorded& recorded) {
  const std::string summary = fmt::format("{}: {} frames, {:.1f} s, {} dropped", options.out,
                                          recorded.frames, recorded.seconds, recorded.dropped);
  constexpr double kNearEnough_s = 0.1;
  const bool complete =
      recorded.ending == Ending::kComplete ||
      (recorded.ending == Ending::kUnplugged && recorded.seconds > options.seconds - kNearEnough_s);
  if (recorded.ending == Ending::kInterrupted) {
    throw InputError(fmt::format("{}: interrupted: {} are in {}", options.source.name,
                                 FramesText(recorded.frames, recorded.of), options.out));
  }
  if (!complete) {
    const char* what = recorded.ending == Ending::kUnplugged ? "unplugged" : "delivers no frames";
    throw InputError(fmt::format("{}: the device {} for {:g} s: the recording ends early ({})",
                                 options.source.name, what, options.source.patience_s, summary));
  }
  if (!options.quiet) fmt::print("{}\n", summary);
  return 0;
}

// The frames before one that cannot be read or recorded are kept.
template <typename Recorder>
int RecordTo(Recorder& recorder, depth::FrameSource& source, const RecordOptions& options) {
  Recorded recorded;
  try {
    RecordFrames(source, options, recorder, recorded);
  } catch (const DiskFull&) {
    throw;  // nothing more can be written
  } catch (const InputError& error) {
    if (recorded.frames == 0) throw;
    recorder.Finish();
    throw InputError(fmt::format("{}; the {} frames before it are in {}", error.what(),
                                 recorded.frames, options.out));
  }
  if (recorded.frames == 0) throw InputError(options.source.name + ": no frame came");
  recorder.Finish();
  return Report(options, recorded);
}

// On a full disk the frames recorded so far are kept, as far as they and the recording's end fit.
template <typename Recorder>
int RecordWhatFits(Recorder recorder, depth::FrameSource& source, const RecordOptions& options) {
  try {
    return RecordTo(recorder, source, options);
  } catch (const DiskFull& full) {
    const int64_t frames = recorder.frame_count();
    throw MakeKeptError(full, recorder.FinishWithWhatFits(), frames);
  }
}

}  // namespace

int Record(int argc, char** argv) {
  const RecordOptions options = ParseOptions(argc, argv);
  const auto source = OpenSource(options.source, options.quiet);
  const depth::Camera& camera = source->camera();
  if (options.fakenect) {
    return RecordWhatFits(depth::FakenectDump(options.out, camera), *source, options);
  }
  AtomicFile::CheckWritable(options.out);
  PrintLeftovers(options.out);
  return RecordWhatFits(depth::OniRecorder(options.out, camera), *source, options);
}

}  // namespace ossa::commands
