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

// Throws InputError where nothing can be noted in it.
nlohmann::ordered_json ReadCard(const std::string& path, const forest::ForestModel& model) {
  auto card = nlohmann::ordered_json::parse(model.manifest(), nullptr, false);
  const bool has_room =
      card.is_object() && (!card.contains("accuracy") || card["accuracy"].is_object());
  if (!has_room) throw InputError(path + ": expected a card that is a JSON object");
  return card;
}

void NoteInCard(const std::string& path, const forest::ForestModel& model, const std::string& name,
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

}  // namespace

int Evaluate(int argc, char** argv) {
  CLI::App app("Measure a body-part model on a labelled data set it was not trained on");
  std::string model_path;
  std::string dataset_path;
  std::string json_path;
  std::string report_path;
  std::string card_name;
  int64_t step = 1;
  bool quiet = false;
  app.add_option("MODEL", model_path, "a .ossa file")->required();
  app.add_option("DATASET", dataset_path, "a folder made by ossa render")->required();
  app.add_option("--json", json_path,
                 "write the numbers here, FILE.json (they are printed in any case)");
  app.add_option(
      "--report", report_path,
      "write a page here, FILE.html: accuracy by part and joint, confusion matrix, calibration, "
      "worst frames");
  app.add_option("--card", card_name,
                 "note the numbers in the model's card under this name (rewrites MODEL)");
  app.add_option("--every", step, "look at every N-th frame")
      ->capture_default_str()
      ->check(Positive());
  app.add_flag("--quiet", quiet, "no progress");
  Parse(app, argc, argv);
  if (json_path == "-") json_path.clear();  // stdout, as of track and compare: they are printed
  CheckNotOtherKind("--json", json_path, ".json");
  CheckExtension("--report", report_path, ".html");
  CheckOutputs({json_path, report_path}, {model_path, dataset_path});
  CheckWritable(json_path);
  CheckWritable(report_path);
  const forest::ForestModel model = forest::ReadForestModel(model_path);
  if (!card_name.empty()) {  // not after all the work
    CheckWritable(model_path);
    ReadCard(model_path, model);
  }
  const tools::DatasetReader dataset{std::filesystem::path(dataset_path)};
  Progress bar("evaluate", quiet);
  const tools::Evaluation evaluation =
      tools::Evaluate(model, model_path, dataset, step, [&](int64_t done, int64_t total) {
        bar.Update(static_cast<double>(done), static_cast<double>(total));
        return !Interrupted();
      });
  if (Interrupted()) throw InputError("evaluate: interrupted");
  const std::string json = tools::EvaluationJson(evaluation);
  fmt::print("{}", json);
  WriteText(json_path, json);
  WriteText(report_path, tools::EvaluationHtml(evaluation, model_path + " on " + dataset_path));
  if (!card_name.empty()) NoteInCard(model_path, model, card_name, json);
  return 0;
}

}  // namespace ossa::commands
