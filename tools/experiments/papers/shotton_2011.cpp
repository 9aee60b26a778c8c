// Shotton et al.: Real-time human pose recognition in parts from single depth images (2011): part
// accuracy against the number of training images and the depth of the trees (fig. 6), average
// precision by joint (fig. 8).
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "depth/base/folder_lock.h"
#include "forest/forest.h"
#include "forest/training/train.h"
#include "recon/body/body_model.h"
#include "recon/motion/mocap.h"
#include "tools/experiments/compare/svg_plot.h"
#include "tools/experiments/experiments_internal.h"
#include "tools/experiments/sdk/method_runs.h"
#include "tools/learning/evaluate.h"
#include "tools/learning/person_source.h"
#include "tools/synth/pose_bank.h"
#include "tools/synth/render_dataset.h"
#include "tools/tracker/shipped.h"

namespace ossa::tools {
namespace {

namespace fs = std::filesystem;

struct ShottonSettings {
  std::string motion, test_motion;
  int pixels = 0, candidates = 0;
  int validation_images = 0;  // for learning the proposals
  int test_images = 0;
  std::vector<int> images, depths;  // all combinations are trained
  int trees = 0;
};

ShottonSettings ReadSettings(ExperimentContext& context) {
  Parameters& parameters = context.parameters;
  const bool full = context.full;
  // By definition of `ossa train`: as many as it takes.
  constexpr int kMostTrees = 16, kMostDepth = 24, kMostPixels = 100'000, kMostCandidates = 100'000;
  constexpr int kLeastImages = 100;  // by definition: the last ten of each are kept for proposals
  ShottonSettings settings;
  settings.motion = parameters.Motion("motion", "authored");
  settings.test_motion = parameters.Motion("test_motion", settings.motion);
  settings.pixels = parameters.Integer("pixels", full ? 300 : 150, 1, kMostPixels);
  settings.candidates = parameters.Integer("candidates", full ? 500 : 150, 1, kMostCandidates);
  settings.validation_images = parameters.Integer("validation_images", full ? 400 : 60, 1);
  settings.test_images = parameters.Integer("test_images", full ? 1000 : 150, 1);
  settings.images = parameters.Integers(
      "images",
      full ? std::vector<int>{300, 1000, 3000, 10000, 30000} : std::vector<int>{100, 1000},
      kLeastImages);
  settings.depths = parameters.Integers(
      "depths", full ? std::vector<int>{5, 8, 12, 16, 20} : std::vector<int>{5, 10, 15}, 1,
      kMostDepth);
  settings.trees = parameters.Integer("trees", full ? 3 : 1, 1, kMostTrees);
  return settings;
}

struct Setting {
  int64_t images = 0;
  int depth = 0;
  int trees = 1;
};

class ForestEvaluator {
 public:
  ForestEvaluator(ExperimentContext& context, ShottonSettings settings)
      : context_(context), settings_(std::move(settings)) {}

  // Renders a data set of this study, or finds the finished one.
  fs::path RenderData(Split split, int64_t frames);
  // Trains and evaluates a forest; cached.
  Evaluation EvaluateSetting(const Setting& setting, int64_t test_frames);
  Evaluation EvaluateShipped(int64_t test_frames);

 private:
  Evaluation Measured(const std::string& key, const std::function<forest::ForestModel()>& model,
                      int64_t test_frames);

