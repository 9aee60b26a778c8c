#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
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

// Of the levels this run grew; a time, so that it has no place in a card.
void SayRate(const forest::TrainSummary& summary) {
  if (summary.split_seconds <= 0) return;
  const auto evaluations = static_cast<double>(summary.evaluations);
  Say(fmt::format("train: {} images, {:.3g} evaluations, {:.0f} M a second\n", summary.images,
                  evaluations, 1e-6 * evaluations / summary.split_seconds));
}

// Constants: chosen by hand.

constexpr size_t kArrangedImages = 40000;  // 60 numbers in 8 contexts ask for no more

constexpr int kForLabels = 10;  // of each 100 fresh frames; the refinement has the others

// Images of another source, until somebody has had enough: what is learned of joints reads most of
// its time.
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

// The second stage; how far it is to be trusted; and what its joints say of the labels.
forest::ForestModel Refined(const TrainArguments& a, const forest::ForestModel& model,
                            const forest::TrainingSource& held_out) {
  const tools::PersonSource fresh(a.refinement, {kForLabels, 100}, tools::Extent::kWholeImage);
  const tools::PersonSource fresher(a.refinement, {0, kForLabels}, tools::Extent::kWholeImage);
  Progress bar("refinement", a.quiet);
  forest::RefinementOptions options;
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

// Training images and those held out for proposals.
struct Sources {
  tools::PersonSource training;
  tools::PersonSource held_out;

  explicit Sources(const TrainArguments& a)
      : training(a.datasets, {a.validation.empty() ? kHeldOut : 0, 100}),
        held_out(a.validation.empty() ? a.datasets : a.validation,
                 {0, a.validation.empty() ? kHeldOut : 100}, tools::Extent::kWholeImage) {}

  static constexpr int kHeldOut = 4;  // of each 100 frames
};

// Before the hours of work that need them.
void CheckSizes(const TrainArguments& a, const Sources& sources) {
  if (a.validation.empty() && sources.training.size() == 0) {
    throw InputError(fmt::format(
        "{}: expected more than {} images, so many are held out for proposals where there is no "
        "--validation; found {}",
        a.datasets.front().string(), Sources::kHeldOut, sources.held_out.size()));
  }
  if (sources.held_out.size() == 0) {
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

// The model within --max-megabytes.
forest::ForestModel WithinLimit(const TrainArguments& a, const forest::ForestModel& model) {
  return a.max_bytes ? forest::FitInto(model, *a.max_bytes) : model;
}

// What was learned after the trees takes room, too.
void Write(const TrainArguments& a, const forest::ForestModel& model, std::string card) {
  forest::ForestData data = model.data();
  data.manifest = std::move(card);
  forest::WriteForestModel(a.out, WithinLimit(a, forest::ForestModel(std::move(data))));
}

// With validation frames the trees also get proposals, to be evaluated like a model of ours.
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

// Of other targets and contexts our truth says nothing, nor of other classes' labels.
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
  if (a.refinement.empty() || model.data().class_names == ours.class_names) return;
  throw InputError(name + ": classes: expected our parts for --refinement, found others");
}

int LearnAgain(const TrainArguments& a) {
  const forest::ForestModel old = forest::ReadForestModel(a.trees_of);
  CheckTellsPeople(old, a);
  const Sources sources(a);
  CheckSizes(a, sources);
  const forest::ForestModel learned =
      LearnJoints(a, WithinLimit(a, old), sources.training, sources.held_out);
  Write(a, learned, RenewCard(learned, a, sources.training));
  return 0;
}

// A checkpoint is hours of work: nobody is to lose it, or to wait for it, without a word.
void SayOfCheckpoint(const TrainArguments& a) {
  const bool is_there = fs::exists(a.checkpoint());
  if (a.quiet || is_there == a.options.resume) return;
  const char* what = is_there ? "left by a run that was cut off; without --resume this one begins "
                                "anew and replaces it"
                              : "not there: nothing to go on from, this run begins anew";
  Say(fmt::format("train: {}: {}\n", a.checkpoint().string(), what));
}

int TrainOnData(TrainArguments* a, const forest::Reducer& reducer) {
  forest::TrainOptions& o = a->options;
  const Sources sources(*a);
  CheckSizes(*a, sources);
  const tools::PersonSource& source = sources.training;
  o.fingerprint = source.fingerprint();
  o.checkpoint = a->checkpoint();
  if (reducer.rank() == 0) {
    AtomicFile::CheckWritable(o.checkpoint);
    SayOfCheckpoint(*a);
  }
  o.stop = Interrupted;
  Progress bar("train", a->quiet || reducer.rank() != 0);
  o.progress = [&](const forest::TrainProgress& p) { ShowProgress(&bar, p); };
  forest::TrainSummary summary;
  const forest::ForestModel trees =
      forest::Train(source, tools::BodyVocabulary(), o, reducer, &summary);
  if (reducer.rank() != 0) return 0;
  if (!a->quiet) SayRate(summary);
  Write(*a, LearnJoints(*a, WithinLimit(*a, trees), source, sources.held_out),
        MakeCard(*a, source, summary));
  fs::remove(o.checkpoint);
  return 0;
}

}  // namespace

int Train(int argc, char** argv) {
  const auto reducer = forest::MakeMpiReducer(&argc, &argv);
  TrainArguments arguments = ParseTrainOptions(argc, argv);
  if (!arguments.import_pcl.empty()) return ImportPcl(arguments);
  try {
    if (!arguments.trees_of.empty()) return LearnAgain(arguments);
    return TrainOnData(&arguments, *reducer);
  } catch (const TrainInterrupted& interruption) {
    const fs::path checkpoint = arguments.checkpoint();
    if (!arguments.trees_of.empty() || !fs::exists(checkpoint)) throw;
    throw InputError(fmt::format("train: {}: the same command with --resume goes on from {}",
                                 interruption.what(), checkpoint.string()));
  }
}

}  // namespace ossa::commands
