#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "depth/base/leftovers.h"
#include "depth/base/perceptron/train_perceptron.h"
#include "depth/base/train_interrupted.h"
#include "forest/import_pcl.h"
#include "forest/prune.h"
#include "forest/training/mpi_reducer.h"
#include "forest/training/train.h"
#include "tools/commands/command.h"
#include "tools/commands/commands.h"
#include "tools/commands/process.h"
#include "tools/commands/train_card.h"
#include "tools/commands/train_options.h"
#include "tools/commands/warnings.h"
#include "tools/learning/common_parts.h"
#include "tools/learning/person_source.h"

namespace ossa::commands {
namespace {

namespace fs = std::filesystem;

void ShowProgress(Progress* bar, const forest::TrainProgress& p) {
  const double total = p.trees * p.levels;
  if (p.level < 0) return bar->Update(0, total, "reading");
  if (p.level >= p.levels) return bar->Update(total - 1, total, "filling leaves and votes");
  bar->Update(
      p.tree * p.levels + p.level + 1, total,
      fmt::format("tree {} level {} nodes {} gain {:.3f} bits {:.0f} M evaluations/s {:.0f} "
                  "s left",
                  p.tree + 1, p.level + 1, p.nodes, p.mean_gain, p.evaluations_per_s * 1e-6,
                  p.seconds_left));
}

// The time of the levels grown in this run, which is not stored in a card.
void PrintRate(const forest::TrainSummary& summary) {
  if (summary.split_seconds <= 0) return;
  const auto evaluations = static_cast<double>(summary.evaluations);
  PrintError(fmt::format("train: {} images, {:.3g} evaluations, {:.0f} M a second\n",
                         summary.images, evaluations, 1e-6 * evaluations / summary.split_seconds));
}

// Constants: chosen by hand.

constexpr size_t kArrangedImages = 40000;  // 60 numbers in 8 contexts ask for no more

constexpr int kForLabels = 10;  // of each 100 new frames; the refinement uses the others

// Images of another source, until Ctrl-C: reading dominates the time of learning joints.
class InterruptedSource final : public forest::TrainingSource {
 public:
  explicit InterruptedSource(const forest::TrainingSource& source) : source_(source) {}

  size_t size() const override { return source_.size(); }
  forest::TrainingImage Read(size_t index) const override {
    if (Interrupted()) throw TrainInterrupted("interrupted while joints were learned");
    return source_.Read(index);
  }