  ExperimentContext& context_;
  ShottonSettings settings_;
};

fs::path ForestEvaluator::RenderData(Split split, int64_t frames) {
  const bool test = split == Split::kTest;
  const std::string& motion = test ? settings_.test_motion : settings_.motion;
  RenderJob job;
  job.command = fmt::format("ossa experiment shotton-2011 {} {} {} seed {}",
                            test ? "test" : "train", motion, frames, context_.seed);
  job.out = context_.out / "cache" / ContentHash(job.command + ComputeCodeKey());
  if (IsDataset(job.out)) return job.out;
  if (!recon::BodyIsFetched(recon::BodyFolder())) {
    throw InputError(recon::BodyFolder().string() +
                     ": expected the body model: run tools/fetch_body");
  }
  FrameOptions options;
  options.width = 320;
  options.height = 240;
  options.split = split;
  options.seed = context_.seed + (test ? 500 : 0);
  recon::MocapOptions mocap;
  mocap.seed = options.seed;  // other movers for the test
  const FrameInputs inputs(recon::BodyModel::Load(recon::BodyFolder()),
                           MakePoseBank(recon::LoadMocap({motion}, mocap)), options);
  job.frames = frames;
  job.png = false;
  job.packed = true;
  job.threads = context_.threads;
  job.sources = {motion};
  job.terms = {"made for one study"};
  if (context_.interrupted) job.interrupted = context_.interrupted;
  job.progress = [&](int64_t done) {
    if (!context_.progress) return;
    context_.progress(static_cast<double>(done), static_cast<double>(frames),
                      test ? "rendering test images" : "rendering training images");
  };
  const FolderLock lock(job.out);
  if (RenderShare(inputs, job) != RenderEnd::kDone) throw Interruption{};
  FinishDataset(inputs, job);
  return job.out;
}

Evaluation ForestEvaluator::Measured(const std::string& key,
                                     const std::function<forest::ForestModel()>& model,
                                     int64_t test_frames) {
  const fs::path test = RenderData(Split::kTest, test_frames);
  const std::string text = context_.Cached(key + " on " + test.filename().string(), [&] {
    const forest::ForestModel grown = model();
    const Evaluation e = Evaluate(grown, key, DatasetReader(test), 1, [&](int64_t, int64_t) {
      return !(context_.interrupted && context_.interrupted());
    });
    context_.ThrowIfInterrupted();
    return nlohmann::json{{"pixel", e.pixel_accuracy}, {"class", e.mean_class_accuracy},
                          {"map", e.map_10cm},         {"map_visible", e.map_10cm_visible},
                          {"ap", e.ap_10cm},           {"ap_visible", e.ap_10cm_visible}}
        .dump();
  });
  const auto json = nlohmann::json::parse(text);
  const auto number = [](const nlohmann::json& value) {
    return value.is_number() ? value.get<double>() : std::nan("");
  };
  Evaluation evaluation;
  evaluation.pixel_accuracy = number(json["pixel"]);
  evaluation.mean_class_accuracy = number(json["class"]);
  evaluation.map_10cm = number(json["map"]);
  evaluation.map_10cm_visible = number(json["map_visible"]);
  for (const auto& value : json["ap"]) evaluation.ap_10cm.push_back(number(value));
  for (const auto& value : json["ap_visible"]) evaluation.ap_10cm_visible.push_back(number(value));
  return evaluation;
}

Evaluation ForestEvaluator::EvaluateSetting(const Setting& setting, int64_t test_frames) {
  const std::string key =
      fmt::format("shotton {} {} {} {} {} {} {} {} seed {}", ComputeCodeKey(), settings_.motion,
                  setting.images, setting.depth, setting.trees, settings_.pixels,
                  settings_.candidates, settings_.validation_images, context_.seed);
  return Measured(
      key,
      [&] {
        // Proposals are learned from a tenth of the images that no tree sees.
        const fs::path data = RenderData(Split::kTrain, setting.images);
        forest::TrainOptions options;
        options.trees = setting.trees;
        options.depth = setting.depth;
        options.pixels = settings_.pixels;
        options.candidates = settings_.candidates;
        options.thresholds = 20;
        options.seed = context_.seed;
        options.threads = context_.threads;
        options.vote_depth = std::min(options.vote_depth, setting.depth);
        if (context_.interrupted) options.stop = context_.interrupted;
        options.progress = [&](const forest::TrainProgress& at) {
          if (!context_.progress) return;
          context_.progress(
              at.level + 1, at.levels + 2,
              fmt::format("growing {} images depth {}", setting.images, setting.depth));
        };
        const PersonSource train({data}, {0, 90});
        const PersonSource validation({data}, {90, 100});
        return forest::LearnProposals(forest::Train(train, BodyVocabulary(), options), validation,
                                      static_cast<size_t>(settings_.validation_images),
                                      context_.threads);
      },
      test_frames);
}

Evaluation ForestEvaluator::EvaluateShipped(int64_t test_frames) {
  const fs::path path = context_.model.empty() ? tracker::ShippedFile("body.ossa") : context_.model;
  return Measured(
      fmt::format("shotton shipped {} {}", ComputeCodeKey(), ComputeFileKey(path)),
      [&] { return forest::ReadForestModel(path); }, test_frames);
}

// A self-contained SVG file: LinePlot's lines with a legend.
std::string Figure(const std::vector<Series>& series, const Axes& axes) {
  std::string plot = LinePlot(series, axes);
  plot.erase(0, plot.find("<svg"));
  const std::string head =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" font-family=\"sans-serif\" font-size=\"11\"";
  plot.replace(0, 4, head);
  std::string extra =
      "<style>.grid{stroke:#e4e4e4}</style><rect width=\"100%\" height=\"100%\" fill=\"white\"/>";
  plot.insert(plot.find('>') + 1, extra);
  std::string names;
  for (size_t i = 0; i < series.size(); ++i) {
    names += fmt::format("<text x=\"70\" y=\"{}\" fill=\"{}\">{}</text>", 24 + 14 * i,
                         SeriesColour(i), Escaped(series[i].name));
  }
  plot.insert(plot.rfind("</svg>"), names);
  return plot + "\n";
}

void WriteFigure(const fs::path& path, const std::vector<Series>& series, const Axes& axes) {
  AtomicFile file(path);
  file.stream() << Figure(series, axes);
  file.Commit();
}

// Mean class accuracy by number of images and depth.
using Curves = std::map<double, std::map<double, double>>;

void WriteFigures(const fs::path& out, const Curves& accuracy) {
  std::vector<Series> by_images;
  std::map<double, Series> by_depth;
  for (const auto& [images, row] : accuracy) {
    by_images.push_back({fmt::format("{:.0f} images", images), {}, {}});
    for (const auto& [depth, share] : row) {
      by_images.back().x.push_back(depth);
      by_images.back().y.push_back(100 * share);
      Series& line = by_depth[depth];
      line.name = fmt::format("depth {:.0f}", depth);
      line.x.push_back(std::log10(images));
      line.y.push_back(100 * share);
    }
  }
  std::vector<Series> lines;
  for (const auto& [depth, line] : by_depth) lines.push_back(line);
  const std::string share = "mean class accuracy, %";
  WriteFigure(out / "accuracy_by_depth.svg", by_images, {"depth of the trees", share, {}, {}});
  WriteFigure(out / "accuracy_by_images.svg", lines, {"training images, log10", share, {}, {}});
}

std::string Percent(double share) { return std::isnan(share) ? "-" : Cell(100 * share, 1); }

Table ComputeFigureSix(ForestEvaluator& evaluator, const ShottonSettings& settings,
                       const fs::path& out) {
  Table table;
  table.title = "Figure 6: accuracy against training images and depth";
  table.columns = {"images",          "depth",        "mean class accuracy, %",
                   "pixels right, %", "mAP 10 cm, %", "mAP 10 cm, visible, %"};
  Curves accuracy;
  for (const int count : settings.images) {
    for (const int depth : settings.depths) {
      const Setting setting{count, depth, settings.trees};
      const Evaluation e = evaluator.EvaluateSetting(setting, settings.test_images);
      accuracy[count][depth] = e.mean_class_accuracy;
      table.rows.push_back({fmt::format("{}", setting.images), fmt::format("{}", setting.depth),
                            Percent(e.mean_class_accuracy), Percent(e.pixel_accuracy),
                            Percent(e.map_10cm), Percent(e.map_10cm_visible)});
    }
  }
  WriteFigures(out, accuracy);
  table.note =
      "MPFB bodies of test shapes, front views at 320 x 240, structured-light noise; far fewer "
      "images than the paper's.";
  if (settings.test_motion == settings.motion) {
    table.note +=
        " Tested on the motions it was trained on, by other bodies (of authored ones by other "
        "movers): for unseen motion name folders of subjects kept apart as motion and "
        "test_motion.";
  }
  return table;
}

Table ComputeFigureEight(ForestEvaluator& evaluator, const ShottonSettings& settings) {
  Table table;
  table.title = "Figure 8: average precision within 10 cm by joint, the shipped model";
  table.columns = {"joint", "AP, %", "AP where visible, %"};
  const Evaluation shipped = evaluator.EvaluateShipped(settings.test_images);
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    table.rows.push_back({std::string(recon::kJointNames[j]), Percent(shipped.ap_10cm.at(j)),
                          Percent(shipped.ap_10cm_visible.at(j))});
  }
  table.rows.push_back({"mean", Percent(shipped.map_10cm), Percent(shipped.map_10cm_visible)});
  if (settings.test_motion == "authored") {
    table.note = "Authored motions are among those that the shipped model was trained on.";
  }
  return table;
}

}  // namespace

void ReadShotton2011Parameters(ExperimentContext& context) { ReadSettings(context); }

std::vector<Table> RunShotton2011(ExperimentContext& context) {
  const ShottonSettings settings = ReadSettings(context);
  ForestEvaluator evaluator(context, settings);
  return {ComputeFigureSix(evaluator, settings, context.out),
          ComputeFigureEight(evaluator, settings)};
}

}  // namespace ossa::tools
