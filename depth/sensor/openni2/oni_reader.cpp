// ossa_oni_reader FILE.oni: plays a recording with OpenNI2 and writes its frames to standard
// output. A separate program, so that a file that makes OpenNI2 crash, hang or exhaust memory
// affects only this process.
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <cstdlib>
#include <cstring>
#include <string>

#include "depth/base/error.h"
#include "depth/sensor/oni_pipe_internal.h"
#include "depth/sensor/openni2/openni_depth_internal.h"
#include "depth/sensor/reader_limits_internal.h"

namespace ossa::depth {
namespace {

// By hand, bounds: existing frames arrive immediately; this limits the wait for missing ones. A
// file of unknown length ends when the player stops delivering.
constexpr int kFrameTimeout_ms = 3000;
constexpr int kEndTimeout_ms = 1500;

void SendError(const std::string& text) {
  OniPipeMessage message;
  message.kind = OniPipeKind::kError;
  message.size = static_cast<uint32_t>(text.size());
  WriteToParent(&message, sizeof(message));
  WriteToParent(text.data(), text.size());
}

void SendFrame(const openni::VideoFrameRef& frame, bool mirrored, int64_t index) {
  const auto depth_mm = ReadMillimetres(frame, mirrored);
  OniPipeMessage message;
  message.kind = OniPipeKind::kFrame;
  message.window = ReadWindow(frame, mirrored);
  message.index = index;
  message.timestamp_us = frame.getTimestamp();
  WriteToParent(&message, sizeof(message));
  WriteToParent(depth_mm.data(), depth_mm.size() * sizeof(uint16_t));
}

// Sends the number of frames in the file or, if unknown (a killed recorder), until none arrives.
// readFrame never returns past the end, so each frame is waited for first.
void SendFrames(openni::VideoStream& stream, int frame_count) {
  const bool known = frame_count >= 0;
  const bool mirrored = stream.getMirroringEnabled();
  for (int64_t i = 0; !known || i < frame_count; ++i) {
    openni::VideoStream* streams = &stream;
    int ready = -1;
    const int timeout_ms = known || i == 0 ? kFrameTimeout_ms : kEndTimeout_ms;
    if (openni::OpenNI::waitForAnyStream(&streams, 1, &ready, timeout_ms) != openni::STATUS_OK) {
      if (!known && i > 0) break;
      throw InputError("frame " + std::to_string(i) + ": expected " +
                       (known ? std::to_string(frame_count) : "some") +
                       " frames, found none after it: the recording is cut short or damaged");
    }
    openni::VideoFrameRef frame;
    if (stream.readFrame(&frame) != openni::STATUS_OK || !frame.isValid()) {
      throw InputError("frame " + std::to_string(i) + ": cannot be read: " + OpenNiError());
    }
    try {
      SendFrame(frame, mirrored, i);
    } catch (const InputError& error) {
      throw InputError("frame " + std::to_string(i) + ": " + error.what());
    }
  }
  WriteToParent(&static_cast<const OniPipeMessage&>(OniPipeMessage{}), sizeof(OniPipeMessage));
}

// An ASCII alias for a file name: OpenNI2 crashes on other characters (it uses signed bytes as a
// table index) and truncates long names.
std::string PlainName(const char* path) {
  const int file = open(path, O_RDONLY);
  if (file < 0) throw InputError(std::string("cannot be read: ") + std::strerror(errno));
  return "/proc/self/fd/" + std::to_string(file);
}

void Play(const char* path) {
  const OpenNiSession session;
  openni::Device device;
  if (device.open(PlainName(path).c_str()) != openni::STATUS_OK) {
    throw InputError("OpenNI2 cannot open it: damaged or cut short");
  }
  openni::VideoStream stream;
  if (stream.create(device, openni::SENSOR_DEPTH) != openni::STATUS_OK) {
    throw InputError("expected a depth stream, found none");
  }
  openni::PlaybackControl* playback = device.getPlaybackControl();
  if (playback == nullptr) throw InputError("expected a recording, found a device");
  playback->setRepeatEnabled(false);
  playback->setSpeed(-1);  // lock step: other speeds drop frames
  // 32 bits; -1 (all ones) if the recorder was killed.
  const int frame_count = playback->getNumberOfFrames(stream);
  const OniPipeHello hello{OniPipeHello::kMagic, ReadWindow(stream, stream.getMirroringEnabled()),
                           stream.getHorizontalFieldOfView(), stream.getVerticalFieldOfView(),
                           frame_count};
  WriteToParent(&hello, sizeof(hello));
  if (frame_count == 0) {
    WriteToParent(&static_cast<const OniPipeMessage&>(OniPipeMessage{}), sizeof(OniPipeMessage));
    return;
  }
  if (stream.start() != openni::STATUS_OK) throw InputError("cannot be played: " + OpenNiError());
  SendFrames(stream, frame_count);
}

}  // namespace
}  // namespace ossa::depth

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  ossa::depth::LimitMemory();
  ossa::depth::EndWithTheParent(getppid());
  try {
    ossa::depth::Play(argv[1]);
  } catch (const std::exception& error) {
    ossa::depth::SendError(error.what());
  }
  // No cleanup of a possibly corrupted library.
  _exit(0);
}
