#include "tools/commands/reading_bar.h"

#include <memory>
#include <optional>

#include "depth/base/stopwatch.h"
#include "tools/commands/command.h"
#include "tools/commands/process.h"

namespace ossa::commands {
namespace {

class Bars {
 public:
  void Update(uint64_t done, uint64_t of) {
    constexpr double kMoment_s = 0.5;  // by hand: shorter reads need no bar
    if (!bar_ || done < done_) {       // of another file
      bar_.reset();
      bar_.emplace("reading", false);
      since_.emplace();
    }
    done_ = done;
    if (since_->seconds() < kMoment_s) return;
    bar_->Update(static_cast<double>(done), static_cast<double>(of));
  }

 private:
  std::optional<Progress> bar_;
  std::optional<Stopwatch> since_;  // start of reading
  uint64_t done_ = 0;
};

}  // namespace

std::function<void(uint64_t, uint64_t)> ReadingBar(bool quiet) {
  if (quiet || !CanMoveCursor()) return {};
  return [bars = std::make_shared<Bars>()](uint64_t done, uint64_t of) { bars->Update(done, of); };
}

}  // namespace ossa::commands
