// Liu, Zhou, Leung, Shum: Kinect posture reconstruction based on a local mixture of Gaussian
// process models (2016): tables 2 to 5; figures 3, 7 and 8 are in liu_2016_sweeps.cpp.
#include "tools/experiments/papers/liu_2016_internal.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "tools/experiments/experiments_internal.h"
#include "tools/experiments/simulation/motions.h"
#include "tools/experiments/simulation/recording_simulator.h"

namespace ossa::tools {
namespace {

struct Action {
  const char* name;   // of the authored clips
  const char* paper;  // in the tables
};

struct Row {
  Action action;
  std::vector<double> paper_cm;
};

const std::array<Row, 4> kTable3 = {{{{"cross_arms", "Crossing arms"}, {12.5, 9.8, 7.2, 7.9, 7.4}},
                                     {{"bend_over", "Bending over"}, {13.7, 9.5, 8.4, 9.2, 8.7}},
                                     {{"tai_chi", "Tai Chi"}, {14.5, 10.2, 7.5, 8.0, 7.4}},
                                     {{"wave", "Waving"}, {12.5, 8.8, 6.5, 6.9, 6.6}}}};
const std::array<Row, 6> kTable4 = {{{{"cross_arms", "Crossing hands"}, {13.7, 8.1}},
                                     {{"golf", "Golf swinging"}, {14.8, 9.2}},
                                     {{"wave", "Waving hands"}, {13.3, 7.2}},
                                     {{"roll_hands_up_down", "Rolling hands"}, {13.5, 7.5}},
                                     {{"clap", "Clapping hands"}, {14.2, 8.3}},
                                     {{"t_pose", "T-pose"}, {7.9, 7.1}}}};

std::vector<std::string> AllActions() {
  std::set<std::string> actions;
  for (const Row& row : kTable3) actions.insert(row.action.name);
  for (const Row& row : kTable4) actions.insert(row.action.name);
  return {actions.begin(), actions.end()};
}

/// Number of training frames of the first fold, and of samples that the methods keep.
Table TableTwo(const ExperimentContext& context, const Liu2016Study& study) {
  Table table;
  table.title = "Table 2: sizes of the databases";
  table.columns = {"", "frames", "local GP, samples", "full GP (Zhou 2014)",
                   "exemplar (Shen 2012)"};
  const std::string& tested = study.folds.at(0);
  for (const std::string& action : AllActions()) {
    size_t frames = 0;
    for (const RecordedPair& clip : study.recordings) {
      if (clip.subject == tested || !clip.clip.starts_with(action)) continue;
      frames += clip.observed.frames.size();
    }
    table.rows.push_back({action, std::to_string(frames), "", "", ""});
  }
  const auto learned =
      recon::LearnedModels::Load(study.Run(context, "", "liu-2016", tested).options.learned_file);
  size_t joints = 0, local = 0, full = 0;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    if (learned.mixtures[j].empty()) continue;
    ++joints;
    full += static_cast<size_t>(learned.full[j].size());
    for (const auto& model : learned.mixtures[j].models()) {
      local += static_cast<size_t>(model.size());
    }
  }
  const size_t by = std::max<size_t>(joints, 1);
  table.rows.push_back({"mixed", std::to_string(learned.pair_count), std::to_string(local / by),
                        std::to_string(full / by), std::to_string(learned.exemplars.size())});
  table.note =
      "Frames recorded of the movers that are learned from; mixed: pairs in the file, and the "
      "samples of a joint, mean over joints. Paper: 2 501 (local GP) and 16 500 (exemplar), mixed.";
  return table;
}

Table TableThree(const ExperimentContext& context, const Liu2016Study& study) {
  Table table;
  table.title = "Table 3: mean joint error (eq. 23), cm; paper / ours";
  table.columns = {"motion",
                   "frames",
                   "raw",
                   "exemplar (Shen 2012)",
                   "full GP (Zhou 2014)",
                   "local GP offline",
                   "local GP incremental"};
  const auto offline = [](MethodRun& run) { run.options.gaussian_process.incremental = false; };
  for (const Row& row : kTable3) {
    size_t frames = 0;
    for (const std::string& mover : study.folds) {
      for (const auto& clip : study.TestClips(row.action.name, mover)) {
        frames += clip.truth.frames.size();
      }
    }
    const std::array ours = {MeasureError(context, study, row.action.name, "none"),
                             MeasureError(context, study, row.action.name, "exemplar"),
                             MeasureError(context, study, row.action.name, "full-gp"),
                             MeasureError(context, study, row.action.name, "liu-2016", offline),
                             MeasureError(context, study, row.action.name, "liu-2016")};
    std::vector<std::string> cells = {row.action.paper, std::to_string(frames)};
    for (size_t m = 0; m < ours.size(); ++m) {
      cells.push_back(fmt::format("{} / {}", Cell(row.paper_cm[m], 1), Cell(ours[m])));
    }
    table.rows.push_back(cells);
  }
  table.note = study.note + "Learned from every action by the other movers at once.";
  return table;
}

Table TableFour(const ExperimentContext& context, const Liu2016Study& study) {
  Table table;
  table.title = "Table 4: forest alone against local GP, one mover left out in turn, cm";
  table.columns = {"motion",   "paper forest",  "paper local GP",
                   "ours raw", "ours local GP", "ours best, learned"};
  for (const Row& row : kTable4) {
    const std::string action = row.action.name;
    table.rows.push_back({row.action.paper, Cell(row.paper_cm[0], 1), Cell(row.paper_cm[1], 1),
                          Cell(MeasureError(context, study, action, "none")),
                          Cell(MeasureError(context, study, action, "liu-2016")),
                          Cell(MeasureError(context, study, action, "best"))});
  }
  table.note =
      "The paper trains its forest on the same 17 000 synthetic frames as its Gaussian processes; "
      "here the forest is the shipped one, trained on other bodies and cameras.";
  return table;
}

Table TableFive(const ExperimentContext& context, const Liu2016Study& study) {
  Table table;
  table.title = "Table 5: terms of eq. 22 (Tai Chi, bending over, crossing arms), cm";
  table.columns = {"setup", "terms", "paper", "ours"};
  struct Setup {
    const char* name;
    const char* terms;
    double paper_cm;
    bool temporal, reliability;
  };
  for (const Setup& setup : {Setup{"(a)", "spatial", 12.0, false, false},
                             Setup{"(b)", "spatial, temporal", 10.5, true, false},
                             Setup{"(c)", "spatial, reliability", 9.7, false, true},
                             Setup{"(d)", "all three", 7.9, true, true}}) {
    double sum_cm = 0;
    int count = 0;
    for (const char* action : {"tai_chi", "bend_over", "cross_arms"}) {
      const auto error = MeasureError(context, study, action, "liu-2016", [&](MethodRun& run) {
        if (!setup.temporal) run.options.gaussian_process.temporal = 0.0;
        if (!setup.reliability) run.options.gaussian_process.reliability = 0.0;
        run.options.gaussian_process.incremental = false;
      });
      if (!error) continue;
      sum_cm += *error;
      ++count;
    }
    table.rows.push_back(
        {setup.name, setup.terms, Cell(setup.paper_cm, 1), count > 0 ? Cell(sum_cm / count) : "-"});
  }
  return table;
}

/// Each mover has its own body.
uint64_t BodyOf(const std::string& mover, std::map<std::string, uint64_t>* bodies) {
  const auto known = bodies->find(mover);
  if (known != bodies->end()) return known->second;
  auto body = static_cast<uint64_t>(ContentHash(mover)[0]);
  const auto taken = [&](const auto& other) { return other.second == body; };
  while (std::any_of(bodies->begin(), bodies->end(), taken)) ++body;
  return bodies->emplace(mover, body).first->second;
}

}  // namespace

