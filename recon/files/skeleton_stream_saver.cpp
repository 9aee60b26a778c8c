// Kinect Stream Saver's joint positions (SDK 1.8): per frame six skeletons of 20 joints in SDK
// order, four floats each: x, y, z in camera space, metres, and the tracking state; a skeleton not
// seen is all zero. Times, when its liTimeStamp.binary lies beside: five int64 a frame, the last in
// milliseconds.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "recon/files/binary_bytes_internal.h"

namespace ossa::recon {
namespace {

constexpr size_t kSaverBodies = 6;  // of the format: the Kinect SDK 2 tracks six
constexpr size_t kSaverFrameBytes = kSaverBodies * kJointCount * 4 * sizeof(float);

bool IsStreamSaver(const SkeletonSample& sample) {
  if (sample.head.size() < kSaverFrameBytes) return false;
  for (size_t j = 0; j < kSaverBodies * kJointCount; ++j) {
    std::array<float, 4> v{};
    std::memcpy(v.data(), sample.head.data() + 16 * j, sizeof(v));
    if (v[3] != 0 && v[3] != 1 && v[3] != 2) return false;
    for (int axis = 0; axis < 3; ++axis) {
      if (!(std::abs(v[static_cast<size_t>(axis)]) < 20)) return false;
    }
  }
  return true;
}

std::vector<double> SaverTimes_s(const SkeletonInput& input, size_t frames) {
  constexpr size_t kRow = 5 * sizeof(int64_t);
  const size_t slash = input.name.find_last_of("/#");
  const std::string folder = slash == std::string::npos ? "" : input.name.substr(0, slash + 1);
  std::vector<double> times;
  if (input.sibling) {
    if (const auto text = input.sibling(folder + kSaverTimes)) {
      if (text->size() != frames * kRow) {
        FailAtByte(folder + kSaverTimes, text->size(), fmt::format("{} rows of five", frames));
      }
      const auto first = ValueAt<int64_t>(*text, kRow - 8);
      for (size_t f = 0; f < frames; ++f) {
        times.push_back(1e-3 *
                        static_cast<double>(ValueAt<int64_t>(*text, (f + 1) * kRow - 8) - first));
      }
      return times;
    }
  }
  for (size_t f = 0; f < frames; ++f) {
    times.push_back(static_cast<double>(f) * input.FrameTime_s(1.0 / 30.0));
  }
  return times;
}

SkeletonSequence ReadStreamSaver(SkeletonInput& input) {
  const std::string bytes = ReadAllBytes(input);
  if (bytes.empty() || bytes.size() % kSaverFrameBytes != 0) {
    FailAtByte(input.name, bytes.size(),
               fmt::format("whole frames of {} bytes, found a part of one", kSaverFrameBytes));
  }
  const size_t frames = bytes.size() / kSaverFrameBytes;
  const auto times_s = SaverTimes_s(input, frames);
  SkeletonSequence sequence{input.name, {}};
  for (size_t f = 0; f < frames; ++f) {
    SkeletonFrame frame;
    frame.frame = static_cast<int64_t>(f);
    frame.time_s = times_s[f];
    for (size_t b = 0; b < kSaverBodies; ++b) {
      BodyRecord body;
      body.id = static_cast<int>(b) + 1;
      bool any = false;
      for (size_t j = 0; j < kJointCount; ++j) {
        const size_t offset = f * kSaverFrameBytes + 16 * (b * kJointCount + j);
        std::array<float, 4> v{};
        std::memcpy(v.data(), bytes.data() + offset, sizeof(v));
        if (!std::isfinite(v[0]) || !std::isfinite(v[1]) || !std::isfinite(v[2]) ||
            (v[3] != 0 && v[3] != 1 && v[3] != 2)) {
          FailAtByte(input.name, offset, "three finite floats and a state 0, 1 or 2");
        }
        any = any || v[3] != 0;
        PutJoint(body, static_cast<Joint>(j), {v[0], v[1], v[2]},
                 static_cast<TrackingState>(static_cast<int>(v[3])));
      }
      if (any) frame.bodies.push_back(body);
    }
    sequence.frames.push_back(std::move(frame));
  }
  return sequence;
}

constexpr SkeletonFormat kStreamSaverFormats[] = {
    {"kinect-stream-saver", IsStreamSaver, ReadStreamSaver}};

}  // namespace

std::span<const SkeletonFormat> StreamSaverFormats() { return kStreamSaverFormats; }

}  // namespace ossa::recon
