#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "forest/forest.h"
#include "tools/commands/checks.h"
#include "tools/commands/command.h"
#include "tools/commands/commands.h"
#include "tools/commands/outputs.h"
#include "tools/json/json_text.h"
#include "tools/learning/evaluate.h"

namespace ossa::commands {
namespace {

void CheckWritable(const std::string& path) {
  if (!path.empty()) AtomicFile::CheckWritable(path);
}

// Throws InputError if the model's card cannot be changed.
nlohmann::ordered_json ReadCard(const std::string& path, const forest::ForestModel& model) {
  auto card = nlohmann::ordered_json::parse(model.manifest(), nullptr, false);
  const bool has_room =
      card.is_object() && (!card.contains("accuracy") || card["accuracy"].is_object());
  if (!has_room) throw InputError(path + ": expected a card that is a JSON object");
  return card;
}

void AddToCard(const std::string& path, const forest::ForestModel& model, const std::string& name,
               const std::string& evaluation) {
  auto card = ReadCard(path, model);
  auto numbers = nlohmann::ordered_json::parse(evaluation);
  for (const char* detail :
       {"ap_10cm_visible", "confidence_of_seen_joints", "confidence_of_inferred_joints"}) {
    numbers.erase(detail);
  }
  card["accuracy"][name] = numbers;
  forest::ForestData data = model.data();
  data.manifest = tools::JsonText(card);
  forest::WriteForestModel(path, forest::ForestModel(std::move(data)));
}

struct EvaluateArguments {
  std::string model, dataset, json, report, card;
  int64_t step = 1;
  bool quiet = false;
};

void Declare(CLI::App& app, EvaluateArguments& a) {
  app.add_option("MODEL", a.model, "a .ossa file")->required();
  app.add_option("DATASET", a.dataset, "a folder made by ossa render")->required();
  app.add_option("--json", a.json,
                 "write the numbers here, FILE.json (they are printed in any case)");
  app.add_option(
      "--report", a.report,
      "write a page here, FILE.html: accuracy by part and joint, confusion matrix, calibration, "
      "worst frames");
  app.add_option("--card", a.card,
                 "note the numbers in the model's card under this name (rewrites MODEL)");
  app.add_option("--every", a.step, "evaluate every N-th frame")
      ->capture_default_str()
      ->check(Positive());
  app.add_flag("--quiet", a.quiet, "no progress");
}

void Check(const EvaluateArguments& a) {
  CheckNotOtherKind("--json", a.json, ".json");
  CheckExtension("--report", a.report, ".html");
  CheckOutputs({a.json, a.report}, {a.model, a.dataset});
  CheckWritable(a.json);
  CheckWritable(a.report);
}

tools::Evaluation Measure(const EvaluateArguments& a, const forest::ForestModel& model) {
  const tools::DatasetReader dataset{std::filesystem::path(a.dataset)};
  Progress bar("evaluate", a.quiet);
  tools::Evaluation evaluation =
      tools::Evaluate(model, a.model, dataset, a.step, [&](int64_t done, int64_t total) {
        bar.Update(static_cast<double>(done), static_cast<double>(total));
        return !Interrupted();
      });
  if (Interrupted()) throw InputError("evaluate: interrupted");
  return evaluation;
}

}  // namespace

int Evaluate(int argc, char** argv) {
  CLI::App app("Measure a body-part model on a labelled data set it was not trained on");
  EvaluateArguments a;
  Declare(app, a);
  Parse(app, argc, argv);
  if (a.json == "-") a.json.clear();  // stdout, as in track and compare: they are printed
  Check(a);
  const forest::ForestModel model = forest::ReadForestModel(a.model);
  if (!a.card.empty()) {  // before the evaluation
    CheckWritable(a.model);
    ReadCard(a.model, model);
  }
  const tools::Evaluation evaluation = Measure(a, model);
  const std::string json = tools::EvaluationJson(evaluation);
  fmt::print("{}", json);
  DoEach("evaluate", {[&] { WriteText(a.json, json); },
                      [&] {
                        WriteText(a.report,
                                  tools::EvaluationHtml(evaluation, a.model + " on " + a.dataset));
                      },
                      [&] {
                        if (!a.card.empty()) AddToCard(a.model, model, a.card, json);
                      }});
  return 0;
}

}  // namespace ossa::commands
