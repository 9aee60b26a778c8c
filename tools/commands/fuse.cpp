#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "recon/files/skeleton_io.h"
#include "tools/commands/command.h"
#include "tools/commands/commands.h"
#include "tools/commands/fuse_options.h"
#include "tools/commands/outputs.h"
#include "tools/commands/parse_consistently.h"
#include "tools/commands/reading_bar.h"
#include "tools/commands/skeleton_reading_options.h"
#include "tools/commands/warnings.h"

namespace ossa::commands {
namespace {

struct Arguments {
  std::vector<std::string> recordings;
  std::string out;
  FuseArguments fuse;
  WriteOptions write;
  recon::SkeletonReadOptions read;
  bool quiet = false;
};

void Declare(CLI::App& app, Arguments& a) {
  app.add_option("SKELETONS", a.recordings,
                 "the skeletons of each camera, two or more files in any format that `ossa "
                 "compare` reads; the result is in the first one's camera space and at its times")
      ->required();
  app.add_option("--out", a.out, "result: .jsonl .bvh .glb .trc .csv");
  a.fuse.AddTo(app);
  a.write.AddTo(app);
  a.write.AddSurfaceTo(app);
  AddSkeletonReadingOptions(app, a.read);
  app.add_flag("--quiet", a.quiet, "no progress, no report of camera poses");
  app.footer(MappingHelp());
}

void Check(const CLI::App&, Arguments& a) {
  if (a.recordings.size() < 2) {
    throw UsageError("fuse: expected two or more recordings, found " +
                     std::to_string(a.recordings.size()));
  }
  if (a.out.empty() && a.fuse.save_extrinsics.empty()) {
    throw UsageError("fuse: nothing to do: name --out or --save-extrinsics");
  }
  std::vector<std::string> inputs = a.recordings;
  inputs.push_back(a.fuse.File());
  inputs.push_back(a.read.mapping_file);
  CheckOutputs({a.out, a.fuse.save_extrinsics}, inputs);
  a.write.Check(a.out);
  a.fuse.Check(a.recordings);
  if (a.out.empty()) return;
  CheckSkeletonName(a.out);
  AtomicFile::CheckWritable(a.out);
}

std::vector<recon::SkeletonSequence> ReadAll(Arguments& a) {
  a.read.stop = Interrupted;
  a.read.progress = ReadingBar(a.quiet);
  std::vector<recon::SkeletonSequence> recordings;
  for (const std::string& path : a.recordings) {
    recordings.push_back(recon::ReadSkeletons(path, a.read));
    if (Interrupted()) throw InputError("fuse: interrupted; nothing was written");
    PrintWarnings("fuse", recordings.back().warnings);
  }
  return recordings;
}

}  // namespace

int Fuse(int argc, char** argv) {
  Arguments a = ParseConsistently<Arguments>(
      {"Fuse skeletons of the same people from several cameras", Declare, Check}, argc, argv);
  const auto write = a.write.For(a.out);
  const auto recordings = ReadAll(a);
  const auto fused = FuseRecordings(a.fuse, a.recordings, recordings, a.quiet);
  if (Interrupted()) throw InputError("fuse: interrupted; nothing was written");
  PrintWarnings("fuse", fused.skeletons.warnings);
  WriteFused("fuse", a.fuse, a.out, fused, write);
  return 0;
}

}  // namespace ossa::commands
