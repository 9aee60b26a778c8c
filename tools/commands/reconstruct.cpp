#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "depth/base/lower_case.h"
#include "recon/database/posture_database.h"
#include "recon/filters/butterworth.h"
#include "recon/methods/reconstruct_sequence.h"
#include "tools/commands/command.h"
#include "tools/commands/commands.h"
#include "tools/commands/outputs.h"
#include "tools/commands/process.h"
#include "tools/commands/reading_bar.h"
#include "tools/commands/reconstruct_options.h"
#include "tools/commands/warnings.h"
#include "tools/tracker/dynamics.h"
#include "tools/tracker/mechanics.h"
#include "tools/tracker/scene.h"
#include "tools/tracker/shipped.h"

namespace ossa::commands {
namespace {

/// The correction for the recordings' sensor: the named file; else, for methods that use a
/// correction, the shipped one if all recordings are of one known sensor.
std::string FindLearnedFile(const ReconstructArguments& a,
                            const std::vector<recon::SkeletonClip>& clips) {
  if (a.files.learned == "none" || !ReadsLearned(a.options.method)) return {};
  const bool is_correction = RequireMethodInfo(a.options.method).learned == recon::Reads::kOptional;
  if (!a.files.learned.empty() || !is_correction) return a.files.learned;
  const std::string sensor = clips.empty() ? "" : clips.front().sequence.sensor;
  const tracker::KnownSensor* known = tracker::FindKnownSensor(sensor);
  const bool all = std::all_of(clips.begin(), clips.end(), [&sensor](const auto& clip) {
    return clip.sequence.sensor == sensor;
  });
  if (known == nullptr || !all) return {};
  if (!a.quiet) {
    PrintError(
        fmt::format("reconstruct: {}: known errors are corrected ({}; not with --learned none)\n",
                    known->description, known->correction));
  }
  return tracker::ShippedFile(known->correction).string();
}

/// Whether --out is a folder: for several recordings, and for one in a folder or archive if --out
/// has no extension. Throws UsageError for several recordings and a name with an extension.
bool IsOutputFolder(const ReconstructArguments& a, const std::vector<recon::SkeletonClip>& clips) {
  const std::filesystem::path out(a.out);
  if (clips.size() == 1) return out.extension().empty() && !clips[0].name.empty();
  for (const char* one : {".jsonl", ".bvh", ".glb", ".trc", ".csv"}) {
    if (LowerCaseExtension(out) != one) continue;
    throw UsageError(fmt::format("{}: expected a folder for {} recordings, as {} and {}", a.out,
                                 clips.size(), clips[0].name, clips[1].name));
  }
  return true;
}

/// Checked before the work: one file holds one recording.
void CheckDynamicsOf(const ReconstructArguments& a, size_t recordings) {
  if (a.dynamics.empty()) return;
  if (recordings > 1) {
    throw UsageError(fmt::format("--dynamics: expected one recording, found {}", recordings));
  }
  AtomicFile::CheckWritable(a.dynamics);
}

/// Simulates all people of a recording in one world. `update`: as FollowMechanically's progress.
void PlayScene(const tracker::SceneOptions& options, recon::SkeletonSequence& sequence,
               const ReconstructArguments& a, const std::function<bool(size_t)>& update) {
  tracker::Scene scene(options);
  size_t done = 0;
  for (recon::SkeletonFrame& frame : sequence.frames) {
    scene.Play(frame);
    if (!update(++done)) return;
  }
  if (scene.has_floor() || options.objects.empty()) return;
  PrintError(
      fmt::format("ossa reconstruct: {}: the recording has no floor, so that no object appeared: "
                  "expected floor = [a, b, c, d] in the file, or --floor\n",
                  a.mechanics.scene));
}

InputError InterruptedEarly(const ReconstructArguments& a, size_t written, size_t total) {
  if (written == 0) return InputError("reconstruct: interrupted; nothing was written");
  return InputError(
      fmt::format("{}: interrupted: {} are in {}", a.skeletons,
                  FramesText(static_cast<int64_t>(written), static_cast<int64_t>(total)), a.out));
}

std::vector<recon::SkeletonClip> ReadClips(ReconstructArguments& a) {
  a.read.stop = Interrupted;
  a.read.progress = ReadingBar(a.quiet);
  auto clips = recon::ReadSkeletonClips(a.skeletons, a.read);
  if (Interrupted()) throw InputError("reconstruct: interrupted; nothing was written");
  PrintWarnings("reconstruct", clips);
  CheckDynamicsOf(a, clips.size());
  for (auto& clip : clips) a.floor.Apply(clip.sequence, a.quiet);
  return clips;
}

void LoadModels(ReconstructArguments& a, const std::vector<recon::SkeletonClip>& clips) {
  if (a.options.method != kButterworth) {
    a.options.database = tracker::LoadDatabase(a.files, a.options.method);
    a.options.prior = tracker::LoadPrior(a.files, a.options.method);
  }
  a.options.learned_file = FindLearnedFile(a, clips);
}

/// The destination of the results: one file, or a folder with a file for each.
class ClipFiles {
 public:
  ClipFiles(const ReconstructArguments& a, const std::vector<recon::SkeletonClip>& clips)
      : out_(a.out), is_folder_(IsOutputFolder(a, clips)), write_(a.write.For(a.out)) {
    if (is_folder_) {
      std::filesystem::create_directories(out_);
    } else {
      CheckSkeletonName(out_.string());
      AtomicFile::CheckWritable(out_);
    }
  }
  void Write(const std::string& clip_name, const recon::SkeletonSequence& made) const {
    std::filesystem::path to = out_;
    if (is_folder_) {
      to /= clip_name + ".jsonl";
      std::filesystem::create_directories(to.parent_path());
    }
    WriteSkeletonsThatFit(to, made, write_);
  }

