#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <filesystem>
#include <string>

#include "depth/error.h"
#include "forest/forest.h"
#include "tools/commands/command.h"
#include "tools/commands/commands.h"
#include "tools/synth/dataset.h"

namespace ossa::commands {
namespace {

namespace fs = std::filesystem;

// A kind of file: how it is known, and what is said of it.
struct FileKind {
  bool (*is)(const fs::path&);
  void (*show)(const fs::path&);
};

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
             m.camera.width, m.camera.height, m.seed, m.split, m.view, m.command);
  for (const std::string& source : m.sources) fmt::print("motion: {}\n", source);
  for (const std::string& terms : m.terms) fmt::print("terms: {}\n", terms);
}

constexpr std::array kKinds = {
    FileKind{forest::IsForestModel, ShowModel},
    FileKind{tools::IsDataset, ShowDataset},
};

}  // namespace

int Info(int argc, char** argv) {
  CLI::App app(
      "Say what a file of ossa's holds: a model's card, a database's size, a data set's origin");
  std::string file;
  app.add_option("FILE", file, "a .ossa, .ossadb, .ossagp or .oni file, or a DATASET folder")
      ->required();
  Parse(app, argc, argv);
  if (!fs::exists(file)) throw InputError(file + ": no such file or folder");
  for (const FileKind& kind : kKinds) {
    if (!kind.is(file)) continue;
    kind.show(file);
    return 0;
  }
  throw InputError(file + ": not a file that ossa knows");
}

}  // namespace ossa::commands
