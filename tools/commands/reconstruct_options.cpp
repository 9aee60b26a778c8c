#include "tools/commands/reconstruct_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>

#include "recon/filters/butterworth.h"
#include "recon/methods/reconstruct_sequence.h"
#include "tools/commands/checks.h"
#include "tools/commands/command.h"
#include "tools/commands/parse_consistently.h"
#include "tools/commands/skeleton_reading_options.h"

namespace ossa::commands {
namespace {

void AddMethodOptions(CLI::App& app, ReconstructArguments& a) {
  auto methods = recon::ReconstructionMethods();
  methods.emplace_back(kButterworth);
  app.add_option("--method", a.options.method, "method of reconstruction")
      ->capture_default_str()
      ->check(CLI::IsMember(methods));
  app.add_option(
      "--database", a.files.database,
      "posture database, .ossadb (default: the shipped one; best uses the shipped prior instead)");
  app.add_option("--prior", a.files.prior,
                 ".ossaprior of 'ossa prior', for best (default: the shipped one)");
  app.add_option("--learned", a.files.learned,
                 ".ossagp of 'ossa learn', or none (default with best: the shipped correction if "
                 "the recording is a Kinect v2's or the refinement cascade's)");
  app.add_option("--seed", a.options.seed, "random seed of the stochastic search")
      ->capture_default_str();
  app.add_option("--cutoff", a.cutoff_hz, "cut-off frequency of butterworth, Hz")
      ->capture_default_str()
      ->check(Positive());
}

void AddLocalPcaOptions(CLI::App& app, ReconstructArguments& a) {
  recon::LocalPcaOptions& pca = a.options.local_pca;
  app.add_option("--solver", pca.solver,
                 "optimiser of shum-2013, plantard-2016: stochastic or ceres")
      ->capture_default_str()
      ->check(CLI::IsMember({"stochastic", "ceres"}));
  app.add_option("--neighbours", pca.neighbours, "K of the local PCA of shum-2013, plantard-2016")
      ->capture_default_str()
      ->check(CLI::Range(2, 100000));
  const std::tuple<const char*, int*, const char*> counts[] = {
      {"--dimensions", &pca.dimensions, "dimensions of that PCA"},
      {"--steps", &pca.steps, "steps of the search in its space"},
      {"--samples", &pca.samples, "samples per step of the stochastic search"}};
  for (const auto& [name, value, meaning] : counts) {
    app.add_option(name, *value, meaning)->capture_default_str()->check(CLI::Range(1, 100000));
  }
  app.add_option("--weights", a.weights,
                 "weights of control, style, kinematics, continuity (Shum 2013 eq. 15)")
      ->expected(4)
      ->delimiter(',');
  app.add_flag("--no-reliability", a.no_reliability, "method B of Shum 2013");
  app.add_flag("--keep-reliable", pca.keep_reliable,
               "shum-2013, plantard-2016: reliable joints keep their observed positions (not in "
               "the papers)");
  app.add_flag("--extend", pca.extend_database,
               "shum-2013: add reliable postures to the database (sec. IX)");
}

void AddLagOption(CLI::App& app, ReconstructArguments& a) {
  app.add_option("--lag", a.lag,
                 "later frames used to smooth each frame: 0 to 2, or whole, the whole recording "
                 "(default: whole with best, else 0)")
      ->check(CLI::IsMember({"0", "1", "2", "whole"}));
}

void AddDynamicsOptions(CLI::App& app, ReconstructArguments& a) {
  a.floor.AddTo(app);
  app.add_option("--dynamics", a.dynamics,
                 "inverse dynamics of the character as CSV: torques of joints, forces of the "
                 "ground, centre of pressure (needs --physics on and a floor)");
  app.add_option(
         "--mass", a.mass_kg,
         "mass of the person, kg, for --dynamics (default: estimated from the bone lengths)")
      ->check(CLI::Range(3.0, 400.0));
}

void CheckDynamics(const ReconstructArguments& a) {
  if (a.dynamics.empty() && a.mass_kg > 0.0)
    throw Contradiction("--mass: expected --dynamics with it");
  if (!a.dynamics.empty() && (!a.mechanics.on() || !a.mechanics.scene.empty())) {
    throw Contradiction("--dynamics: expected --physics on with it, and no --scene");
  }
}

void DeclareOptions(CLI::App& app, ReconstructArguments& a) {
  app.add_option("SKELETONS", a.skeletons, "skeleton JSONL or a recording of an SDK")->required();
  app.add_option("--out", a.out,
                 "result: .jsonl .bvh .glb .trc .csv, or a folder for many recordings")
      ->required();
  a.write.AddTo(app);
  a.write.AddSurfaceTo(app);
  AddMethodOptions(app, a);
  AddLocalPcaOptions(app, a);
  a.bones.AddTo(app);
  AddLagOption(app, a);
  AddMechanicsOptions(app, a.mechanics);
  AddDynamicsOptions(app, a);
  AddSkeletonReadingOptions(app, a.read);
  app.add_flag("--quiet", a.quiet, "no progress");
  app.footer(std::string("Options that the method does not read are refused; files that it does "
                         "not read cause a warning.\n") +
             MappingHelp());
}

void CheckLocalPca(const CLI::App& app, const ReconstructArguments& a) {
  if (a.options.local_pca.solver == "ceres" && app.count("--samples") > 0) {
    throw Contradiction("--samples is not read by --solver ceres: expected --solver stochastic");
  }
  double largest = 0.0;
  for (const double weight : a.weights) {
    largest = std::max(largest, weight);
    if (weight >= 0 && std::isfinite(weight)) continue;
    throw UsageError(fmt::format("--weights: expected numbers from 0 up, found {}", weight));
  }
  if (!a.weights.empty() && largest == 0.0) {
    throw UsageError("--weights: expected one above 0, found zeros");
  }
}

void CheckArguments(const CLI::App& app, ReconstructArguments& a) {
  CheckRead(app, a.options.method);
  CheckLocalPca(app, a);
  CheckLearned(a.options.method, a.files.learned);
  a.bones.Check(a.options.method);
  a.write.Check(a.out);
  a.mechanics.Check();
  a.floor.Check();
  CheckDynamics(a);
  CheckOneOf(a.options.method, a.files.database, a.files.prior);
  CheckOutputs({a.out, a.dynamics}, {a.skeletons, a.read.mapping_file, a.mechanics.scene});
}

void PrintNotes(const CLI::App& app, const ReconstructArguments& a) {
  if (!a.quiet) PrintFilesNotRead(app, a.options.method);
}

void SetLocalPca(ReconstructArguments& a) {
  recon::LocalPcaOptions& pca = a.options.local_pca;
  pca.use_reliability = !a.no_reliability;
  double* const weights[] = {&pca.control, &pca.style, &pca.kinematics, &pca.continuity};
  for (size_t i = 0; i < a.weights.size(); ++i) *weights[i] = a.weights[i];
}

}  // namespace

ReconstructArguments ParseReconstructOptions(int argc, char** argv) {
  auto a =
      ParseConsistently<ReconstructArguments>({"Make recorded skeletons complete and plausible",
                                               DeclareOptions, CheckArguments, PrintNotes},
                                              argc, argv);
  SetLocalPca(a);
  return a;
}

recon::LagOptions LagFor(const ReconstructArguments& a) {
  const std::string usual = RequireMethodInfo(a.options.method).smoothed_in_files ? "whole" : "0";
  const std::string& lag = a.lag.empty() ? usual : a.lag;
  return recon::LagOptions::Of(lag == "whole" ? recon::kWholeRecording : std::stoi(lag),
                               KeepsBones(a.options.method));
}

}  // namespace ossa::commands
