#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <string>

#include "tools/commands/command.h"
#include "tools/commands/process.h"

namespace ossa::commands {
namespace {

double Now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// The time left at the mean rate; nothing while that is unreliable.
std::string TimeLeft(double elapsed_s, double share) {
  constexpr double kSoonest_s = 0.5;  // by hand: shorter rates vary too much
  if (elapsed_s < kSoonest_s || share <= 0.0 || share >= 1.0) return {};
  const auto left_s = static_cast<int64_t>(elapsed_s * (1.0 - share) / share + 0.5);
  if (left_s < 3600) return fmt::format("{}:{:02} left ", left_s / 60, left_s % 60);
  return fmt::format("{} h {:02} min left ", left_s / 3600, left_s / 60 % 60);
}

}  // namespace

Progress::Progress(std::string label, bool quiet)
    : label_(std::move(label)), quiet_(quiet), terminal_(CanMoveCursor()), start_s_(Now_s()) {}

Progress::~Progress() {
  if (open_line_) PrintError("\n");
}

void Progress::Update(double done, double total, const std::string& note) {
  const double now_s = Now_s();
  const bool last = total > 0 && done >= total;
  const double interval_s = terminal_ ? 0.1 : 5.0;
  if (quiet_ || (now_s - last_s_ < interval_s && !last)) return;
  last_s_ = now_s;
  const double share = total > 0 ? done / total : 0.0;
  const std::string left = TimeLeft(now_s - start_s_, share);
  if (terminal_) {
    constexpr int kWidth = 30;  // characters, by eye
    const int filled = static_cast<int>(share * kWidth);
    PrintError(fmt::format("\r{} [{:#<{}}{:.<{}}] {:3.0f} % {}{}\033[K", label_, "", filled, "",
                           kWidth - filled, 100 * share, left, note));
    open_line_ = true;
  } else {
    PrintError(fmt::format("{}: {:.0f} of {:.0f} {}{}\n", label_, done, total, left, note));
  }
}

}  // namespace ossa::commands
