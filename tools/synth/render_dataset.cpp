#include "tools/synth/render_dataset.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <atomic>
#include <cstdio>
#include <exception>
#include <fstream>
#include <mutex>
#include <sstream>
#include <thread>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "depth/base/leftovers.h"
#include "depth/image/depth_png.h"
#include "tools/synth/manifest_internal.h"
#include "tools/synth/shard_internal.h"

namespace ossa::tools {
namespace {

namespace fs = std::filesystem;

// Frames of a shard file, the unit of work and of resuming: small, so that threads end together.
constexpr int64_t kFramesPerChunk = 64;  // by hand

int64_t ChunkCount(const RenderJob& job) {
  return (job.frames + kFramesPerChunk - 1) / kFramesPerChunk;
}

std::string Numbered(int64_t number, const char* extension) {
  char name[40];
  std::snprintf(name, sizeof(name), "%06lld%s", static_cast<long long>(number), extension);
  return name;
}

fs::path WorkFolder(const RenderJob& job) { return job.out / kWorkFolder; }
fs::path TruthChunk(const RenderJob& job, int64_t chunk) {
  return WorkFolder(job) / Numbered(chunk, ".jsonl");
}

void WriteText(const fs::path& path, const std::string& text) {
  AtomicFile file(path);
  file.stream() << text;
  file.Commit();
}

std::string ReadText(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

// Motion files may change between two runs of one command, so the digest covers their content.
std::string DigestOf(const std::vector<recon::RigPose>& poses) {
  const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(XXH3_createState(),
                                                                       XXH3_freeState);
  XXH3_64bits_reset(state.get());
  for (const recon::RigPose& pose : poses) {
    XXH3_64bits_update(state.get(), pose.root_m.data(), sizeof(pose.root_m));
    for (const Eigen::Quaterniond& rotation : pose.world_from_rest) {
      XXH3_64bits_update(state.get(), rotation.coeffs().data(), sizeof(rotation.coeffs()));
    }
  }
  return fmt::format("{:016x}", XXH3_64bits_digest(state.get()));
}

DatasetManifest MakeManifest(const FrameInputs& inputs, const RenderJob& job) {
  DatasetManifest manifest;
  manifest.frames = job.frames;
  manifest.camera = MakeCamera(inputs.options);
  manifest.seed = inputs.options.seed;
  manifest.command = job.command;
  manifest.split = inputs.options.split == Split::kTest ? "test" : "train";
  manifest.view = NameOf(inputs.options.view);
  manifest.sources = job.sources;
  manifest.motion = DigestOf(inputs.poses);
  manifest.ossa = job.ossa;
  manifest.terms = job.terms;
  manifest.png = job.png;
  manifest.packed = job.packed;
  manifest.frames_per_shard = kFramesPerChunk;
  return manifest;
}

void MakeFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw InputError(folder.string() + ": cannot be made: " + error.message());
}

// Reserves the folder for this job. Throws InputError if it is reserved for another.
void PrepareFolder(const RenderJob& job, const std::string& plan) {
  const fs::path manifest = job.out / "manifest.json";
  const fs::path started = WorkFolder(job) / kPlanFile;
  for (const fs::path& path : {manifest, started}) {
    if (fs::exists(path) && ReadText(path) != plan) {
      const std::string found = CommandIn(ReadText(path));
      throw InputError(path.string() + ": another data set is there: expected " + job.command +
                       " or an empty folder, found " +
                       (found == job.command ? "what other motion or another ossa made" : found));
    }
  }
  if (fs::exists(manifest)) return;
  if (!fs::exists(started) && fs::exists(job.out) && !fs::is_empty(job.out)) {
    // Other ranks of this job may have begun: only foreign files are an error.
    for (const auto& entry : fs::directory_iterator(job.out)) {
      if (entry.path().filename() == kWorkFolder) continue;
      throw InputError(job.out.string() + ": expected an empty folder, found " +
                       entry.path().filename().string());
    }
  }
  MakeFolder(WorkFolder(job));
  WriteText(started, plan);
  if (job.packed) MakeFolder(job.out / "shards");
  if (!job.png) return;
  for (const char* kind : {"depth", "parts", "users"}) MakeFolder(job.out / kind);
}

void WritePngs(const RenderJob& job, const depth::Camera& whole, const LabelledFrame& crop) {
  const LabelledFrame frame = Uncropped(crop, whole);
  const std::string name = Numbered(frame.depth.index, ".png");
  depth::WriteDepthPng(job.out / "depth" / name, frame.depth.view());
  depth::WriteLabelPng(job.out / "parts" / name, frame.parts);
  depth::WriteLabelPng(job.out / "users" / name, frame.users);
}

bool ChunkIsThere(const RenderJob& job, int64_t chunk) {
  return (!job.png || fs::exists(TruthChunk(job, chunk))) &&
         (!job.packed || fs::exists(ShardPath(job.out, chunk)));
}

// Returns false if interrupted: then the chunk is not finished.
bool RenderChunk(const RenderJob& job, const depth::Camera& whole, int64_t chunk, FrameMaker* maker,
                 std::atomic<int64_t>* done) {
  const int64_t first = chunk * kFramesPerChunk;
  const int64_t end = std::min(first + kFramesPerChunk, job.frames);
  std::vector<std::vector<uint8_t>> blobs;
  std::string truth;
  for (int64_t index = first; index < end; ++index) {
    if (job.interrupted()) return false;
    const LabelledFrame frame = maker->Make(index);
    if (job.packed) blobs.push_back(PackFrame(frame));
    if (job.png) {
      WritePngs(job, whole, frame);
      truth += TruthLine(frame) + "\n";
    }
    ++*done;
  }
  if (job.packed) WriteShard(ShardPath(job.out, chunk), first, blobs);
  if (job.png) WriteText(TruthChunk(job, chunk), truth);
  return true;
}

void JoinTruth(const RenderJob& job) {
  AtomicFile truth(job.out / "truth.jsonl");
  for (int64_t chunk = 0; chunk < ChunkCount(job); ++chunk) {
    const std::string text = ReadText(TruthChunk(job, chunk));
    if (text.empty()) throw InputError(TruthChunk(job, chunk).string() + ": is missing or empty");
    truth.stream() << text;
  }
  truth.Commit();
}

// This rank's unfinished chunks; counts the frames of the finished ones.
std::vector<int64_t> FindChunksToMake(const RenderJob& job, std::atomic<int64_t>* done) {
  std::vector<int64_t> chunks;
  for (int64_t chunk = job.rank; chunk < ChunkCount(job); chunk += job.ranks) {
    if (ChunkIsThere(job, chunk)) {
      *done += std::min(kFramesPerChunk, job.frames - chunk * kFramesPerChunk);
    } else {
      chunks.push_back(chunk);
    }
  }
  return chunks;
}

// Threads that render chunks one after another. The first failure stops all of them.
class ChunkWorkers {
 public:
  ChunkWorkers(const FrameInputs& inputs, const RenderJob& job)
      : inputs_(inputs), job_(job), camera_(MakeCamera(inputs.options)) {}

