#include "tools/experiments/experiment.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "tools/json/json_text.h"

namespace ossa::tools {
namespace {

std::string ReadAll(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(path.string() + ": cannot be opened for reading");
  std::ostringstream text;
  text << file.rdbuf();
  return std::move(text).str();
}

void WriteAll(const std::filesystem::path& path, const std::string& text) {
  AtomicFile file(path);
  file.stream() << text;
  file.Commit();
}

// ComputeFileKey() of this program and of each ossa library that it has loaded.
std::string ComputeLoadedCodeKey() {
  std::set<std::string> libraries;
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);) {
    const size_t path = line.find('/');
    if (path == std::string::npos || line.rfind("/libossa_") == std::string::npos) continue;
    libraries.insert(line.substr(path));
  }
  std::string key = ComputeFileKey("/proc/self/exe");
  for (const std::string& library : libraries) key.append(" ").append(ComputeFileKey(library));
  return key;
}

// Checks the files and the folder that the user named before the study begins.
void RequireFiles(const ExperimentContext& context) {
  namespace fs = std::filesystem;
  if (!context.shared.empty() && !fs::is_directory(context.shared)) {
    throw InputError(context.shared.string() + ": no such folder; expected that of --shared");
  }
  for (const fs::path& file : {context.model, context.database}) {
    if (file.empty() || fs::is_regular_file(file)) continue;
    throw InputError(file.string() + ": no such file; expected a " +
                     (file == context.model ? "model" : "posture database"));
  }
}

}  // namespace

void ExperimentContext::ThrowIfInterrupted() const {
  if (interrupted && interrupted()) throw Interruption{};
}

std::string ExperimentContext::Cached(const std::string& key,
                                      const std::function<std::string()>& compute) const {
  const auto folder = out / "cache";
  const auto path = folder / (ContentHash(key) + ".txt");
  if (std::filesystem::exists(path)) {
    // The file begins with its key: a foreign or damaged file is computed again.
    const std::string text = ReadAll(path);
    const std::string begin = fmt::format("{}\n{}\n", key.size(), key);
    if (text.starts_with(begin)) return text.substr(begin.size());
  }
  ThrowIfInterrupted();
  const std::string result = compute();
  std::filesystem::create_directories(folder);
  WriteAll(path, fmt::format("{}\n{}\n{}", key.size(), key, result));
  return result;
}

std::string ContentHash(const std::string& text) {
  const XXH128_hash_t hash = XXH3_128bits(text.data(), text.size());
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

std::string ComputeFileKey(const std::filesystem::path& path) {
  return path.filename().string() + ":" + ContentHash(ReadAll(path));
}

std::string ComputeCodeKey() {
  static const std::string key = ComputeLoadedCodeKey();
  return key;
}

std::vector<Table> RunExperiment(const std::string& name, ExperimentContext& context) {
  const Experiment* found = FindExperiment(name);
  if (found == nullptr) {
    std::string known;
    for (const Experiment& e : Experiments()) known.append(" ").append(e.name);
    throw InputError("experiment '" + name + "': expected one of" + known);
  }
  RequireFiles(context);
  found->read_parameters(context);
  context.parameters.RequireAllUsed();
  std::filesystem::create_directories(context.out);
  const std::vector<Table> tables = found->run(context);
  std::string markdown =
      fmt::format("## ossa experiment {} (seed {})\n\n", found->name, context.seed);
  nlohmann::json summary = {{"experiment", found->name}, {"seed", context.seed}};
  for (const Table& table : tables) {
    markdown += ToMarkdown(table) + "\n";
    summary["tables"].push_back({{"title", table.title},
                                 {"columns", table.columns},
                                 {"rows", table.rows},
                                 {"note", table.note}});
  }
  WriteAll(context.out / "TABLE.md", markdown);
  WriteAll(context.out / "summary.json", JsonText(summary) + "\n");
  WriteAll(context.out / "parameters.toml",
           fmt::format("# ossa experiment {} --seed {}\n{}", found->name, context.seed,
                       context.parameters.Used()));
  return tables;
}

}  // namespace ossa::tools
