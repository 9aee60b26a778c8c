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
  int rank = 0;  // index among `ranks` processes that share the work and the folder
  int ranks = 1;
  std::string command;               // for the manifest, without threads and ranks
  std::vector<std::string> sources;  // of motion
  std::string ossa;                  // this version
  std::vector<std::string> terms;
  std::function<bool()> interrupted = [] { return false; };
  std::function<void(int64_t done)> progress = [](int64_t) {};
};

enum class RenderEnd { kDone, kInterrupted };

/// Renders this rank's share of a data set into a folder. Finished chunks of an earlier run of the
/// same job are kept. Throws InputError if the folder holds anything else. The data set is complete
/// after FinishDataset().
RenderEnd RenderShare(const FrameInputs& inputs, const RenderJob& job);

/// Joins the chunks of all ranks and writes the manifest. Call once, after all ranks are done.
void FinishDataset(const FrameInputs& inputs, const RenderJob& job);

}  // namespace ossa::tools
