#pragma once
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "depth/sensor/child_process_internal.h"

namespace ossa::depth {

/// Whose program reads a recording.
struct RecordingReader {
  std::filesystem::path program;
  std::vector<std::string> arguments;
  std::string library;  // that the program uses, as messages name it
};

/// What a program that reads a recording writes, for the source of its frames: where it ends or
/// falls silent there is an InputError that says after which frame and whose fault it is.
class RecordingPipe {
 public:
  /// A reader that is silent for longer than `patience` hangs.
  RecordingPipe(std::string recording, const RecordingReader& reader,
                std::chrono::milliseconds patience);

  /// Waits for output. False: none yet; InputError once all that waiting exceeds the patience.
  bool Wait(std::chrono::milliseconds timeout);
  /// Exactly `size` bytes.
  void Take(void* to, size_t size);
  /// A text of so many characters: its beginning, a line's worth; the rest is read and dropped.
  std::string TakeText(uint64_t size);
  /// A frame of this number was taken whole.
  void TookFrame(int64_t index) { next_frame_ = index + 1; }
  int64_t next_frame() const { return next_frame_; }

  /// Nothing comes any more, from now on or since something failed.
  void End() { ended_ = true; }
  bool ended() const { return ended_; }
  /// Throws InputError: the recording, after which frame, and what is wrong.
  [[noreturn]] void Fail(const std::string& what);

 private:
  [[noreturn]] void FailHung();
  [[noreturn]] void FailClosed();

  std::string recording_;
  std::string library_;
  std::chrono::milliseconds patience_;
  ChildProcess child_;
  std::chrono::milliseconds waited_{0};
  int64_t next_frame_ = 0;
  bool ended_ = false;
};

}  // namespace ossa::depth
