// `ossa experiment person-classifier`: fits the classifier of people and furniture
// (tools/people/person_classifier_weights.inc, and the same _from_above).
#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <iterator>
#include <mutex>
#include <sstream>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "recon/motion/mocap.h"
#include "tools/experiments/experiments_internal.h"
#include "tools/experiments/indoor_scenes/indoor_scenes_internal.h"
#include "tools/experiments/indoor_scenes/person_weights_internal.h"
#include "tools/experiments/simulation/jobs.h"
#include "tools/people/feature_collector.h"
#include "tools/synth/frame_maker.h"
#include "tools/tracker/shipped.h"

namespace ossa::tools {
namespace {

// Constants: sizes of the set of examples, by hand.

using Eigen::VectorXd;

struct Example {
  bool person = false;
  std::vector<double> signs;
};

// Positive: mostly pixels of one person, and most of that person's. Negative: furniture, or a small
// part of a person. In between: no example.
std::optional<bool> IsPerson(const std::vector<int32_t>& pixels, const LabelledFrame& truth) {
  const PixelShares shares = MeasureShares(pixels, truth);
  if (shares.of_piece > 0.6 && shares.of_person > 0.5) return true;
  if (shares.of_piece < 0.2 || (shares.of_piece > 0.6 && shares.of_person < 0.25)) return false;
  return std::nullopt;
}

// A set of fitted weights: its camera, forest, file and arrays.
struct WeightSet {
  bool from_above;
  const char* forest;
  const char* file;
  const char* suffix;
};
constexpr WeightSet kLevel{false, "body.ossa", "person_classifier_weights.inc", ""};
constexpr WeightSet kUnderCeiling{true, "body_ceiling.ossa",
                                  "person_classifier_weights_from_above.inc", "FromAbove"};

std::filesystem::path ForestOf(const WeightSet& set, const ExperimentContext& context) {
  return context.model.empty() ? tracker::ShippedFile(set.forest) : context.model;
}

class Gatherer {
 public:
  Gatherer(ExperimentContext& context, const WeightSet& set, Split split, const std::string& mocap)
      : context_(context),
        set_(set),
        split_(split),
        collector_(ForestOf(set, context), set.from_above),
        clips_(recon::LoadMocap({mocap})),
        poses_(MakePoseBank(clips_)),
        floor_poses_(MakePoseBank(recon::LoadMocap({kFloorMotion}))) {}

  // Some frames of every scenario, and single frames of other rooms and views.
  std::vector<Example> Gather(int performances, uint64_t seed) {
    const recon::BodyModel model = LoadFetchedBody();
    const recon::Wardrobe wardrobe(model);
    std::vector<std::vector<Example>> examples(static_cast<size_t>(performances));
    std::mutex mutex;
    int done = 0;
    RunJobs(examples.size(), context_.threads, [&](size_t k) {
      if (set_.from_above) {
        UnderCeilings(seed + 100 * k, examples[k]);
      } else {
        const int width = k % 2 ? 640 : 320;
        const IndoorSceneInputs inputs{model, wardrobe, clips_, split_, width, width * 3 / 4, 90};
        AddIndoorScenes(inputs, seed + 100 * k, examples[k]);
        AddSofaScenes(inputs, seed + 100 * k + 50, examples[k]);
        for (const View view : {View::kFront, View::kAny, View::kNear})
          Singles({view, Background::kRoom, seed + k}, poses_, examples[k]);
        for (const View view : {View::kFront, View::kAny})
          Singles({view, Background::kLivedIn, seed + k}, floor_poses_, examples[k]);
      }
      const std::lock_guard lock(mutex);
      if (context_.progress) context_.progress(++done, performances, "scenes");
    });
    std::vector<Example> all;
    for (auto& some : examples) std::move(some.begin(), some.end(), std::back_inserter(all));
    return all;
  }

