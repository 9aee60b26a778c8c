#include "tools/commands/track_several.h"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "depth/sensor/frame_source.h"
#include "recon/fuse/extrinsics.h"
#include "tools/commands/command.h"
#include "tools/commands/posture_record.h"
#include "tools/commands/warnings.h"
#include "tools/tracker/tracker.h"

namespace ossa::commands {
namespace {

/// One recording during tracking.
struct Camera {
  SourceArguments arguments;
  std::unique_ptr<depth::FrameSource> source;
  std::unique_ptr<tracker::Tracker> tracker;
  recon::SkeletonSequence skeletons;
  std::atomic<int64_t> frames = 0;
  std::atomic<bool> done = false;
  std::string failure;  // "" if there was none
};
using Cameras = std::vector<std::unique_ptr<Camera>>;

std::unique_ptr<Camera> OpenCamera(const TrackOptions& options, const std::string& name) {
  auto camera = std::make_unique<Camera>();
  camera->arguments = options.source;
  camera->arguments.name = name;
  camera->arguments.printed = std::make_shared<std::set<std::string>>();  // one per thread
  camera->skeletons.source = name;
  FindCamera(
      camera->arguments, [&] { return options.tracker; }, options.quiet);
  camera->source = OpenSource(camera->arguments, options.quiet);
  camera->tracker = std::make_unique<tracker::Tracker>(options.tracker);
  FindUpright(*camera->tracker, *camera->source, camera->arguments, options.quiet);
  return camera;
}

std::optional<int64_t> FramesOf(const Camera& camera, const TrackOptions& options) {
  const std::optional<int64_t> known = camera.source->frame_count();
  return options.frames == 0 ? known : std::min(options.frames, known.value_or(options.frames));
}

// Runs in its own thread. Of a damaged recording the frames before the damage are kept.
void TrackCamera(Camera& camera, const TrackOptions& options) {
  const PostureRecorder recorder(options);
  try {
    camera.tracker->Run(
        *camera.source,
        [&](const tracker::BodyFrame& bodies) {
          camera.skeletons.frames.push_back(recorder.Record(bodies));
          return !Interrupted() && ++camera.frames != options.frames;
        },
        [] { return !Interrupted(); });
  } catch (const std::exception& error) {
    camera.failure = error.what();
  }
  camera.done = true;
}

void ShowProgress(const Cameras& cameras, const TrackOptions& options) {
  constexpr std::chrono::milliseconds kPause(50);  // by hand
  Progress progress("tracking", options.quiet);
  double total = 0.0;
  for (const auto& camera : cameras) {
    total += static_cast<double>(FramesOf(*camera, options).value_or(0));
  }
  for (bool all_done = false; !all_done; std::this_thread::sleep_for(kPause)) {
    double frames = 0.0;
    all_done = true;
    for (const auto& camera : cameras) {
      frames += static_cast<double>(camera->frames);
      all_done = all_done && camera->done;
    }
    if (total > 0.0) progress.Update(frames, total);
  }
}

void TrackCameras(const Cameras& cameras, const TrackOptions& options) {
  std::vector<std::jthread> threads;
  for (const auto& camera : cameras) {
    threads.emplace_back([&camera = *camera, &options] { TrackCamera(camera, options); });
  }
  ShowProgress(cameras, options);
}

std::vector<recon::SkeletonSequence> TakeSkeletons(const Cameras& cameras) {
  std::vector<recon::SkeletonSequence> recordings;
  for (const auto& camera : cameras) recordings.push_back(std::move(camera->skeletons));
  return recordings;
}

void CheckFramesCame(const Cameras& cameras, std::span<const recon::SkeletonSequence> recordings) {
  for (size_t k = 0; k < cameras.size(); ++k) {
    if (!recordings[k].frames.empty()) continue;
    if (!cameras[k]->failure.empty()) throw InputError(cameras[k]->failure);
    throw InputError(cameras[k]->arguments.name +
                     (Interrupted() ? ": interrupted before the first frame" : ": no frame came"));
  }
}

// "" on success.
std::string TryWriteSkeletons(const std::filesystem::path& file,
                              const recon::SkeletonSequence& recording) {
  try {
    std::filesystem::create_directories(FolderOf(file));
    WriteSkeletonsThatFit(file, recording, {});
    return "";
  } catch (const std::exception& failure) {
    return failure.what();
  }
}

// Writes each camera's own skeletons into a folder beside the output, under the camera's name in
// `ossa fuse --extrinsics`, so that long tracking is not lost if fusion fails. Prints the folder.
std::string WriteUnfused(const TrackOptions& options,
                         std::span<const recon::SkeletonSequence> recordings) {
  std::filesystem::path folder = options.out.empty() ? options.fuse.save_extrinsics : options.out;
  folder.replace_extension(".cameras");
  const std::vector<std::string> names = recon::CameraNames(options.Sources());
  std::string kept, failures;
  for (size_t k = 0; k < recordings.size(); ++k) {
    if (recordings[k].frames.empty()) continue;
    const std::string file = folder / (names[k] + ".jsonl");
    const std::string why_not = TryWriteSkeletons(file, recordings[k]);
    if (why_not.empty()) kept += (kept.empty() ? "" : ", ") + file;
    if (!why_not.empty()) failures += "; " + why_not;
  }
  if (kept.empty()) return "nothing was written" + failures;
  return "what each camera tracked is in " + kept + ", which `ossa fuse` reads" + failures;
}

// Why frames are missing, to be printed before their number; "" if all are there.
std::string DescribeInterruption(const Cameras& cameras, const TrackOptions& options,
                                 int64_t frames) {
  for (const auto& camera : cameras) {
    if (!camera->failure.empty()) return camera->failure + "; ";
  }
  const Camera& first = *cameras.front();
  if (!Interrupted() || frames == FramesOf(first, options)) return "";
  return first.arguments.name + ": interrupted: ";
}

// If too few frames came to find the extrinsics, that is reported instead.
std::string DescribeFusionFailure(const TrackOptions& options, const Cameras& cameras,
                                  int64_t frames, const std::string& failure) {
  const std::string why = frames == 0 ? "" : DescribeInterruption(cameras, options, frames);
  if (why.empty()) return failure;
  const std::string of_all = FramesText(frames, FramesOf(*cameras.front(), options));
  return fmt::format("{}{} were tracked: {}", why, of_all, failure);
}

FusedRecordings FuseOrKeep(const TrackOptions& options, const Cameras& cameras,
                           std::span<const recon::SkeletonSequence> recordings) {
  try {
    CheckFramesCame(cameras, recordings);
    return FuseRecordings(options.fuse, options.Sources(), recordings, options.quiet);
  } catch (const std::exception& failure) {
    const auto frames = static_cast<int64_t>(recordings.front().frames.size());
    const std::string why = DescribeFusionFailure(options, cameras, frames, failure.what());
    throw InputError(fmt::format("{}; {}", why, WriteUnfused(options, recordings)));
  }
}

// After the available results were written.
void ReportMissingFrames(const Cameras& cameras, const TrackOptions& options, int64_t frames) {
  const std::string why = DescribeInterruption(cameras, options, frames);
  if (why.empty()) return;
  throw InputError(why + FramesText(frames, FramesOf(*cameras.front(), options)) +
                   (options.out.empty() ? " were tracked" : " are in " + options.out));
}

}  // namespace

int TrackSeveral(const TrackOptions& options) {
  const auto write = options.write.For(options.out);
  Cameras cameras;
  for (const std::string& name : options.Sources()) cameras.push_back(OpenCamera(options, name));
  TrackCameras(cameras, options);
  for (const auto& camera : cameras) {
    PrintWarning("track", camera->arguments.name, *camera->tracker);
  }
  const auto fused = FuseOrKeep(options, cameras, TakeSkeletons(cameras));
  PrintWarnings("track", fused.skeletons.warnings);
  WriteFused("track", options.fuse, options.out, fused, write);
  const size_t frames = fused.skeletons.frames.size();
  ReportMissingFrames(cameras, options, static_cast<int64_t>(frames));
  if (!options.quiet) fmt::print("{} frames of {} cameras\n", frames, cameras.size());
  return 0;
}

}  // namespace ossa::commands