 private:
  const forest::TrainingSource& source_;
};

// The second stage, its confidence calibration, and relabelling by its joints.
forest::ForestModel Refined(const TrainArguments& a, const forest::ForestModel& model,
                            const forest::TrainingSource& held_out) {
  const tools::PersonSource fresh(a.refinement, {kForLabels, 100}, tools::Extent::kWholeImage);
  const tools::PersonSource fresher(a.refinement, {0, kForLabels}, tools::Extent::kWholeImage);
  Progress bar("refinement", a.quiet);
  forest::RefinementOptions options = a.second_stage;
  options.seed = a.options.seed;
  options.threads = a.options.threads;
  options.stop = Interrupted;
  options.progress = [&](int64_t done, int64_t total) {
    bar.Update(static_cast<double>(done), static_cast<double>(total));
  };
  const forest::ForestModel refined =
      forest::LearnRefinement(model, tools::MirroredSource(fresh), options);
  const forest::ForestModel sure =
      forest::LearnConfidences(refined, held_out, a.validation_images, a.options.threads);
  return forest::LearnRelabelling(sure, InterruptedSource(fresher), a.options.seed,
                                  a.options.threads);
}

forest::ForestModel LearnJoints(const TrainArguments& a, const forest::ForestModel& model,
                                const tools::PersonSource& source,
                                const tools::PersonSource& held_out) {
  const int threads = a.options.threads;
  const InterruptedSource validation(held_out);
  const forest::ForestModel arranged =
      forest::LearnPosePriors(model, InterruptedSource(source), kArrangedImages, threads);
  const forest::ForestModel proposing =
      forest::LearnProposals(arranged, validation, a.validation_images, threads);
  return a.refinement.empty() ? proposing : Refined(a, proposing, validation);
}

constexpr int kHeldOut = 4;  // of each 100 frames, without --validation; by hand

TrainData OpenData(const TrainArguments& a) {
  const bool apart = !a.validation.empty();
  return {
      {a.datasets, {apart ? 0 : kHeldOut, 100}},
      {apart ? a.validation : a.datasets, {0, apart ? 100 : kHeldOut}, tools::Extent::kWholeImage}};
}

// Checked before the training that needs them.
void CheckSizes(const TrainArguments& a, const TrainData& data) {
  if (a.validation.empty() && data.training.size() == 0) {
    throw InputError(fmt::format(
        "{}: expected more than {} images, so many are held out for proposals where there is no "
        "--validation; found {}",
        a.datasets.front().string(), kHeldOut, data.held_out.size()));
  }
  if (data.held_out.size() == 0) {
    throw InputError(a.validation.front().string() +
                     ": expected images for --validation, found none");
  }
  if (a.refinement.empty()) return;
  const tools::PersonSource fresh(a.refinement, {kForLabels, 100}, tools::Extent::kWholeImage);
  constexpr Eigen::Index kFewest = kPerceptronBatch / 2;  // each also mirrored
  if (static_cast<Eigen::Index>(fresh.size()) >= kFewest) return;
  throw InputError(fmt::format(
      "{}: expected at least {} images for --refinement besides the first {} of each 100, which "
      "the labels have; found {}",
      a.refinement.front().string(), kFewest, kForLabels, fresh.size()));
}

// The trees are overconfident on the images that they were grown on.
std::vector<std::string> FindDataUsedTwice(const TrainArguments& a) {
  std::vector<std::string> warnings;
  const auto look = [&](const char* option, const std::vector<fs::path>& others) {
    for (const fs::path& other : others) {
      const bool is_trained_on =
          std::any_of(a.datasets.begin(), a.datasets.end(),
                      [&](const fs::path& d) { return fs::equivalent(d, other); });
      if (!is_trained_on) continue;
      warnings.push_back(fmt::format(
          "{} {}: the trees are grown on it, too: the trees are more accurate there than on other "
          "images, and what is learned from it is too optimistic",
          option, other.string()));
    }
  };
  look("--validation", a.validation);
  look("--refinement", a.refinement);
  return warnings;
}

// The model within --max-megabytes.
forest::ForestModel FitToSizeLimit(const TrainArguments& a, const forest::ForestModel& model) {
  return a.max_bytes ? forest::FitInto(model, *a.max_bytes) : model;
}

// The parts learned after the trees take space, too.
void Write(const TrainArguments& a, const forest::ForestModel& model, std::string card) {
  forest::ForestData data = model.data();
  data.manifest = std::move(card);
  forest::WriteForestModel(a.out, FitToSizeLimit(a, forest::ForestModel(std::move(data))));
}

// With validation frames the trees also get proposals, so that they can be evaluated like a
// complete model.
int ImportPcl(const TrainArguments& a) {
  forest::ForestModel model = forest::ImportPclTrees(a.import_pcl);
  if (!a.validation.empty()) {
    forest::ForestData data = model.data();
    data.targets = tools::PclTargets(data.class_names);
    model = forest::LearnProposals(forest::ForestModel(std::move(data)),
                                   tools::PersonSource(a.validation, {0, 100}), a.validation_images,
                                   a.options.threads);
  }
  Write(a, model, model.manifest());
  return 0;
}

// The truth has no other targets and contexts, nor other classes' labels.
void CheckTellsPeople(const forest::ForestModel& model, const TrainArguments& a) {
  const forest::TrainingVocabulary ours = tools::BodyVocabulary();
  const std::string name = a.trees_of.string();
  const bool has_joints =
      std::ranges::equal(model.targets(), ours.targets, {}, &forest::ProposalTarget::name,
                         &forest::ProposalTarget::name);
  if (!has_joints) {
    throw InputError(fmt::format("{}: targets: expected the {} joints, found {} others", name,
                                 ours.targets.size(), model.targets().size()));
  }
  if (model.context_count() > 1 && model.data().context_names != ours.context_names) {
    throw InputError(name + ": contexts: expected facing sectors or a single one, found others");
  }
  if (a.datasets.empty() && model.data().pose_priors.empty()) {
    throw InputError(name + ": pose prior: expected one where no DATASET is given, found none");
  }
  if (a.refinement.empty() || model.data().class_names == ours.class_names) return;
  throw InputError(name + ": classes: expected our parts for --refinement, found others");
}

int RelearnProposals(const TrainArguments& a) {
  const forest::ForestModel old = forest::ReadForestModel(a.trees_of);
  CheckTellsPeople(old, a);
  const TrainData data = OpenData(a);
  CheckSizes(a, data);
  const forest::ForestModel trees = FitToSizeLimit(a, old);
  const forest::ForestModel learned = a.datasets.empty()
                                          ? Refined(a, trees, InterruptedSource(data.held_out))
                                          : LearnJoints(a, trees, data.training, data.held_out);
  Write(a, learned, UpdateCard(learned, a, data.training));
  return 0;
}

// A checkpoint is hours of work: it is neither deleted nor waited for without a message.
void PrintCheckpoint(const TrainArguments& a) {
  const bool is_there = fs::exists(a.checkpoint());
  if (a.quiet || is_there == a.options.resume) return;
  const char* what = is_there ? "left by an interrupted run; without --resume this one starts over "
                                "and replaces it"
                              : "not there: nothing to resume, this run starts over";
  PrintError(fmt::format("train: {}: {}\n", a.checkpoint().string(), what));
}

// A rerun script of trainings skips the finished ones.
bool IsFinishedAlready(const TrainArguments& a, const TrainData& data) {
  if (!a.options.resume || fs::exists(a.checkpoint()) || !fs::exists(a.out)) return false;
  try {
    return HasSameInputs(forest::ReadForestModel(a.out).manifest(), a, data);
  } catch (const InputError&) {
    return false;  // no model, or of another version
  }
}

int TrainOnData(TrainArguments* a, const forest::Reducer& reducer) {
  forest::TrainOptions& o = a->options;
  const TrainData data = OpenData(*a);
  CheckSizes(*a, data);
  if (reducer.rank() == 0) PrintWarnings("train", FindDataUsedTwice(*a));
  if (IsFinishedAlready(*a, data)) {
    if (!a->quiet && reducer.rank() == 0) {
      PrintError(fmt::format("train: {}: is there already, made by this command of this data\n",
                             a->out.string()));
    }
    return 0;
  }
  o.fingerprint = data.training.fingerprint();
  o.checkpoint = a->checkpoint();
  if (reducer.rank() == 0) {
    AtomicFile::CheckWritable(o.checkpoint);
    RemoveLeftoversOf(o.checkpoint);  // of runs that were killed while writing it or the model
    RemoveLeftoversOf(a->out);
    PrintCheckpoint(*a);
  }
  o.stop = Interrupted;
  Progress bar("train", a->quiet || reducer.rank() != 0);
  o.progress = [&](const forest::TrainProgress& p) { ShowProgress(&bar, p); };
  forest::TrainSummary summary;
  const forest::ForestModel trees =
      forest::Train(data.training, tools::BodyVocabulary(), o, reducer, &summary);
  if (reducer.rank() != 0) return 0;
  if (!a->quiet) PrintRate(summary);
  Write(*a, LearnJoints(*a, FitToSizeLimit(*a, trees), data.training, data.held_out),
        MakeCard(*a, data, summary));
  fs::remove(o.checkpoint);
  return 0;
}

}  // namespace

int Train(int argc, char** argv) {
  const auto reducer = forest::MakeMpiReducer(&argc, &argv);
  TrainArguments arguments = ParseTrainOptions(argc, argv);
  if (!arguments.import_pcl.empty()) return ImportPcl(arguments);
  try {
    if (!arguments.trees_of.empty()) return RelearnProposals(arguments);
    return TrainOnData(&arguments, *reducer);
  } catch (const TrainInterrupted& interruption) {
    const fs::path checkpoint = arguments.checkpoint();
    if (!arguments.trees_of.empty() || !fs::exists(checkpoint)) throw;
    throw InputError(fmt::format("train: {}: the same command with --resume goes on from {}",
                                 interruption.what(), checkpoint.string()));
  }
}

}  // namespace ossa::commands
