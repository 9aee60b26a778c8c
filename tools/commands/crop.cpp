#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>

#include "depth/base/error.h"
#include "depth/base/train_interrupted.h"
#include "tools/commands/command.h"
#include "tools/commands/commands.h"
#include "tools/commands/outputs.h"
#include "tools/learning/person_crops.h"

namespace ossa::commands {

int Crop(int argc, char** argv) {
  CLI::App app(
      "Crop the people of a data set for training a pose network: NumPy files for "
      "tools/learning/train_pose_network.py");
  std::string dataset, out;
  int threads = 0;
  bool quiet = false;
  app.add_option("DATASET", dataset, "a folder made by ossa render")->required();
  app.add_option("--out", out, "the folder to write: crops.npy, joints.npy, range.npy")->required();
  app.add_option("--threads", threads, "threads; 0: one per core")
      ->capture_default_str()
      ->check(CLI::Range(0, 1024));
  app.add_flag("--quiet", quiet, "no progress");
  Parse(app, argc, argv);
  CheckOutputs({out}, {dataset});

  tools::PersonCropOptions options;
  Progress bar("crop", quiet);
  options.threads = threads;
  options.stop = Interrupted;
  options.progress = [&](int64_t done, int64_t total) {
    bar.Update(static_cast<double>(done), static_cast<double>(total), "frames");
  };
  try {
    const int64_t people = tools::WritePersonCrops(dataset, out, options);
    fmt::print("{}: {} people\n", out, people);
  } catch (const TrainInterrupted&) {
    throw InputError("crop: interrupted; nothing was written");
  }
  return 0;
}

}  // namespace ossa::commands