  RenderEnd Run() {
    chunks_ = FindChunksToMake(job_, &done_);
    const auto count = std::clamp(static_cast<size_t>(std::max(1, job_.threads)), size_t{1},
                                  std::max<size_t>(1, chunks_.size()));
    running_ = static_cast<int>(count);
    std::vector<std::jthread> threads;
    for (size_t t = 0; t < count; ++t) threads.emplace_back([this] { RenderChunks(); });
    while (running_ > 0) {
      job_.progress(done_);
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    threads.clear();
    if (failure_) std::rethrow_exception(failure_);
    if (stopped_) return RenderEnd::kInterrupted;
    job_.progress(done_);
    return RenderEnd::kDone;
  }

 private:
  void RenderChunks() {
    try {
      FrameMaker maker(inputs_);
      for (size_t k = next_++; k < chunks_.size() && !stopped_; k = next_++) {
        if (!RenderChunk(job_, camera_, chunks_[k], &maker, &done_)) stopped_ = true;
      }
    } catch (...) {
      const std::lock_guard lock(failure_mutex_);
      if (!failure_) failure_ = std::current_exception();
      stopped_ = true;
    }
    --running_;
  }

  const FrameInputs& inputs_;
  const RenderJob& job_;
  depth::Camera camera_;
  std::vector<int64_t> chunks_;
  std::atomic<int64_t> done_ = 0;  // frames
  std::atomic<size_t> next_ = 0;
  std::atomic<int> running_ = 0;
  std::atomic<bool> stopped_ = false;
  std::exception_ptr failure_;
  std::mutex failure_mutex_;
};

}  // namespace

RenderEnd RenderShare(const FrameInputs& inputs, const RenderJob& job) {
  PrepareFolder(job, ManifestToJson(MakeManifest(inputs, job)));
  if (fs::exists(job.out / "manifest.json")) return RenderEnd::kDone;
  return ChunkWorkers(inputs, job).Run();
}

void FinishDataset(const FrameInputs& inputs, const RenderJob& job) {
  if (!fs::exists(job.out / "manifest.json")) {
    if (job.png) JoinTruth(job);
    RemoveLeftovers(job.out);  // of killed runs; their chunks were rendered again
    SyncFiles(job.out);        // a manifest promises that all files are complete
    WriteText(job.out / "manifest.json", ManifestToJson(MakeManifest(inputs, job)));
  }
  std::error_code ignored;
  fs::remove_all(WorkFolder(job), ignored);
}

}  // namespace ossa::tools
