// Liu 2016, figures 3 (posture budgeting), 7 (samples and number of local models) and 8 (the path
// of a hand).
#include <fmt/format.h>

#include "depth/base/atomic_file.h"
#include "recon/methods/recorded_pairs.h"
#include "recon/models/gaussian_process.h"
#include "recon/models/pairs.h"
#include "tools/experiments/compare/svg_plot.h"
#include "tools/experiments/papers/liu_2016_internal.h"

namespace ossa::tools {
namespace {

constexpr auto kHand = recon::Index(recon::Joint::kHandLeft);

// Inputs and outputs of one joint's regression.
struct Samples {
  Eigen::MatrixXd inputs;
  Eigen::MatrixXd outputs;
};

Samples MakeSamples(const std::vector<recon::PosturePair>& pairs) {
  std::vector<const recon::PosturePair*> known;
  for (const auto& pair : pairs) {
    if (pair.known[kHand] > 0) known.push_back(&pair);
  }
  Samples samples;
  samples.outputs.resize(static_cast<Eigen::Index>(known.size()), 3);
  for (size_t i = 0; i < known.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const Eigen::VectorXd feature = recon::JointFeature(known[i]->observed, kHand);
    if (i == 0) samples.inputs.resize(static_cast<Eigen::Index>(known.size()), feature.size());
    samples.inputs.row(row) = feature.transpose();
    samples.outputs.row(row) = known[i]->residual.position_m[kHand].transpose();
  }
  return samples;
}

Samples Rows(const Samples& samples, const std::vector<int>& rows) {
  return {samples.inputs(rows, Eigen::all), samples.outputs(rows, Eigen::all)};
}

double MeanError_cm(const recon::GaussianProcess& process, const Samples& test) {
  double sum_m = 0;
  for (Eigen::Index i = 0; i < test.inputs.rows(); ++i) {
    const Eigen::Vector3d truth = test.outputs.row(i).transpose();
    sum_m += (process.PredictMean(test.inputs.row(i).transpose()) - truth).norm();
  }
  return 100 * sum_m / static_cast<double>(std::max<Eigen::Index>(1, test.inputs.rows()));
}

Table FigureThree(const ExperimentContext& context, const Liu2016Study& study) {
  const size_t most = context.full ? 800 : 250;
  std::vector<recon::PosturePair> train;
  std::vector<recon::PosturePair> test;
  for (const RecordedPair& clip : study.recordings) {
    recon::AddPairs(clip.observed, clip.truth, clip.subject == study.folds[0] ? test : train);
  }
  const Samples all = MakeSamples(recon::Thinned(train, most));
  const Samples tests = MakeSamples(recon::Thinned(test, most));
  Table table;
  table.title = "Figure 3: posture budgeting, left hand";
  table.columns = {"samples kept, %", "samples", "error, cm"};
  if (all.inputs.rows() < 10 || tests.inputs.rows() < 1) return table;
  const auto parameters = recon::LearnParameters(all.inputs, all.outputs, {});
  for (const int percent : {100, 80, 60, 40, 20, 10}) {
    const int keep = std::max(2, static_cast<int>(all.inputs.rows() * percent / 100));
    const Samples kept =
        Rows(all, recon::BudgetedSamples(parameters, all.inputs, all.outputs, keep));
    const recon::GaussianProcess process(parameters, kept.inputs, kept.outputs);
    table.rows.push_back(
        {std::to_string(percent), std::to_string(keep), Cell(MeanError_cm(process, tests))});
  }
  table.note =
      "Paper: of 1120 walking samples 40 % can go while the error stays the same. Error of the "
      "predicted offset for the mover left out, standard body.";
  return table;
}

Table FigureSeven(const ExperimentContext& context, const Liu2016Study& study) {
  const std::vector<int> sizes =
      context.full ? std::vector<int>{10, 30, 50, 70} : std::vector<int>{10, 50};
  const std::vector<int> models =
      context.full ? std::vector<int>{1, 3, 5, 7, 9, 11} : std::vector<int>{1, 9};
  Table table;
  table.title = "Figure 7: error by samples S and nearby local models L, cm (crossing arms)";
  table.columns = {"S"};
  for (const int l : models) table.columns.push_back(fmt::format("L = {}", l));
  for (const int size : sizes) {
    recon::LearnOptions options;
    options.mixture.samples = size;
    options.full_samples = 20;  // the full processes and the correction are not used here
    options.correction.centres = 0;
    std::vector<std::string> row = {std::to_string(size)};
    for (const int l : models) {
      const auto with = [l](MethodRun& run) {
        run.options.gaussian_process.nearby_models = l;
        run.options.gaussian_process.incremental = false;
      };
      row.push_back(Cell(MeasureError(context, study, "cross_arms", "liu-2016", with, options)));
    }
    table.rows.push_back(row);
  }
  table.note = "Paper: little to gain beyond S = 50 and L = 9.";
  return table;
}

// The hand's height over time, as the paper's trajectory, beside its mean errors.
Table FigureEight(const ExperimentContext& context, const Liu2016Study& study) {
  Table table;
  table.title = "Figure 8: left hand, golf swing";
  table.columns = {"method", "paper, cm", "ours, cm"};
  const auto clips = study.TestClips("golf", study.folds[0]);
  if (clips.empty()) return table;
  struct Line {
    const char* label;
    const char* method;
    bool incremental;
    const char* paper_cm;
  };
  std::vector<Series> series;
  for (const Line& line :
       {Line{"raw", "none", false, "12.36"}, Line{"local GP offline", "liu-2016", false, "8.1"},
        Line{"local GP incremental", "liu-2016", true, "7.7"}}) {
    MethodRun run = study.Run(context, line.label, line.method, study.folds[0]);
    run.options.gaussian_process.incremental = line.incremental;
    const auto pairs = RunOverClips(context, run, {clips[0]});
    table.rows.push_back({line.label, line.paper_cm, Cell(Measure(pairs[0]).per_joint_cm[kHand])});
    if (series.empty()) series.push_back({"truth", {}, {}});
    const bool truth_drawn = !series[0].x.empty();
    Series path{line.label, pairs[0].time_s, {}};
    for (size_t f = 0; f < pairs[0].time_s.size(); ++f) {
      const auto& made = pairs[0].result[f];
      path.y.push_back(made.present[kHand] ? std::optional(made.position_m[kHand].y())
                                           : std::nullopt);
      if (truth_drawn) continue;
      series[0].x.push_back(pairs[0].time_s[f]);
      series[0].y.push_back(pairs[0].truth[f].position_m[kHand].y());
    }
    series.push_back(std::move(path));
  }
  AtomicFile file(context.out / "figure8.html");
  file.stream() << "<!doctype html><meta charset=\"utf-8\"><title>Figure 8</title>"
                << LinePlot(series, {"time, s", "height of the left hand, m", {}, {}});
  file.Commit();
  table.note = "The path is drawn in figure8.html.";
  return table;
}

}  // namespace

std::vector<Table> MakeLiu2016Figures(ExperimentContext& context, const Liu2016Study& study) {
  return {FigureThree(context, study), FigureSeven(context, study), FigureEight(context, study)};
}

}  // namespace ossa::tools
