#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "tools/synth/frame_maker.h"

namespace ossa::tools {

struct RenderJob {
  std::filesystem::path out;
  int64_t frames = 0;
  bool png = true;
  bool packed = false;
  int threads = 1;
  int rank = 0;  // of `ranks` processes that share the work and the folder
  int ranks = 1;
  std::string command;               // for the manifest; says nothing of threads and ranks
  std::vector<std::string> sources;  // of motion
  std::string ossa;                  // this version
  std::vector<std::string> terms;
  std::function<bool()> interrupted = [] { return false; };
  std::function<void(int64_t done)> progress = [](int64_t) {};
};

enum class RenderEnd { kDone, kInterrupted };

/// Renders this rank's share of a data set into a folder. Work that is there already from a run of
/// the same job, even one that was killed, is kept. Throws InputError when the folder holds
/// something else. The set is complete after FinishDataset.
RenderEnd RenderShare(const FrameInputs& inputs, const RenderJob& job);

/// Joins what the ranks made and writes the manifest: call once, when all are done.
void FinishDataset(const FrameInputs& inputs, const RenderJob& job);

}  // namespace ossa::tools
