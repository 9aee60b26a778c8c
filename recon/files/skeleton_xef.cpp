// The bodies that Kinect Studio recorded beside the images (.xef, Kinect v2), as KinectXEFTools
// documents them: six bodies a frame of the 25 joints of SDK 2, positions and quaternions in camera
// space, metres.
#include <fmt/format.h>

#include <cstring>
#include <map>

#include "depth/base/error.h"
#include "depth/sensor/xef_file.h"
#include "recon/files/kinect_v2_joints_internal.h"
#include "recon/files/skeleton_formats_internal.h"

namespace ossa::recon {
namespace {

// Constants: bytes, the format's.
constexpr size_t kBodies = 6, kFirstBody = 32, kBodyBytes = 1040;
constexpr size_t kOrientations = 400, kStates = 800, kId = 1008, kIsTracked = 1016;
constexpr size_t kFrameBytes = kFirstBody + kBodies * kBodyBytes;

template <typename T>
T NumberAt(std::span<const uint8_t> bytes, size_t at) {
  T number;
  std::memcpy(&number, &bytes[at], sizeof(T));
  return number;
}

BodyRecord ParseBody(std::span<const uint8_t> bytes) {
  BodyRecord body;
  for (size_t j = 0; j < kV2Joints; ++j) {
    const auto joint = JointOfV2(j);
    const auto state = NumberAt<int32_t>(bytes, kStates + 4 * j);
    if (!joint || state < 0 || state > 2) continue;
    const auto number = [&](size_t part, size_t i) {
      return static_cast<double>(NumberAt<float>(bytes, part + 16 * j + 4 * i));
    };
    const Eigen::Vector3d position_m(number(0, 0), number(0, 1), number(0, 2));
    if (!position_m.allFinite()) continue;  // not seen
    PutJoint(body, *joint, position_m, static_cast<TrackingState>(state));
    PutSdk2Orientation(body, *joint,
                       {number(kOrientations, 3), number(kOrientations, 0),
                        number(kOrientations, 1), number(kOrientations, 2)});
  }
  return body;
}

SkeletonSequence ReadXef(SkeletonInput& input) {
  const depth::XefIndex index = depth::ReadXefIndex(input.stream, input.name);
  if (index.bodies.empty()) {
    throw InputError(input.name +
                     ": expected skeletons (in Kinect Studio the stream 'Nui Body Frame'), found "
                     "none in its streams: " +
                     index.StreamNames());
  }
  SkeletonSequence sequence{input.name, {}};
  std::map<uint64_t, int> ids;  // the SDK's, renumbered in order of appearance
  for (const depth::XefEvent& event : index.bodies) {
    const size_t number = sequence.frames.size();
    const std::string place = fmt::format("{}: byte {}: frame {}", input.name, event.at, number);
    SkeletonFrame frame;
    frame.frame = static_cast<int64_t>(number);
    frame.time_s = event.time_s - index.bodies.front().time_s;
    std::vector<uint8_t> bytes;
    try {
      bytes = depth::ReadXefBytes(input.stream, event);
    } catch (const InputError& error) {
      throw InputError(place + ": " + error.what());
    }
    if (bytes.size() < kFrameBytes) throw InputError(place + ": expected six bodies");
    for (size_t b = 0; b < kBodies; ++b) {
      const auto body = std::span(bytes).subspan(kFirstBody + b * kBodyBytes, kBodyBytes);
      if (NumberAt<int32_t>(body, kIsTracked) == 0) continue;
      const int next = static_cast<int>(ids.size()) + 1;
      frame.bodies.push_back(ParseBody(body));
      frame.bodies.back().id = ids.try_emplace(NumberAt<uint64_t>(body, kId), next).first->second;
    }
    sequence.frames.push_back(std::move(frame));
  }
  if (index.is_cut_short) {
    sequence.warnings.push_back(input.name + ": cut short: its complete frames are read");
  }
  if (index.lost_bytes > 0) {
    sequence.warnings.push_back(fmt::format("{}: damaged: {} bytes are no event and are left out",
                                            input.name, index.lost_bytes));
  }
  return sequence;
}

constexpr SkeletonFormat kXefFormats[] = {
    {"kinect-studio", [](const SkeletonSample& s) { return depth::IsXef(s.head); }, ReadXef},
};

}  // namespace

std::span<const SkeletonFormat> XefFormats() { return kXefFormats; }

}  // namespace ossa::recon
