// Plantard 2016, figure 9: size and edges of the graph, nodes selected.
#include <fmt/format.h>

#include "recon/body/standard_body.h"
#include "recon/database/posture_database.h"
#include "recon/motion/mocap.h"
#include "tools/experiments/papers/plantard_2016_internal.h"

namespace ossa::tools {
namespace {

/// The clips from which the database was made. A graph built from its filtered nodes would have
/// longer edges than one built from all postures.
std::vector<recon::PostureClip> LoadDatabaseClips(ExperimentContext& context) {
  const std::string mocap = ReadDatabaseMotion(context.parameters);
  std::vector<recon::PostureClip> clips;
  for (const recon::MotionClip& clip : recon::LoadMocap({mocap}, {})) {
    recon::PostureClip& made = clips.emplace_back();
    made.name = clip.name;
    for (const recon::RigPose& pose : clip.frames) {
      made.postures.push_back(recon::StandardPosture(pose));
    }
  }
  return clips;
}

MethodRun WithThreshold(const MethodRun& base, const std::vector<recon::PostureClip>& clips,
                        double threshold_m) {
  MethodRun run = base;
  recon::DatabaseOptions options;
  options.threshold_m = threshold_m;
  const auto graph =
      std::make_shared<const recon::PostureDatabase>(recon::PostureDatabase::Build(clips, options));
  run.options.database = graph;
  run.database_key += fmt::format(" of clips {} {}", graph->source_postures(), threshold_m);
  return run;
}

MethodRun WithEdges(const MethodRun& base, const recon::PostureDatabase& database, int edges) {
  MethodRun run = base;
  run.options.database = std::make_shared<recon::PostureDatabase>(database.WithEdges(edges));
  run.database_key += fmt::format(" edges {}", edges);
  return run;
}

double EdgesPerNode(const recon::PostureDatabase& database) {
  return static_cast<double>(database.edge_count()) / database.size();
}

}  // namespace

std::string ReadDatabaseMotion(Parameters& parameters) {
  return parameters.Motion("database_mocap", "authored");
}

Table MakePlantard2016FigureNine(ExperimentContext& context, const MethodRun& method,
                                 const std::vector<RecordedPair>& hard) {
  Table table;
  table.title = "Figure 9: error and time by parameter (plantard-2016, scenarios 4-10)";
  table.columns = {"parameter", "value", "eq. 13, cm", "ms a frame"};
  const OpenDatabase database = LoadDatabase(context);
  const auto add = [&](const char* parameter, const std::string& value, const MethodRun& run) {
    const auto mean = MeanOverClips(run.label, MeasureAll(RunOverClips(context, run, hard)));
    table.rows.push_back({parameter, value, Cell(mean.parent_relative_error_cm),
                          Cell(MedianStep_ms(run, hard[0].observed))});
  };
  MethodRun base = method;
  base.database_key = ComputeFileKey(database.path);
  const auto clips = LoadDatabaseClips(context);
  for (const double threshold_m : context.full ? std::vector<double>{0.6, 0.4, 0.3, 0.2, 0.15, 0.1}
                                               : std::vector<double>{0.4, 0.2}) {
    const MethodRun run = WithThreshold(base, clips, threshold_m);
    const recon::PostureDatabase& graph = *run.options.database;
    add("filtered nodes (a)",
        fmt::format("{} (thres_1 = {} m, thres_2 = {:.2f} m, {:.1f} edges a node)", graph.size(),
                    threshold_m, graph.edge_threshold_m(), EdgesPerNode(graph)),
        run);
  }
  for (const int edges : context.full ? std::vector<int>{1, 2, 4, 8, 16} : std::vector<int>{2, 8}) {
    add("most edges a node (b)", std::to_string(edges), WithEdges(base, *database.postures, edges));
  }
  for (const int selected :
       context.full ? std::vector<int>{5, 10, 15, 20, 30, 50} : std::vector<int>{5, 15, 30}) {
    MethodRun run = base;
    run.options.local_pca.neighbours = selected;
    add("nodes selected, K (c)", std::to_string(selected), run);
  }
  table.note = fmt::format(
      "(a): graphs built of the clips that the database is of. Error against the truth in place of "
      "the paper's optimisation score. Whole database: {} "
      "nodes, {:.1f} edges a node; paper: 2048 nodes, 7.8 edges, K = 30 (no better than 15), 12.28 "
      "ms (shum-2013 14.53 ms).",
      database.postures->size(), EdgesPerNode(*database.postures));
  return table;
}

}  // namespace ossa::tools
