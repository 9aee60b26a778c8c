#include "tools/stream/packets.h"

#include <oscpack/osc/OscOutboundPacketStream.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "tools/stream/rest_bones.h"

namespace ossa::stream {
namespace {

// More than the largest bundle: 58 messages of 88 bytes; derived.
constexpr size_t kMostBytes = 8192;

osc::OutboundPacketStream& operator<<(osc::OutboundPacketStream& stream, const Eigen::Vector3d& v) {
  return stream << static_cast<float>(v.x()) << static_cast<float>(v.y())
                << static_cast<float>(v.z());
}

void AddTransform(osc::OutboundPacketStream& stream, const char* address, std::string_view name,
                  const UnityTransform& transform) {
  const Eigen::Quaternionf q = transform.rotation.cast<float>();
  stream << osc::BeginMessage(address) << std::string(name).c_str() << transform.position_m << q.x()
         << q.y() << q.z() << q.w() << osc::EndMessage;
}

struct VrchatTracker {
  const char* name;
  HumanBone bone;
};
constexpr std::array<VrchatTracker, 9> kVrchatTrackers = {{{"1", HumanBone::kHips},
                                                           {"2", HumanBone::kChest},
                                                           {"3", HumanBone::kLeftFoot},
                                                           {"4", HumanBone::kRightFoot},
                                                           {"5", HumanBone::kLeftLowerLeg},
                                                           {"6", HumanBone::kRightLowerLeg},
                                                           {"7", HumanBone::kLeftLowerArm},
                                                           {"8", HumanBone::kRightLowerArm},
                                                           {"head", HumanBone::kHead}}};

}  // namespace

std::string VmcPacket(const Humanoid& world, double time_s, bool seen_only) {
  std::vector<char> buffer(kMostBytes);
  osc::OutboundPacketStream stream(buffer.data(), buffer.size());
  stream << osc::BeginBundleImmediate;
  stream << osc::BeginMessage("/VMC/Ext/OK") << osc::int32{1} << osc::EndMessage;
  stream << osc::BeginMessage("/VMC/Ext/T") << static_cast<float>(time_s) << osc::EndMessage;
  AddTransform(stream, "/VMC/Ext/Root/Pos", "root", {});
  const Humanoid local = ToLocal(world);
  for (size_t b = 0; b < kHumanBoneCount; ++b) {
    AddTransform(stream, "/VMC/Ext/Bone/Pos", kHumanBones[b].unity, local[b]);
  }
  if (!seen_only) {
    for (const RestBone& bone : MakeRestBones(world)) {
      AddTransform(stream, "/VMC/Ext/Bone/Pos", bone.name, {bone.position_m});
    }
  }
  stream << osc::EndBundle;
  return {stream.Data(), stream.Size()};
}

std::string VrchatPacket(const Humanoid& world, double scale) {
  std::vector<char> buffer(kMostBytes);
  osc::OutboundPacketStream stream(buffer.data(), buffer.size());
  stream << osc::BeginBundleImmediate;
  for (const VrchatTracker& tracker : kVrchatTrackers) {
    const UnityTransform& bone = world[static_cast<size_t>(tracker.bone)];
    const std::string address = std::string("/tracking/trackers/") + tracker.name;
    const Eigen::Vector3d place_m = scale * bone.position_m;
    stream << osc::BeginMessage((address + "/position").c_str()) << place_m << osc::EndMessage;
    stream << osc::BeginMessage((address + "/rotation").c_str()) << EulerDegrees(bone.rotation)
           << osc::EndMessage;
  }
  stream << osc::EndBundle;
  return {stream.Data(), stream.Size()};
}

void CheckHasOsc() {}

Eigen::Vector3d EulerDegrees(const Eigen::Quaterniond& rotation) {
  // R = Ry Rx Rz.
  const Eigen::Matrix3d m = rotation.toRotationMatrix();
  const double x = std::asin(std::clamp(-m(1, 2), -1.0, 1.0));
  const double y = std::atan2(m(0, 2), m(2, 2));
  const double z = std::atan2(m(1, 0), m(1, 1));
  return Eigen::Vector3d(x, y, z) * (180.0 / std::numbers::pi);
}

}  // namespace ossa::stream