Liu2016Settings ReadLiu2016Settings(ExperimentContext& context) {
  Liu2016Settings settings;
  settings.observer = ReadObserver(context.parameters);
  settings.movers = context.parameters.Integer("movers", context.full ? 5 : 3, 2);
  settings.frames = context.parameters.Integer("frames", context.full ? 240 : 120, 2);
  settings.folds =
      context.parameters.Integer("folds", context.full ? settings.movers : 1, 1, settings.movers);
  return settings;
}

Liu2016Study::Liu2016Study(ExperimentContext& context) {
  const auto [observer, movers, frames, tested] = ReadLiu2016Settings(context);
  note = ObserverNote(observer) +
         fmt::format(
             "Motions: ossa's authored actions by {} movers, {} frames each, {} of them "
             "tested with the others learned from. ",
             movers, frames, tested);
  prior = LoadPrior(context);
  RecordingSimulator simulator(context, observer);
  const auto clips = AuthoredMotions(context, AllActions(), movers);
  std::set<std::string> names;
  std::map<std::string, uint64_t> bodies;
  for (size_t i = 0; i < clips.size(); ++i) {
    SequenceOptions sequence;
    sequence.name = clips[i].name.substr(clips[i].name.find('/') + 1);
    sequence.frames = frames;
    const std::string mover = sequence.name.substr(sequence.name.find('/') + 1);
    sequence.seed = context.seed * 1000 + BodyOf(mover, &bodies);
    if (context.progress) {
      context.progress(static_cast<double>(i), static_cast<double>(clips.size()),
                       "rendering " + sequence.name);
    }
    recordings.push_back(simulator.Record(clips[i], sequence));
    recordings.back().subject = mover;
    names.insert(mover);
  }
  for (const std::string& name : names) {
    if (static_cast<int>(folds.size()) < tested) folds.push_back(name);
  }
}

