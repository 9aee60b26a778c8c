#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "recon/body/body_model.h"
#include "recon/motion/mocap.h"
#include "tools/commands/checks.h"
#include "tools/commands/command.h"
#include "tools/commands/commands.h"
#include "tools/commands/mapping_option.h"
#include "tools/commands/outputs.h"
#include "tools/commands/warnings.h"
#include "tools/learning/learn_body_surface.h"

namespace ossa::commands {
namespace {

void EndIfInterrupted() {
  if (Interrupted()) throw InputError("surface: interrupted; nothing was written");
}

}  // namespace

int Surface(int argc, char** argv) {
  CLI::App app("Make the body that the surface fit poses: of MPFB shapes, clothes and motion");
  std::vector<std::string> mocap;
  std::string out, mesh;
  bool quiet = false;
  tools::BodySurfaceOptions options;
  recon::MocapOptions mocap_options;
  app.add_option("--mocap", mocap, "folders of BVH or AMC files, or the word authored")->required();
  app.add_option("--out", out, "the .ossasurface file to write")->required();
  app.add_option("--mesh", mesh, "the .ossamesh file to write: its skin as triangles, for .glb");
  app.add_option("--triangles", options.triangles, "of --mesh, about")
      ->capture_default_str()
      ->check(CLI::Range(200, 20000));
  app.add_option("--points", options.points, "places on the skin")
      ->capture_default_str()
      ->check(CLI::Range(size_t{50}, recon::BodySurface::kMostPoints));
  app.add_option("--people", options.people, "dressed bodies that shape is learned from")
      ->capture_default_str()
      ->check(CLI::Range(50, 5000));
  app.add_option("--seed", options.seed, "of their shapes and clothes")->capture_default_str();
  app.add_flag("--quiet", quiet, "no progress");
  AddMappingOption(app, mocap_options.mapping_file);
  Parse(app, argc, argv);
  CheckNotOtherKind("--out", out, ".ossasurface");
  CheckNotOtherKind("--mesh", mesh, ".ossamesh");
  std::vector<std::string> inputs = mocap;
  inputs.push_back(mocap_options.mapping_file);
  CheckOutputs({out, mesh}, inputs);
  AtomicFile::CheckWritable(out);
  if (!mesh.empty()) AtomicFile::CheckWritable(mesh);

  mocap_options.stop = Interrupted;
  const auto motion = recon::LoadMocap(mocap, mocap_options);
  SayWarnings("surface", motion);
  EndIfInterrupted();
  const auto model = recon::BodyModel::Load(recon::BodyFolder());
  Progress progress("dressing people", quiet);
  options.progress = [&](size_t done) {
    EndIfInterrupted();
    progress.Update(static_cast<double>(done), static_cast<double>(options.people));
  };
  const recon::BodyMesh body = tools::LearnBody(model, motion, !mesh.empty(), options);
  EndIfInterrupted();
  body.surface.Save(out);
  fmt::print("{}: {} points of {} people, turns of {} clips\n", out, body.surface.points.size(),
             options.people, motion.size());
  if (!mesh.empty()) {
    body.Save(mesh);
    fmt::print("{}: {} vertices, {} triangles\n", mesh, body.vertices.size(),
               body.triangles.size());
  }
  return 0;
}

}  // namespace ossa::commands
