#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <string>

#include "depth/base/error.h"
#include "depth/base/lower_case.h"
#include "depth/base/one_line.h"
#include "depth/sensor/frame_source.h"
#include "forest/forest.h"
#include "recon/database/posture_database.h"
#include "recon/files/skeleton_io.h"
#include "recon/fit/body_mesh.h"
#include "recon/fit/surface_fit.h"
#include "recon/models/learned_models.h"
#include "recon/models/posture_prior.h"
#include "recon/refine/bone_estimation.h"
#include "recon/refine/pose_network.h"
#include "recon/refine/refinement_cascade.h"
#include "tools/commands/command.h"
#include "tools/commands/commands.h"
#include "tools/commands/info_paths.h"
#include "tools/commands/info_picture.h"
#include "tools/commands/outputs.h"
#include "tools/commands/process.h"
#include "tools/commands/reading_bar.h"
#include "tools/commands/source_options.h"
#include "tools/commands/warnings.h"
#include "tools/synth/dataset.h"
#include "tools/tracker/shipped.h"

namespace ossa::commands {
namespace {

namespace fs = std::filesystem;

// A kind of file: how it is recognised, and how it is shown.
struct FileKind {
  bool (*is)(const fs::path&);
  void (*show)(const fs::path&);
  const char* extension = nullptr;  // recognises a damaged file
  // Instead of `show`, for files that depend on a body surface.
  void (*show_with)(const fs::path&, const recon::BodySurface&) = nullptr;
};

// Optional content of a forest, besides trees and proposals.
std::string DescribeStages(const forest::ForestData& data) {
  std::string text = "no pose priors";
  if (!data.pose_priors.empty()) {
    const forest::PosePrior& first = data.pose_priors.front();
    text = fmt::format("pose priors of {} factors",
                       first.loading_m.size() / std::max<size_t>(first.mean_m.size(), 1));
  }
  text += data.refinement.empty() ? ", no second stage"
                                  : fmt::format(", a second stage of {} units",
                                                data.refinement.layers.front().bias.size());
  return text + (data.relabelling.bias.empty() ? ", no" : ",") + " joint-conditioned relabelling";
}

void ShowModel(const fs::path& path) {
  const forest::ForestModel model = forest::ReadForestModel(path);
  const forest::ForestData& data = model.data();
  fmt::print("forest model, {} classes, {} contexts, {} trees, {:.1f} MB\n", model.class_count(),
             model.context_count(), data.trees.size(),
             static_cast<double>(fs::file_size(path)) * 1e-6);
  for (const forest::Tree& tree : data.trees) {
    fmt::print("  tree: {} nodes, {} leaves, {} leaf entries, {} votes\n", tree.nodes.size(),
               tree.leaf_count(), tree.entries.size(), tree.votes.size());
  }
  fmt::print("{}\n", DescribeStages(data));
  fmt::print("contexts count as {} independent pixels\n", data.evidence_scale);
  for (const forest::ProposalTarget& t : data.targets) {
    fmt::print(
        "  {:<14} bandwidth {:.3f} m  push-back {:.2f} m  P >= {:.2f}  class weight {:.1f}  votes "
        "<= {:.1f} m, sharp to {:.2f} m  tracked >= {:.2f}  inferred >= {:.2f}\n",
        t.name, t.bandwidth_m, t.push_back_m, t.probability_threshold, t.class_weight,
        t.vote_radius_m, t.vote_sharpness_m, t.tracked_confidence, t.inferred_confidence);
  }
  fmt::print("{}\n", model.manifest());
}

void ShowDataset(const fs::path& path) {
  const tools::DatasetReader reader(path);
  const tools::DatasetManifest& m = reader.manifest();
  fmt::print("data set, {} frames of {} x {}, seed {}, split {}, view {}\nmade by: {}\n", m.frames,
             m.camera.width, m.camera.height, m.seed, OnOneLine(m.split), OnOneLine(m.view),
             OnOneLine(m.command));
  if (!m.ossa.empty()) fmt::print("by ossa {}\n", OnOneLine(m.ossa));
  for (const std::string& source : m.sources) fmt::print("motion: {}\n", OnOneLine(source));
  for (const std::string& terms : m.terms) fmt::print("terms: {}\n", OnOneLine(terms));
}

void ShowDatabase(const fs::path& path) {
  const auto database = recon::PostureDatabase::Load(path);
  const recon::DatabaseOptions& options = database.options();
  const int size = database.size();
  fmt::print("posture database, {} postures of {} in {} clips, {:.1f} edges a posture, {:.1f} MB\n",
             size, database.source_postures(), database.clip_count(),
             static_cast<double>(database.edge_count()) / size,
             static_cast<double>(fs::file_size(path)) * 1e-6);
  fmt::print("filter {}, threshold {} m; postures nearer than {:.3f} m are connected\n",
             options.filter == recon::DatabaseFilter::kMaxJoint ? "max-joint" : "sum-squared",
             options.threshold_m, database.edge_threshold_m());
  for (int i = 0; i < size; ++i) {
    if (i == 0 || database.clip_of(i) != database.clip_of(i - 1)) {
      fmt::print("clip: {}\n", OnOneLine(database.clip_of(i)));
    }
  }
}

void ShowLearned(const fs::path& path) {
  const auto learned = recon::LearnedModels::Load(path);
  fmt::print("learned reconstruction, from {} pairs, {:.1f} MB\n", learned.pair_count,
             static_cast<double>(fs::file_size(path)) * 1e-6);
  fmt::print("best: a correction of {} centres\n", learned.correction.centres.cols());
  if (!learned.filter.empty()) {
    int heard = 0;
    for (size_t j = 0; j < recon::kJointCount; ++j) {
      heard += learned.filter.Knows(recon::LinearFilter::kBefore, j) ? 1 : 0;
    }
    fmt::print("best: a filter of {} joints at {:.3g} frames a second\n", heard,
               1.0 / learned.filter.step_s);
  }
  fmt::print("exemplar: {} pairs\n", learned.exemplars.size());
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    fmt::print("  {:<14} liu-2016: {} local models  full-gp: {} samples\n", recon::kJointNames[j],
               learned.mixtures[j].models().size(), learned.full[j].size());
  }
}

void ShowPrior(const fs::path& path) {
  const auto prior = recon::PosturePrior::Load(path);
  const double unexplained = prior.residual_m2.sum();
  fmt::print(
      "posture prior, {} modes learned from {} postures, {:.2f} % of the variance in none, {:.1f} "
      "kB\ncorrelation times {:.2f} s to {:.2f} s, {} units that correct what the modes say\n",
      prior.correlation_time_s.size(), prior.frames,
      100.0 * unexplained / (unexplained + prior.modes_m.squaredNorm()),
      static_cast<double>(fs::file_size(path)) * 1e-3, prior.correlation_time_s.minCoeff(),
      prior.correlation_time_s.maxCoeff(),
      prior.network.empty() ? 0 : prior.network.layers.front().bias.size());
}

void ShowSurface(const fs::path& path) {
  const auto surface = recon::BodySurface::Load(path);
  fmt::print("body surface, {} points, {} components of shape, mean stature {:.2f} m, {:.1f} kB\n",
             surface.points.size(), recon::kShapeCount, surface.stature_mean_m,
             static_cast<double>(fs::file_size(path)) * 1e-3);
}

void ShowPersonFile(const fs::path& path, const recon::BodySurface& surface) {
  const auto person = recon::PersonShape::Load(path, surface);
  const recon::Stature stature = recon::MeasureStature(person, surface);
  fmt::print("a person of this body surface, {:.2f} m tall, give or take {:.0f} cm, by {} frames\n",
             stature.stature_m, 100.0 * stature.sigma_m, person.frames);
}

void ShowMesh(const fs::path& path, const recon::BodySurface& surface) {
  const auto mesh = recon::BodyMesh::Load(path, surface);
  fmt::print("body mesh of this body surface, {} vertices, {} triangles, {:.1f} kB\n",
             mesh.vertices.size(), mesh.triangles.size(),
             static_cast<double>(fs::file_size(path)) * 1e-3);
}

void ShowRefinement(const fs::path& path) {
  const auto cascade = recon::RefinementCascade::Load(path);
  // The number of people of earlier stages is not stored in the file.
  const bool is_one = cascade.stages.size() + cascade.bone_conditioned.size() == 1;
  const auto count = [](const std::vector<recon::RefinementStage>& stages, const char* kind) {
    return fmt::format("{} {}stage{}", stages.size(), kind, stages.size() == 1 ? "" : "s");
  };
  fmt::print(
      "refinement cascade for a forest's joints, {} of {} networks, {}learned from {} people{}, "
      "{:.1f} MB\n",
      count(cascade.stages, ""), recon::kStageJoints.size(), is_one ? "" : "the last made ",
      cascade.people, cascade.from_above ? " seen from the ceiling" : "",
      static_cast<double>(fs::file_size(path)) * 1e-6);
  if (cascade.bones.empty()) return;
  fmt::print("and an estimate of {} bones, learned from {} people{}\n",
             recon::kEstimatedBones.size(), cascade.measured,
             cascade.bone_conditioned.empty()
                 ? ""
                 : "; " + count(cascade.bone_conditioned, "bone-conditioned "));
}

void ShowPoseNetwork(const fs::path& path) {
  const auto network = recon::PoseNetwork::Load(path);
  Eigen::Index weights = 0;
  for (const Convolution& layer : network.layers()) weights += layer.weight.size();
  fmt::print("pose network of {} layers and {} weights, learned from {} people, {:.1f} MB\n",
             recon::PoseNetwork::kLayers, weights, network.people(),
             static_cast<double>(fs::file_size(path)) * 1e-6);
}

// Reads all frames: many recordings do not store their number, or are damaged.
void ShowDepthRecording(const SourceArguments& arguments) {
  const auto source = OpenSource(arguments, false);
  Progress progress("reading", !CanMoveCursor());  // for who watches alone
  const auto known = static_cast<double>(source->frame_count().value_or(0));
  int frames = 0;
  double first_s = 0.0, last_s = 0.0;
  for (;;) {
    const depth::ReadResult read = source->Read(std::chrono::seconds(1));
    if (read.status == depth::ReadStatus::kEnd) break;
    if (read.status != depth::ReadStatus::kFrame) continue;
    last_s = read.frame.time_s;
    if (frames++ == 0) first_s = last_s;
    if (known > 0) progress.Update(frames, known);
    if (Interrupted()) {
      throw InputError(fmt::format("{}: interrupted: {} were read", arguments.name,
                                   FramesText(frames, source->frame_count())));
    }
  }
  const depth::Camera& camera = source->camera();
  fmt::print(
      "depth images, {} frames of {} x {}, {:.2f} s, fx {:.2f} fy {:.2f} cx {:.2f} cy {:.2f}\n",
      frames, camera.width, camera.height, last_s - first_s, camera.fx, camera.fy, camera.cx,
      camera.cy);
}

// The properties of a live camera; images must be recorded first.
void ShowCamera(const SourceArguments& arguments) {
  const auto source = OpenSource(arguments, false);
  const depth::Camera& camera = source->camera();
  fmt::print("depth camera, {} x {}, fx {:.2f} fy {:.2f} cx {:.2f} cy {:.2f}\n", camera.width,
             camera.height, camera.fx, camera.fy, camera.cx, camera.cy);
}

// The image rotation, if asked for.
void ShowUpright(const SourceArguments& arguments) {
  tracker::Tracker tracker;
  FindUpright(tracker, *OpenSource(arguments, true), arguments, true);
  if (Interrupted()) throw InputError(arguments.name + ": interrupted");
  fmt::print("people stand upright if its images are rotated by {} degrees clockwise\n",
             90 * tracker.quarter_turns());
}

void ShowSkeletonClip(const recon::SkeletonClip& clip) {
  const auto& frames = clip.sequence.frames;
  const std::string& columns = clip.sequence.columns;
  const std::string name = clip.name + (columns.empty() ? "" : "#" + columns);
  size_t bodies = 0;
  for (const recon::SkeletonFrame& frame : frames) bodies += frame.bodies.size();
  const double seconds = frames.empty() ? 0.0 : frames.back().time_s - frames.front().time_s;
  fmt::print("skeletons{}{}, {} frames, {:.2f} s, {} bodies\n", name.empty() ? "" : " ",
             OnOneLine(name), frames.size(), seconds, bodies);
}

// All other files: skeletons of an SDK, alone or in a folder; the readers report errors. For files
// with two kinds both are shown, unless the path selects one.
void ShowSkeletons(const fs::path& path) {
  recon::SkeletonReadOptions reading;
  reading.columns = "observed";
  reading.progress = ReadingBar(false);
  auto clips = recon::ReadSkeletonClips(path, reading);
  PrintWarnings("info", clips);
  const auto may_have_another = [](const recon::SkeletonClip& clip) {
    return clip.sequence.columns == "observed";
  };
  if (std::any_of(clips.begin(), clips.end(), may_have_another)) {
    reading.columns = "truth";
    for (recon::SkeletonClip& clip : recon::ReadSkeletonClips(path, reading)) {
      if (clip.sequence.columns == "truth") clips.push_back(std::move(clip));
    }
    std::stable_sort(clips.begin(), clips.end(),
                     [](const auto& a, const auto& b) { return a.name < b.name; });
  }
  for (const recon::SkeletonClip& clip : clips) ShowSkeletonClip(clip);
}

// The first kind that recognises the file by content, or by extension, shows it; of others depth
// images are tried before skeletons.
constexpr std::array kKinds = {
    FileKind{forest::IsForestModel, ShowModel, ".ossa"},
    FileKind{recon::PostureDatabase::IsFile, ShowDatabase, ".ossadb"},
    FileKind{recon::LearnedModels::IsFile, ShowLearned, ".ossagp"},
    FileKind{recon::PosturePrior::IsFile, ShowPrior, ".ossaprior"},
    FileKind{recon::BodySurface::IsFile, ShowSurface, ".ossasurface"},
    FileKind{recon::PersonShape::IsFile, nullptr, ".ossaperson", ShowPersonFile},
    FileKind{recon::BodyMesh::IsFile, nullptr, ".ossamesh", ShowMesh},
    FileKind{recon::RefinementCascade::IsFile, ShowRefinement, ".ossarefine"},
    FileKind{recon::PoseNetwork::IsFile, ShowPoseNetwork, ".ossanet"},
    FileKind{tools::IsDataset, ShowDataset},
    FileKind{tools::IsUnfinishedDataset, ShowDataset},  // refuses it with a message
};

recon::BodySurface LoadSurface(const std::string& named) {
  return recon::BodySurface::Load(named.empty() ? tracker::ShippedFile(recon::kShippedSurface)
                                                : fs::path(named));
}

void Show(const SourceArguments& arguments, const std::string& surface, bool is_depth) {
  if (IsLive(arguments.name)) return ShowCamera(arguments);
  const fs::path path = arguments.name;
  for (const FileKind& kind : kKinds) {
    const bool is_named_so = kind.extension != nullptr && HasEnding(arguments.name, kind.extension);
    if (is_depth || (!is_named_so && !kind.is(path))) continue;
    if (kind.show == nullptr) return kind.show_with(path, LoadSurface(surface));
    return kind.show(path);
  }
  if (is_depth || depth::IsRecording(path) || HoldsFolderOfImages(path))
    return ShowDepthRecording(arguments);
  if (IsNonEmpty(path)) return ShowSkeletons(path);
  throw InputError(arguments.name +
                   ": expected a DATASET, a folder of PNGs or one of skeleton files");
}

}  // namespace

