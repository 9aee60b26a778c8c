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
#include "tools/commands/mocap_option.h"
#include "tools/commands/outputs.h"
#include "tools/commands/warnings.h"
#include "tools/learning/learn_body_surface.h"

namespace ossa::commands {
namespace {

void EndIfInterrupted() {
  if (Interrupted()) throw InputError("surface: interrupted; nothing was written");
}

struct SurfaceArguments {
  std::vector<std::string> mocap;
  std::string out, mesh;
  bool quiet = false;
  tools::BodySurfaceOptions options;
  recon::MocapOptions mocap_options;
};

void Declare(CLI::App& app, SurfaceArguments& a) {
  AddMocapOption(app, a.mocap, a.mocap_options);
  app.add_option("--out", a.out, "the .ossasurface file to write")->required();
  app.add_option("--mesh", a.mesh, "the .ossamesh file to write: its skin as triangles, for .glb");
  app.add_option("--triangles", a.options.triangles, "approximate number of triangles of --mesh")
      ->capture_default_str()
      ->check(CLI::Range(200, 20000));
  app.add_option("--points", a.options.points, "points on the skin")
      ->capture_default_str()
      ->check(CLI::Range(size_t{50}, recon::BodySurface::kMostPoints));
  app.add_option("--people", a.options.people, "dressed bodies from which shape is learned")
      ->capture_default_str()
      ->check(CLI::Range(50, 5000));
  app.add_option("--seed", a.options.seed, "random seed of their shapes and clothes")
      ->capture_default_str();
  app.add_flag("--quiet", a.quiet, "no progress");
  AddMappingOption(app, a.mocap_options.mapping_file);
}

void Check(const SurfaceArguments& a) {
  CheckNotOtherKind("--out", a.out, ".ossasurface");
  CheckNotOtherKind("--mesh", a.mesh, ".ossamesh");
  std::vector<std::string> inputs = a.mocap;
  inputs.push_back(a.mocap_options.mapping_file);
  CheckOutputs({a.out, a.mesh}, inputs);
  AtomicFile::CheckWritable(a.out);
  if (!a.mesh.empty()) AtomicFile::CheckWritable(a.mesh);
}

std::vector<recon::MotionClip> LoadMotion(const SurfaceArguments& a) {
  recon::MocapOptions options = a.mocap_options;
  options.stop = Interrupted;
  auto motion = recon::LoadMocap(a.mocap, options);
  PrintWarnings("surface", motion);
  EndIfInterrupted();
  return motion;
}

recon::BodyMesh LearnShape(const SurfaceArguments& a,
                           const std::vector<recon::MotionClip>& motion) {
  const auto model = recon::BodyModel::Load(recon::BodyFolder());
  Progress progress("dressing people", a.quiet);
  tools::BodySurfaceOptions options = a.options;
  options.progress = [&](size_t done) {
    EndIfInterrupted();
    progress.Update(static_cast<double>(done), static_cast<double>(options.people));
  };
  recon::BodyMesh body = tools::LearnBody(model, motion, !a.mesh.empty(), options);
  EndIfInterrupted();
  return body;
}

}  // namespace

int Surface(int argc, char** argv) {
  CLI::App app("Make the body model of the surface fit from MPFB shapes, clothes and motion");
  SurfaceArguments a;
  Declare(app, a);
  Parse(app, argc, argv);
  Check(a);
  const auto motion = LoadMotion(a);
  const recon::BodyMesh body = LearnShape(a, motion);
  body.surface.Save(a.out);
  fmt::print("{}: {} points of {} people, turns of {} clips\n", a.out, body.surface.points.size(),
             a.options.people, motion.size());
  if (a.mesh.empty()) return 0;
  body.Save(a.mesh);
  fmt::print("{}: {} vertices, {} triangles\n", a.mesh, body.vertices.size(),
             body.triangles.size());
  return 0;
}

}  // namespace ossa::commands