std::vector<RecordedPair> Liu2016Study::TestClips(const std::string& action,
                                                  const std::string& mover) const {
  std::vector<RecordedPair> clips;
  for (const RecordedPair& clip : recordings) {
    if (clip.subject == mover && clip.clip.starts_with(action)) clips.push_back(clip);
  }
  return clips;
}

MethodRun Liu2016Study::Run(const ExperimentContext& context, const std::string& label,
                            const std::string& method, const std::string& mover,
                            const recon::LearnOptions& learn) const {
  MethodRun run{label, {}, {}};
  run.options.method = method;
  run.options.seed = context.seed;
  if (method == "none") return run;
  run.options.learned_file = LearnWithout(context, recordings, mover, learn).string();
  if (recon::RequireMethod(method).prior) {
    run.options.database = LoadDatabase(context).postures;
    run.options.prior = prior;
  }
  return run;
}

std::optional<double> MeasureError(const ExperimentContext& context, const Liu2016Study& study,
                                   const std::string& action, const std::string& method,
                                   const std::function<void(MethodRun&)>& prepare,
                                   const recon::LearnOptions& learn) {
  std::vector<ClipMetrics> clips;
  for (const std::string& mover : study.folds) {
    MethodRun run = study.Run(context, method, method, mover, learn);
    if (prepare) prepare(run);
    for (const ClipMetrics& clip :
         MeasureAll(RunOverClips(context, run, study.TestClips(action, mover)))) {
      clips.push_back(clip);
    }
  }
  return MeanOverClips(method, clips).mean_joint_error_cm;
}

void ReadLiu2016Parameters(ExperimentContext& context) {
  ReadLiu2016Settings(context);
  ReadUsesPrior(context.parameters);
}

std::vector<Table> RunLiu2016(ExperimentContext& context) {
  const Liu2016Study study(context);
  std::vector<Table> tables = {TableTwo(context, study), TableThree(context, study),
                               TableFour(context, study), TableFive(context, study)};
  for (Table& table : MakeLiu2016Figures(context, study)) tables.push_back(std::move(table));
  return tables;
}

}  // namespace ossa::tools
