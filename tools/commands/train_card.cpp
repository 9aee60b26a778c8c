#include "tools/commands/train_card.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tools/json/json_text.h"

namespace ossa::commands {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// The last name of a path, also with a trailing slash.
std::string WithoutFolders(const fs::path& path) {
  return (path.has_filename() ? path : path.parent_path()).filename().string();
}

std::string LineWithoutFolders(const std::string& line) {
  std::istringstream words(line);
  std::string out;
  std::string word;
  while (words >> word) {
    if (!out.empty()) out += ' ';
    out += word.find('/') != std::string::npos ? WithoutFolders(word) : word;
  }
  return out;
}

// FNV-1a, 64 bits: identifies the data, without cryptographic strength.
uint64_t Fnv1a(const std::string& text) {
  uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : text) hash = (hash ^ static_cast<uint8_t>(c)) * 0x100000001b3ULL;
  return hash;
}

// "motion FOLDER: terms" as from `ossa render`, by the folder's name alone.
std::string TermsWithoutFolders(const std::string& terms) {
  constexpr std::string_view kMotion = "motion ";
  const size_t colon = terms.find(": ");
  if (!terms.starts_with(kMotion) || colon == std::string::npos) return terms;
  const fs::path folder = terms.substr(kMotion.size(), colon - kMotion.size());
  return std::string(kMotion) + WithoutFolders(folder) + terms.substr(colon);
}

using Manifests = std::vector<tools::DatasetManifest>;

void AddTerms(const Manifests& manifests, std::vector<std::string>* all) {
  for (const tools::DatasetManifest& manifest : manifests) {
    for (const std::string& words : manifest.terms) {
      const std::string terms = TermsWithoutFolders(words);
      const bool is_known = std::find(all->begin(), all->end(), terms) != all->end();
      if (!is_known) all->push_back(terms);
    }
  }
}

std::string HashOf(const TrainArguments& a, const TrainData& data) {
  std::string all = data.training.fingerprint() + "; held out: " + data.held_out.fingerprint();
  if (!a.refinement.empty()) {
    all += "; refinement: " + tools::PersonSource(a.refinement, {0, 100}).fingerprint();
  }
  return fmt::format("{:016x}", Fnv1a(all));
}

Json DescribeData(const Manifests& manifests) {
  auto data = Json::array();
  for (const tools::DatasetManifest& m : manifests) {
    data.push_back({{"command", LineWithoutFolders(m.command)}, {"frames", m.frames}});
  }
  return data;
}

Manifests RefinementManifests(const TrainArguments& a) {
  if (a.refinement.empty()) return {};
  return tools::PersonSource(a.refinement, {0, 100}).manifests();
}

}  // namespace

std::string DescribeCommand(int argc, char** argv) {
  std::string line = "ossa";
  for (int i = 0; i < argc; ++i) {
    const std::string word = argv[i];
    const size_t equals = word.starts_with("--") ? word.find('=') : std::string::npos;
    const std::string name = word.substr(0, equals);
    if (name == "--resume" || name == "--quiet") continue;
    if (name == "--threads" || name == "--memory" || name == "--out") {
      if (equals == std::string::npos) ++i;
      continue;
    }
    line.append(1, ' ').append(name);
    if (equals != std::string::npos) line.append(1, ' ').append(word.substr(equals + 1));
  }
  return LineWithoutFolders(line);
}

bool HasSameInputs(const std::string& card, const TrainArguments& a, const TrainData& data) {
  const auto json = Json::parse(card, nullptr, false);
  return json.is_object() && json.value("command", Json()) == Json(a.command) &&
         json.value("data_hash", Json()) == Json(HashOf(a, data));
}

std::string MakeCard(const TrainArguments& a, const TrainData& data,
                     const forest::TrainSummary& summary) {
  const tools::PersonSource& source = data.training;
  const Manifests refinement = RefinementManifests(a);
  std::vector<std::string> terms = a.terms;
  AddTerms(source.manifests(), &terms);
  AddTerms(refinement, &terms);
  Json card;
  card["command"] = a.command;
  card["data"] = DescribeData(source.manifests());
  if (!refinement.empty()) card["refinement_data"] = DescribeData(refinement);
  card["terms"] = terms;
  card["data_hash"] = HashOf(a, data);
  card["images"] = summary.images;
  card["class_balance"] = "equal shares of the classes present in each image";
  return tools::JsonText(card);
}

std::string UpdateCard(const forest::ForestModel& learned, const TrainArguments& a,
                       const tools::PersonSource& source) {
  auto card = Json::parse(learned.manifest(), nullptr, false);
  if (!card.is_object()) return learned.manifest();
  const Manifests refinement = RefinementManifests(a);
  std::vector<std::string> terms;
  for (const auto& known : card.value("terms", Json::array())) {
    if (known.is_string()) terms.push_back(known.get<std::string>());
  }
  terms.insert(terms.end(), a.terms.begin(), a.terms.end());
  AddTerms(source.manifests(), &terms);
  AddTerms(refinement, &terms);
  card["terms"] = terms;
  card["proposals_command"] = a.command;
  card.erase("accuracy");  // of the replaced proposals
  // Without --refinement relabelling stays as learned from the earlier data.
  const bool is_still_relabelled = refinement.empty() && !learned.data().relabelling.bias.empty();
  if (!is_still_relabelled) card.erase("refinement_data");
  if (!refinement.empty()) card["refinement_data"] = DescribeData(refinement);
  return tools::JsonText(card);
}

}  // namespace ossa::commands
