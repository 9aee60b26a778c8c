#pragma once
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "depth/sensor/child_process_internal.h"

namespace ossa::depth {

/// The program that reads a recording.
struct RecordingReader {
  std::filesystem::path program;
  std::vector<std::string> arguments;
  std::string library;  // the library it uses, for messages
};

/// The output of a reader program, for a frame source. If the program ends or hangs, it throws an
/// InputError that names the last frame and the likely cause.
class RecordingPipe {
 public:
  /// A reader without output for longer than `patience` is considered hung.
  RecordingPipe(std::string recording, const RecordingReader& reader,
                std::chrono::milliseconds patience);

  /// Waits for output. False: none yet; InputError if the total waiting time exceeds the patience.
  bool Wait(std::chrono::milliseconds timeout);
  /// Reads exactly `size` bytes.
  void Take(void* to, size_t size);
  /// Reads a text of `size` characters and returns its first line's worth.
  std::string TakeText(uint64_t size);
  /// Records that this frame was read completely.
  void RecordFrame(int64_t index) { next_frame_ = index + 1; }
  int64_t next_frame() const { return next_frame_; }

  /// Marks the end of the output.
  void End() { ended_ = true; }
  bool ended() const { return ended_; }
  /// Throws InputError with the recording, the last frame and the reason.
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