int Info(int argc, char** argv) {
  CLI::App app(
      "Show what a file contains: a model's card, a database's clips, a data set's origin");
  SourceArguments file;
  AddSourceOptions(app, file);
  app.get_option("SOURCE")->description(
      "a .ossa, .ossadb, .ossagp, .ossaprior, .ossarefine, .ossanet, .ossasurface, .ossamesh, "
      ".ossaperson or skeleton file, FILE#truth, a DATASET, a folder of skeleton files, or depth "
      "images: .oni, .xef, .mkv, .bag, .db3, .mcap, BAG#/topic, arrays (.npy, .npz, .mat, .h5), a "
      "16-bit "
      "PNG, TIFF or PGM or a folder of them; or a device, openni: or openni:URI. The options say "
      "how "
      "depth images are read");
  std::string picture;
  app.add_option("--picture", picture,
                 "write a picture: FILE.png, a contact sheet of depth images or of a DATASET, or "
                 "FILE.html, the card of a forest model");
  std::string surface;
  app.add_option(
      "--surface", surface,
      ".ossasurface to which an .ossaperson or .ossamesh belongs (default: the shipped one)");
  Parse(app, argc, argv);
  if (!picture.empty() && IsLive(file.name)) {
    throw UsageError("--picture: " + file.name +
                     ": expected a recording, found a device or a pipe");
  }
  RequireExists(file.name);
  if (!picture.empty()) WriteInfoPicture(file, picture);
  // With options for reading depths, a DATASET is read as images, too.
  const size_t others = 2 + app.count("--picture") + app.count("--surface");
  const bool is_depth = app.count_all() > others;
  Show(file, surface, is_depth);
  PrintUnreadSurface(file.name, surface);
  if (app.count("--rotate") > 0 && file.rotate == "auto") ShowUpright(file);
  return 0;
}

}  // namespace ossa::commands
