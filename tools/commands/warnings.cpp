#include "tools/commands/warnings.h"

#include <fmt/format.h>

#include "tools/commands/process.h"

namespace ossa::commands {

void PrintWarnings(std::string_view command, const std::vector<recon::SkeletonClip>& clips) {
  std::vector<std::string> all;
  for (const recon::SkeletonClip& clip : clips) {
    all.insert(all.end(), clip.sequence.warnings.begin(), clip.sequence.warnings.end());
  }
  PrintWarnings(command, all);
}

void PrintWarnings(std::string_view command, const std::vector<recon::MotionClip>& clips) {
  std::vector<std::string> all;
  for (const recon::MotionClip& clip : clips) {
    all.insert(all.end(), clip.warnings.begin(), clip.warnings.end());
  }
  PrintWarnings(command, all);
}

void PrintWarnings(std::string_view command, const std::vector<std::string>& warnings) {
  constexpr size_t kMostSaid = 20;  // by hand
  for (size_t i = 0; i < warnings.size() && i < kMostSaid; ++i) {
    PrintError(fmt::format("{}: warning: {}\n", command, warnings[i]));
  }
  if (warnings.size() > kMostSaid) {
    PrintError(fmt::format("{}: {} more warnings\n", command, warnings.size() - kMostSaid));
  }
}

void PrintWarning(std::string_view command, const std::string& source, tracker::Tracker& tracker) {
  if (const auto warning = tracker.TakeWarning()) {
    PrintWarnings(command, std::vector{fmt::format("{}: {}", source, *warning)});
  }
}

}  // namespace ossa::commands
