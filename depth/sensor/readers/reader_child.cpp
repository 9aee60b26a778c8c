#include <unistd.h>

#include <cstring>
#include <exception>
#include <string>
#include <vector>

#include "depth/sensor/reader_limits_internal.h"
#include "depth/sensor/readers/reader_pipe_internal.h"

namespace ossa::depth {
void Send(ReaderKind kind, std::span<const std::byte> contents) {
  ReaderMessage message;
  message.kind = kind;
  message.size = contents.size();
  WriteToParent(&message, sizeof(message));
  WriteToParent(contents.data(), contents.size());
}

void SendText(ReaderKind kind, const std::string& text) {
  Send(kind, std::as_bytes(std::span(text)));
}

void SendHello(const ReaderHello& hello) {
  Send(ReaderKind::kHello, std::as_bytes(std::span(&hello, 1)));
}

void SendFrame(const ReaderFrame& frame, std::span<const uint16_t> depth) {
  ReaderMessage message;
  message.kind = ReaderKind::kFrame;
  message.size = sizeof(frame) + depth.size_bytes();
  WriteToParent(&message, sizeof(message));
  WriteToParent(&frame, sizeof(frame));
  WriteToParent(depth.data(), depth.size_bytes());
}

void RunReader(const std::function<void()>& read) {
  LimitMemory();
  EndWithTheParent(getppid());
  try {
    read();
    Send(ReaderKind::kEnd);
  } catch (const std::exception& error) {
    SendText(ReaderKind::kError, error.what());
  }
  _exit(0);
}

}  // namespace ossa::depth