 private:
  void AddIndoorScenes(const IndoorSceneInputs& inputs, uint64_t seed,
                       std::vector<Example>& examples) {
    for (const IndoorScenario& scenario : IndoorScenarios())
      AddScenario(scenario, inputs, ++seed, examples);
  }

  // The other scenes rarely show head and shoulders alone.
  void AddSofaScenes(const IndoorSceneInputs& inputs, uint64_t seed,
                     std::vector<Example>& examples) {
    constexpr int kSeats = 10;
    const IndoorScenario scenario{"one, sofa before", 1, Furnishing::kSofaBefore};
    for (int i = 0; i < kSeats; ++i) AddScenario(scenario, inputs, ++seed, examples);
  }

  void AddScenario(const IndoorScenario& scenario, const IndoorSceneInputs& inputs, uint64_t seed,
                   std::vector<Example>& examples) {
    IndoorSceneRenderer renderer(scenario, inputs, seed);
    for (int64_t f = 5; f < renderer.size(); f += 20)
      CollectExamples(renderer.RenderFrame(f), examples);
  }

  // Random rooms; one in four without shelves and plants.
  void UnderCeilings(uint64_t seed, std::vector<Example>& examples) {
    constexpr int kRooms = 8;
    for (int i = 0; i < kRooms; ++i) {
      Singles({View::kCeiling, i % 4 == 0 ? Background::kRoom : Background::kLivedIn, ++seed},
              poses_, examples);
    }
  }

  struct Room {
    View view;
    Background background;
    uint64_t seed;
  };
  void Singles(const Room& room, const std::vector<recon::RigPose>& poses,
               std::vector<Example>& examples) {
    constexpr int kFrames = 12;
    FrameOptions options;
    options.width = 320;
    options.height = 240;
    options.view = room.view;
    options.split = split_;
    options.occluders = Occluders::kAny;
    options.background = room.background;
    options.people = room.view == View::kNear ? 1 : 2;
    options.seed = room.seed;
    const FrameInputs inputs(LoadFetchedBody(), poses, options);
    FrameMaker maker(inputs);
    for (int f = 0; f < kFrames; ++f) CollectExamples(maker.Make(8 * f), examples);
  }

  void CollectExamples(const LabelledFrame& frame, std::vector<Example>& examples) {
    context_.ThrowIfInterrupted();
    for (auto& seen : collector_.Collect(frame.depth)) {
      const auto person = IsPerson(seen.pixels, frame);
      if (person) examples.push_back({*person, std::move(seen.features)});
    }
  }