 private:
  std::filesystem::path out_;
  bool is_folder_;
  recon::SkeletonWriteOptions write_;
};

/// The passes over each recording's frames (bones, postures, mechanics) and their progress.
class Passes {
 public:
  Passes(const ReconstructArguments& a, const std::optional<tracker::SceneOptions>& scene,
         const std::vector<recon::SkeletonClip>& clips)
      : a_(a),
        options_(a.options),
        scene_(scene),
        count_(1 + (a.bones.of_recording() ? 1 : 0) + (moves() ? 1 : 0)),
        progress_("reconstruct", a.quiet) {
    for (const auto& clip : clips) total_ += clip.sequence.frames.size();
  }
  /// If interrupted: the frames finished by then.
  recon::SkeletonSequence Make(const recon::SkeletonClip& clip) {
    options_.best.refined_joints = clip.sequence.sensor == recon::kRefinedJoints;
    recon::SkeletonSequence made = Complete(clip.sequence, Bones(clip.sequence));
    // Before the simulation, whose character stays above the floor.
    made = recon::SmoothSequence(made, LagFor(a_));
    if (moves()) Move(made);
    if (Interrupted()) made.frames.resize(std::min(made.frames.size(), ready_));
    return made;
  }
  /// Of all recordings.
  size_t frames() const { return total_; }

 private:
  bool moves() const { return scene_ || a_.mechanics.on(); }
  bool Update(size_t frames) {
    ready_ = frames;
    progress_.Update(static_cast<double>(done_ + frames) / count_, static_cast<double>(total_));
    return !Interrupted();
  }
  std::function<bool(size_t)> Updates() {
    return [this](size_t frames) { return Update(frames); };
  }
  recon::BoneLengthsById Bones(const recon::SkeletonSequence& sequence) {
    if (!a_.bones.of_recording()) return {};
    auto bones = recon::MeasureBones(sequence, options_, Updates());
    done_ += sequence.frames.size();
    return bones;
  }
  recon::SkeletonSequence Complete(const recon::SkeletonSequence& sequence,
                                   const recon::BoneLengthsById& bones) {
    auto made = a_.options.method == kButterworth
                    ? recon::ButterworthSequence(sequence, a_.cutoff_hz)
                    : recon::ReconstructSequence(sequence, options_, Updates(), bones);
    done_ += sequence.frames.size();
    return made;
  }
  void Move(recon::SkeletonSequence& made) {
    const size_t frames = made.frames.size();
    ready_ = 0;
    if (scene_) {
      PlayScene(*scene_, made, a_, Updates());
    } else {
      tracker::FollowMechanically(made, a_.mechanics.build, Updates());
    }
    done_ += frames;
  }

  const ReconstructArguments& a_;
  recon::ReconstructorOptions options_;
  std::optional<tracker::SceneOptions> scene_;
  int count_;
  Progress progress_;
  size_t done_ = 0, total_ = 0;  // frames: finished over all passes, and of all recordings
  size_t ready_ = 0;             // of the current recording
};

}  // namespace

int Reconstruct(int argc, char** argv) {
  ReconstructArguments a = ParseReconstructOptions(argc, argv);
  const auto scene = a.mechanics.Scene();  // errors are reported before the work
  const auto clips = ReadClips(a);
  const ClipFiles files(a, clips);
  LoadModels(a, clips);
  Passes rounds(a, scene, clips);
  size_t written = 0;  // frames
  for (const auto& clip : clips) {
    const recon::SkeletonSequence made = rounds.Make(clip);
    if (made.frames.empty() && Interrupted()) break;
    DoEach("reconstruct", {[&] { files.Write(clip.name, made); },
                           [&] {
                             if (a.dynamics.empty() || Interrupted()) return;
                             tracker::WriteDynamics(a.dynamics, made, a.mass_kg);
                           }});
    written += made.frames.size();
    if (Interrupted()) break;
  }
  if (Interrupted() && written < rounds.frames()) {
    throw InterruptedEarly(a, written, rounds.frames());
  }
  return 0;
}

}  // namespace ossa::commands
