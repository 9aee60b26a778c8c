#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "depth/base/error.h"
#include "depth/base/folder_lock.h"
#include "depth/base/leftovers.h"
#include "depth/image/camera.h"
#include "recon/fuse/extrinsics.h"
#include "recon/motion/mocap.h"
#include "tools/commands/command.h"
#include "tools/commands/commands.h"
#include "tools/commands/mapping_option.h"
#include "tools/commands/mocap_option.h"
#include "tools/commands/parse_consistently.h"
#include "tools/commands/shell_word.h"
#include "tools/commands/warnings.h"
#include "tools/synth/motion_terms.h"
#include "tools/synth/ranks.h"
#include "tools/synth/render_dataset.h"
#include "tools/synth/sequence_poses.h"
#include "tools/tracker/tracker.h"

namespace ossa::commands {
namespace {

struct Arguments {
  std::vector<std::string> mocap;
  recon::MocapOptions motion;  // how motion files are read
  std::string out, size = "640x480", bodies = "random", noise = "kinect-v1", view = "front";
  std::string occluders = "none", split = "train", background, format = "png", camera = "kinect-v1";
  std::string poses = "spread", clothes = "fitting", mapping;
  double fov = 0.0, shrink = 1.0;
  int64_t frames = 0;
  uint64_t seed = 1;
  int people = 1, cameras = 1;
  int threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  bool sequence = false, quiet = false;
};

void DeclareSet(CLI::App& app, Arguments& a) {
  app.add_option("--mocap", a.mocap,
                 "folders of motion capture, or the words 'authored' (upright) and "
                 "'authored-floor' (lying, kneeling, crawling, crouching, arms behind the back, "
                 "turning fast)")
      ->required();
  AddAmcRateOption(app, a.motion);
  app.add_option("--out", a.out, "folder of the DATASET; an interrupted run is resumed")
      ->required();
  app.add_option("--frames", a.frames, "number of frames")
      ->required()
      ->check(CLI::Range(1, 10'000'000));
  app.add_option("--seed", a.seed, "random seed; frame i depends only on it and on i")
      ->capture_default_str();
  app.add_option("--size", a.size, "WIDTHxHEIGHT in pixels")->capture_default_str();
}

void DeclarePeople(CLI::App& app, Arguments& a) {
  app.add_option("--bodies", a.bodies,
                 "random shapes and clothes; any: also extreme shapes; or the average body")
      ->check(CLI::IsMember({"random", "any", "average"}))
      ->capture_default_str();
  app.add_option("--clothes", a.clothes,
                 "clothes of random bodies: fitting; any: also loose ones (T-shirts, coats, "
                 "skirts, hoods), long hair, hats, bags and gloves")
      ->check(CLI::IsMember({"fitting", "any"}))
      ->capture_default_str();
}

void DeclareScene(CLI::App& app, Arguments& a) {
  app.add_option("--noise", a.noise,
                 "sensor model: structured light (kinect-v1, xtion), time of flight (kinect-v2, "
                 "azure), active stereo (d4xx); any: another in each frame")
      ->check(CLI::IsMember({"kinect-v1", "xtion", "kinect-v2", "azure", "d4xx", "any", "none"}))
      ->capture_default_str();
  app.add_option("--view", a.view,
                 "camera view: front (people face it within 60 degrees, 1.6 to 4 m away), any "
                 "(every side, height, distance and crop), near (0.75 to 1.7 m away, cropped) or "
                 "ceiling (2.2 to 4 m above the floor)")
      ->check(CLI::IsMember({"front", "any", "near", "ceiling"}))
      ->capture_default_str();
  app.add_option("--occluders", a.occluders,
                 "objects, part 32: held in the hands, standing in front (scene), or either in "
                 "some frames (any); held-up: cloth, boards, paper, boxes held in front of the "
                 "body; desk: forearms on a "
                 "desk or a chair's arms; wheelchair, crutches: sitting or walking with them; all: "
                 "any of these in some frames")
      ->check(CLI::IsMember(
          {"none", "held", "scene", "any", "held-up", "desk", "wheelchair", "crutches", "all"}))
      ->capture_default_str();
  app.add_option("--poses", a.poses,
                 "spread: rare poses nearly as often as common ones, arms sometimes at random; "
                 "natural: as often as in the motion; any: as spread, and in one of four frames "
                 "any posture within the joint limits")
      ->check(CLI::IsMember({"spread", "natural", "any"}))
      ->capture_default_str();
  app.add_option("--people", a.people, "people in each frame")
      ->check(CLI::Range(1, 6))
      ->capture_default_str();
  app.add_option("--split", a.split, "bodies and cameras of 'test' never occur in 'train'")
      ->check(CLI::IsMember({"train", "test"}))
      ->capture_default_str();
  app.add_option("--background", a.background,
                 "none: people only, as after segmentation; room: floor, walls, furniture; "
                 "lived-in: with shelves, coats on hooks, door frames, plants, too "
                 "[none; room with --sequence]")
      ->check(CLI::IsMember({"none", "room", "lived-in"}));
}

void DeclareCamera(CLI::App& app, Arguments& a) {
  app.add_option("--camera", a.camera,
                 "intrinsics; 'generic' varies them; 'any': images of 100 to 1280 pixels, 45 to "
                 "120 degrees wide, some shrunk (--size is ignored); both need --format packed")
      ->check(CLI::IsMember({"kinect-v1", "generic", "any"}))
      ->capture_default_str();
  app.add_option("--fov", a.fov, "horizontal field of view, degrees [the camera's own]")
      ->check(CLI::Range(20.0, 150.0));
  app.add_option("--shrink", a.shrink,
                 "render the sensor's images this many times larger and shrink them to --size by "
                 "nearest neighbour")
      ->check(CLI::Range(1.0, 8.0))
      ->capture_default_str();
}

void DeclareFiles(CLI::App& app, Arguments& a) {
  app.add_option("--format", a.format,
                 "png files (depth/, parts/, users/), packed shards (faster, smaller), or both")
      ->check(CLI::IsMember({"png", "packed", "both"}))
      ->capture_default_str();
  app.add_flag("--sequence", a.sequence,
               "one continuous clip at 30 Hz: one body before one camera, frames in order");
  app.add_option("--cameras", a.cameras,
                 "number of cameras around the people of a --sequence, each with a data set of the "
                 "same times, OUT/camera_0 and so on, and OUT/extrinsics.json")
      ->check(CLI::Range(1, 16))
      ->capture_default_str();
  AddMappingOption(app, a.mapping);
  app.add_option("--threads", a.threads)->check(CLI::Range(1, 1024));
  app.add_flag("--quiet", a.quiet, "no progress");
}

void Declare(CLI::App& app, Arguments& a) {
  DeclareSet(app, a);
  DeclarePeople(app, a);
  DeclareScene(app, a);
  DeclareCamera(app, a);
  DeclareFiles(app, a);
}

void ParseSize(const std::string& text, int* width, int* height) {
  const auto number = [](std::string_view digits) {
    int value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    return error == std::errc() && end == digits.data() + digits.size() ? value : 0;
  };
  const size_t by = std::min(text.find('x'), text.size());
  *width = number(std::string_view(text).substr(0, by));
  *height = number(std::string_view(text).substr(std::min(by + 1, text.size())));
  if (*width < 32 || *height < 24 || *width > 4096 || *height > 4096) {
    throw UsageError("--size: expected WIDTHxHEIGHT from 32x24 to 4096x4096, found " + text);
  }
}

// The image before shrinking is kept in memory.
void CheckSensorSize(const tools::FrameOptions& options) {
  const double larger_px = options.shrink * std::max(options.width, options.height);
  if (larger_px <= depth::kLargestImageSide) return;
  throw Contradiction(
      fmt::format("--shrink {}: expected a sensor of at most {} pixels a side, found {}",
                  options.shrink, depth::kLargestImageSide, larger_px));
}

// `any`: all sensors.
std::vector<depth::SensorKind> ParseSensors(const std::string& noise) {
  if (noise != "any") return {*depth::SensorFromName(noise)};
  std::vector<depth::SensorKind> sensors;
  for (const std::string_view name : depth::kSensorNames) {
    if (name != "none") sensors.push_back(*depth::SensorFromName(name));
  }
  return sensors;
}

void CheckTogether(const CLI::App&, Arguments& a) {
  if (a.sequence && a.poses != "spread") {
    throw Contradiction("--poses " + a.poses + ": a --sequence has the poses of its clip");
  }
  constexpr std::array<std::string_view, 5> kStaged = {"held-up", "desk", "wheelchair", "crutches",
                                                       "all"};
  const bool staged = std::find(kStaged.begin(), kStaged.end(), a.occluders) != kStaged.end();
  if (a.sequence && staged) {
    throw Contradiction("--occluders " + a.occluders +
                        ": arms are put to things, not in a --sequence");
  }
  if (a.cameras > 1 && !a.sequence) {
    throw Contradiction("--cameras: expected --sequence with it");
  }
  if (a.cameras > 1 && a.background == "lived-in") {
    throw Contradiction("--background lived-in: is made for one camera: expected room or none");
  }
  if (a.bodies == "average" && a.clothes != "fitting") {
    throw Contradiction(
        "--clothes " + a.clothes +
        ": the average body wears the same always: expected --bodies random or any");
  }
  if (a.camera != "kinect-v1" && a.format != "packed") {
    throw Contradiction("--camera " + a.camera +
                        ": needs --format packed, where each frame has its camera");
  }
  if (a.camera == "any" && a.sequence) {
    throw Contradiction("--camera any: draws another for each frame, not for a --sequence");
  }
  if (a.camera == "any" && (a.fov > 0.0 || a.shrink != 1.0)) {
    throw Contradiction(
        "--camera any: draws field of view and shrinking; leave --fov and --shrink out");
  }
}

tools::FrameOptions MakeOptions(const Arguments& a) {
  tools::FrameOptions options;
  ParseSize(a.size, &options.width, &options.height);
  options.view = *tools::ViewFromName(a.view);
  options.split = *tools::SplitFromName(a.split);
  options.occluders = *tools::OccludersFromName(a.occluders);
  options.sensors = ParseSensors(a.noise);
  const bool room = a.background.empty() ? a.sequence : a.background == "room";
  options.background = a.background == "lived-in" ? tools::Background::kLivedIn
                       : room                     ? tools::Background::kRoom
                                                  : tools::Background::kNone;
  options.random_bodies = a.bodies != "average";
  options.ends = a.bodies == "any";
  options.hanging_clothes = a.clothes == "any";
  options.cameras = *tools::CamerasFromName(a.camera);
  options.fov_deg = a.fov;
  options.shrink = a.shrink;
  CheckSensorSize(options);
  options.sequence = a.sequence;
  options.people = a.people;
  options.views = a.cameras;
  options.seed = a.seed;
  options.variation = tools::MakeVariation(*tools::PosesFromName(a.poses));
  return options;
}

// What made the data set, independent of threads and folders.
std::string FormatCommand(const Arguments& a) {
  std::string command = "ossa render";
  for (const auto& source : a.mocap) command += " --mocap " + ShellWord(source);
  command += fmt::format(
      " --frames {} --seed {} --size {} --bodies {} --noise {} --view {} --occluders {} --people "
      "{} --split {} --camera {} --format {}",
      a.frames, a.seed, a.size, a.bodies, a.noise, a.view, a.occluders, a.people, a.split, a.camera,
      a.format);
  if (!a.background.empty()) command += " --background " + a.background;
  if (a.poses != "spread") command += " --poses " + a.poses;
  if (a.clothes != "fitting") command += " --clothes " + a.clothes;
  if (a.fov > 0.0) command += fmt::format(" --fov {}", a.fov);
  if (a.shrink != 1.0) command += fmt::format(" --shrink {}", a.shrink);
  if (a.sequence) command += " --sequence";
  if (a.cameras > 1) command += fmt::format(" --cameras {}", a.cameras);
  if (!a.mapping.empty()) command += " --mapping " + ShellWord(a.mapping);
  if (a.motion.amc_hz > 0.0) command += fmt::format(" --amc-fps {}", a.motion.amc_hz);
  return command;
}

tools::RenderJob MakeJob(const Arguments& a, const std::filesystem::path& out,
                         const tools::Ranks& ranks) {
  tools::RenderJob job;
  job.out = out;
  job.frames = a.frames;
  job.png = a.format != "packed";
  job.packed = a.format != "png";
  job.threads = a.threads;
  job.rank = ranks.rank();
  job.ranks = ranks.size();
  job.command = FormatCommand(a);
  job.sources = a.mocap;
  job.ossa = tracker::Version();
  job.terms = tools::ListTerms(a.mocap);
  job.interrupted = Interrupted;
  return job;
}

void RenderSet(const tools::FrameInputs& inputs, const Arguments& a,
               const std::filesystem::path& out, tools::Ranks& ranks) {
  tools::RenderJob job = MakeJob(a, out, ranks);
  Progress progress("render", a.quiet || ranks.rank() != 0);
  const auto share = static_cast<double>(a.frames) / ranks.size();
  job.progress = [&](int64_t done) { progress.Update(static_cast<double>(done), share); };
  const bool finished = tools::RenderShare(inputs, job) == tools::RenderEnd::kDone;
  if (!ranks.All(finished)) {
    throw InputError(a.out + ": interrupted; the same command goes on from here");
  }
  if (ranks.rank() == 0) tools::FinishDataset(inputs, job);
}

std::string CameraName(int camera) { return fmt::format("camera_{}", camera); }

// A folder of several cameras contains only their data sets, and is none itself. Removes the
// extrinsics of a killed run; the data sets handle their own leftovers.
void CheckFolderOfCameras(const Arguments& a) {
  RemoveLeftoversOf(std::filesystem::path(a.out) / "extrinsics.json");
  for (const auto& entry : std::filesystem::directory_iterator(a.out)) {
    const std::string name = entry.path().filename().string();
    bool known = name == "extrinsics.json";
    for (int k = 0; k < a.cameras; ++k) known = known || name == CameraName(k);
    if (known) continue;
    throw InputError(a.out + ": expected an empty folder, found " + name);
  }
}

// Renders one data set after the other; extrinsics.json is written last.
void RenderAround(tools::FrameInputs& inputs, const Arguments& a, tools::Ranks& ranks) {
  const std::filesystem::path out(a.out);
  if (ranks.rank() == 0) CheckFolderOfCameras(a);
  for (int k = 0; k < a.cameras; ++k) {
    inputs.options.camera = k;
    RenderSet(inputs, a, out / CameraName(k), ranks);
  }
  if (ranks.rank() != 0) return;
  recon::Extrinsics cameras;
  for (const Eigen::Isometry3d& from_camera_0 : tools::FrameMaker(inputs).FromCamera0()) {
    cameras.push_back(
        {.name = CameraName(static_cast<int>(cameras.size())), .from_camera_0 = from_camera_0});
  }
  recon::WriteExtrinsics(out / "extrinsics.json", cameras);
}

}  // namespace

int Render(int argc, char** argv) {
  const auto a = ParseConsistently<Arguments>(
      {"Render labelled depth images: people of all shapes in motion, part of each pixel", Declare,
       CheckTogether},
      argc, argv);
  const tools::FrameOptions options = MakeOptions(a);
  tools::Ranks ranks;
  recon::MocapOptions mocap_options = a.motion;
  mocap_options.seed = a.seed;
  mocap_options.mapping_file = a.mapping;
  mocap_options.stop = Interrupted;
  const auto clips = recon::LoadMocap(a.mocap, mocap_options);
  if (Interrupted()) throw InputError("render: interrupted; nothing was made");
  if (ranks.rank() == 0) PrintWarnings("render", clips);
  const tools::PoseBankOptions bank = tools::MakeBankOptions(*tools::PosesFromName(a.poses));
  auto poses =
      a.sequence ? tools::SequencePoses(clips, a.frames, a.seed) : tools::MakePoseBank(clips, bank);
  if (poses.empty()) throw InputError(a.mocap.front() + ": expected motion, found no frames");
  tools::FrameInputs inputs(recon::BodyModel::Load(recon::BodyFolder()), std::move(poses), options);
  // MPI ranks share the work; only the first locks the folder.
  std::optional<FolderLock> lock;
  if (ranks.rank() == 0) lock.emplace(a.out);
  if (a.cameras > 1) {
    RenderAround(inputs, a, ranks);
  } else {
    RenderSet(inputs, a, a.out, ranks);
  }
  return 0;
}

}  // namespace ossa::commands