  ExperimentContext& context_;
  WeightSet set_;
  Split split_;
  people::FeatureCollector collector_;
  std::vector<recon::MotionClip> clips_;
  std::vector<recon::RigPose> poses_, floor_poses_;
};

// Cached, one line per example: fitting again with another prior takes seconds.
std::vector<Example> Examples(ExperimentContext& context, const WeightSet& set, Split split,
                              const std::string& mocap, int performances, uint64_t seed) {
  const auto compute = [&] {
    std::ostringstream text;
    text.precision(9);
    for (const Example& e : Gatherer(context, set, split, mocap).Gather(performances, seed)) {
      text << e.person;
      for (const double sign : e.signs) text << ' ' << sign;
      text << '\n';
    }
    return text.str();
  };
  std::istringstream lines(
      context.Cached(fmt::format("person signs{} {} {} {} {} {} {}", set.suffix, ComputeCodeKey(),
                                 static_cast<int>(split), mocap, performances, seed,
                                 ComputeFileKey(ForestOf(set, context))),
                     compute));
  std::vector<Example> examples;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    Example example;
    words >> example.person;
    for (double sign = 0; words >> sign;) example.signs.push_back(sign);
    if (example.signs.size() == people::PersonFeatureNames().size())
      examples.push_back(std::move(example));
  }
  return examples;
}

// Constant, signs, products of two: the order of tools/people/person_features.cpp.
VectorXd Terms(const std::vector<double>& signs, size_t count) {
  const auto n = static_cast<Eigen::Index>(count);
  VectorXd terms(1 + n + n * (n + 1) / 2);
  Eigen::Index next = 0;
  terms[next++] = 1;
  for (size_t i = 0; i < count; ++i) terms[next++] = signs[i];
  for (size_t i = 0; i < count; ++i) {
    for (size_t j = i; j < count; ++j) terms[next++] = signs[i] * signs[j];
  }
  return terms;
}

std::vector<LogisticExample> WithTerms(const std::vector<Example>& examples, size_t count) {
  std::vector<LogisticExample> all;
  all.reserve(examples.size());
  for (const Example& e : examples) all.push_back({e.person, Terms(e.signs, count)});
  return all;
}

Table FitWeights(ExperimentContext& context, const WeightSet& set) {
  const auto [train, check, performances, images, prior] = ReadPersonClassifierSettings(context);
  const uint64_t seed = context.seed * 1000000;
  const auto fitted = Examples(context, set, Split::kTrain, train, performances, seed);
  const auto checked =
      Examples(context, set, Split::kTest, check, std::max(1, performances / 4), seed + 500000);
  const size_t all = people::PersonFeatureNames().size(), surface = people::CountSurfaceFeatures();
  const VectorXd surface_weights = FitLogistic(WithTerms(fitted, surface), prior);
  const VectorXd weights = FitLogistic(WithTerms(fitted, all), prior);
  AtomicFile file(context.out / set.file);
  file.stream() << "// Written by `ossa experiment person-classifier`.\n"
                << ArrayText(fmt::format("kSurfaceWeights{}", set.suffix), surface_weights)
                << ArrayText(fmt::format("kPersonWeights{}", set.suffix), weights);
  file.Commit();
  Table table;
  table.title = set.from_above ? "People and other things under the ceiling, single observations"
                               : "People and other things, single observations";
  table.columns = kPassedColumns;
  AddPassedRows("fitted on, surface", surface_weights, WithTerms(fitted, surface), table);
  AddPassedRows("fitted on", weights, WithTerms(fitted, all), table);
  AddPassedRows("others, surface", surface_weights, WithTerms(checked, surface), table);
  AddPassedRows("others", weights, WithTerms(checked, all), table);
  table.note = fmt::format("Weights: {}, to be put into tools/people.", set.file);
  if (train == check)
    table.note += " Others: other bodies and rooms; their motions are those fitted on.";
  return table;
}

std::set<std::string> ReadParts(Parameters& parameters) {
  return parameters.Some("parts", {"forest", "ceiling", "pose"});
}

}  // namespace

Table FitForestWeights(ExperimentContext& context) { return FitWeights(context, kLevel); }
Table FitForestWeightsFromAbove(ExperimentContext& context) {
  return FitWeights(context, kUnderCeiling);
}

PersonClassifierSettings ReadPersonClassifierSettings(ExperimentContext& context) {
  constexpr double kLeastPrior = 1e-9;  // by hand: weights need one, however weak
  Parameters& parameters = context.parameters;
  return {parameters.Motion("mocap", "authored"), parameters.Motion("check_mocap", "authored"),
          parameters.Integer("performances", context.full ? 60 : 8, 2),
          parameters.Integer("images", context.full ? 300 : 150, 1),
          parameters.Number("prior", 1.0, kLeastPrior)};
}

void ReadPersonClassifierParameters(ExperimentContext& context) {
  ReadParts(context.parameters);
  ReadPersonClassifierSettings(context);
}

std::vector<Table> RunPersonClassifier(ExperimentContext& context) {
  const auto parts = ReadParts(context.parameters);
  std::vector<Table> tables;
  if (parts.count("forest") > 0) tables.push_back(FitForestWeights(context));
  if (parts.count("ceiling") > 0) tables.push_back(FitForestWeightsFromAbove(context));
  if (parts.count("pose") > 0) tables.push_back(FitPoseWeights(context));
  return tables;
}

}  // namespace ossa::tools
