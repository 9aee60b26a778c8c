#include <array>
#include <span>
#include <string_view>

#include "depth/base/atomic_file.h"
#include "recon/motion/bvh.h"
#include "recon/motion/bvh_text_internal.h"
#include "recon/motion/fixed_point_internal.h"

namespace ossa::recon {
namespace {

constexpr std::array<std::string_view, 6> kChannelNames = {"Xposition", "Yposition", "Zposition",
                                                           "Xrotation", "Yrotation", "Zrotation"};

// Constants: chosen by hand unless stated otherwise.

constexpr int kDigits = 6;  // a millionth of a centimetre or degree

void AppendOffset(std::string& text, const std::string& indent, const Eigen::Vector3d& offset) {
  text.append(indent).append("OFFSET");
  for (const double value : offset) {
    text += ' ';
    AppendFixed(text, value, kDigits);
  }
  text += '\n';
}

void AppendJoint(const std::vector<BvhJoint>& joints, size_t index, std::string indent,
                 std::string& text) {
  const BvhJoint& joint = joints[index];
  text.append(indent).append(joint.parent < 0 ? "ROOT " : "JOINT ").append(joint.name);
  text.append("\n").append(indent).append("{\n");
  const std::string inner = indent + "  ";
  AppendOffset(text, inner, joint.offset);
  text.append(inner).append("CHANNELS ").append(std::to_string(joint.channels.size()));
  for (const BvhChannel channel : joint.channels) {
    text.append(" ").append(kChannelNames[static_cast<size_t>(channel)]);
  }
  text += '\n';
  for (size_t child = index + 1; child < joints.size(); ++child) {
    if (joints[child].parent == static_cast<int>(index)) AppendJoint(joints, child, inner, text);
  }
  for (const Eigen::Vector3d& end : joint.end_sites) {
    text.append(inner).append("End Site\n").append(inner).append("{\n");
    AppendOffset(text, inner + "  ", end);
    text.append(inner).append("}\n");
  }
  text.append(indent).append("}\n");
}

}  // namespace

std::string BvhHead(const std::vector<BvhJoint>& joints, double frame_s, size_t frames) {
  // With six digits a step of 1/30 s accumulates an error of 36 ms per hour.
  constexpr int kTimeDigits = 10;  // by hand, for rounding
  std::string text = "HIERARCHY\n";
  for (size_t j = 0; j < joints.size(); ++j) {
    if (joints[j].parent < 0) AppendJoint(joints, j, "", text);
  }
  text.append("MOTION\nFrames: ").append(std::to_string(frames)).append("\nFrame Time: ");
  AppendFixed(text, frame_s, kTimeDigits);
  text += '\n';
  return text;
}

void AppendBvhFrame(std::string& text, std::span<const double> values) {
  for (size_t i = 0; i < values.size(); ++i) {
    if (i > 0) text += ' ';
    AppendFixed(text, values[i], kDigits);
  }
  text += '\n';
}

std::string FormatBvh(const BvhFile& bvh) {
  std::string text = BvhHead(bvh.joints, bvh.frame_s, bvh.FrameCount());
  const size_t channels = bvh.ChannelCount();
  for (size_t f = 0; f < bvh.FrameCount(); ++f) {
    AppendBvhFrame(text, std::span(bvh.values).subspan(f * channels, channels));
  }
  return text;
}

void WriteBvh(const BvhFile& bvh, const std::filesystem::path& path) {
  AtomicFile file(path);
  file.stream() << FormatBvh(bvh);
  file.Commit();
}

}  // namespace ossa::recon
