#include <algorithm>
#include <array>
#include <utility>

#include "depth/base/error.h"
#include "depth/sensor/recording_pipe_internal.h"

namespace ossa::depth {

using std::chrono::milliseconds;

RecordingPipe::RecordingPipe(std::string recording, const RecordingReader& reader,
                             milliseconds patience)
    : recording_(std::move(recording)),
      library_(reader.library),
      patience_(patience),
      child_(reader.program, reader.arguments) {}

bool RecordingPipe::Wait(milliseconds timeout) {
  if (child_.WaitForOutput(timeout) == ChildProcess::Outcome::kTimeout) {
    waited_ += timeout;
    if (waited_ > patience_) FailHung();
    return false;
  }
  waited_ = milliseconds{0};
  return true;
}

void RecordingPipe::Take(void* to, size_t size) {
  switch (child_.ReadExactly(to, size, patience_)) {
    case ChildProcess::Outcome::kRead:
      return;
    case ChildProcess::Outcome::kTimeout:
      FailHung();
    case ChildProcess::Outcome::kClosed:
      FailClosed();
  }
}

std::string RecordingPipe::TakeText(uint64_t size) {
  constexpr uint64_t kLongest = 1000;  // characters, by hand
  std::string text(static_cast<size_t>(std::min(size, kLongest)), ' ');
  Take(text.data(), text.size());
  std::array<char, kLongest> dropped{};
  for (uint64_t left = size - text.size(); left > 0;) {
    const uint64_t part = std::min<uint64_t>(left, dropped.size());
    Take(dropped.data(), static_cast<size_t>(part));
    left -= part;
  }
  return text;
}

void RecordingPipe::Fail(const std::string& what) {
  ended_ = true;
  const std::string place =
      next_frame_ > 0 ? "after frame " + std::to_string(next_frame_ - 1) + ": " : "";
  throw InputError(recording_ + ": " + place + what);
}

void RecordingPipe::FailHung() { Fail(library_ + " hangs on it: the recording is damaged"); }

void RecordingPipe::FailClosed() {
  const std::string ending = child_.Ending();
  // Exit status of the dynamic loader if a library is missing.
  if (ending == "status 127") Fail("to read such files install " + library_);
  Fail(library_ + " crashed on it (" + ending + "): the recording is damaged");
}

}  // namespace ossa::depth
