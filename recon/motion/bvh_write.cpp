#include <array>
#include <charconv>
#include <string_view>

#include "depth/error.h"
#include "depth/file/atomic_file.h"
#include "recon/motion/bvh.h"

namespace ossa::recon {
namespace {

constexpr std::array<std::string_view, 6> kChannelNames = {"Xposition", "Yposition", "Zposition",
                                                           "Xrotation", "Yrotation", "Zrotation"};

/// Shortest decimal within 1e-6: a millionth of a centimetre or degree.
void AppendNumber(std::string& text, double value) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value,
                                 std::chars_format::fixed, 6)
                       .ptr;
  std::string_view shown(digits.data(), static_cast<size_t>(end - digits.data()));
  while (shown.ends_with('0')) shown.remove_suffix(1);
  if (shown.ends_with('.')) shown.remove_suffix(1);
  text += shown == "-0" ? "0" : shown;
}

void AppendOffset(std::string& text, const std::string& indent, const Eigen::Vector3d& offset) {
  text.append(indent).append("OFFSET");
  for (const double value : offset) {
    text += ' ';
    AppendNumber(text, value);
  }
  text += '\n';
}

void AppendJoint(const BvhFile& bvh, size_t index, std::string indent, std::string& text) {
  const BvhJoint& joint = bvh.joints[index];
  text.append(indent).append(joint.parent < 0 ? "ROOT " : "JOINT ").append(joint.name);
  text.append("\n").append(indent).append("{\n");
  const std::string inner = indent + "  ";
  AppendOffset(text, inner, joint.offset);
  text.append(inner).append("CHANNELS ").append(std::to_string(joint.channels.size()));
  for (const BvhChannel channel : joint.channels) {
    text.append(" ").append(kChannelNames[static_cast<size_t>(channel)]);
  }
  text += '\n';
  for (size_t child = index + 1; child < bvh.joints.size(); ++child) {
    if (bvh.joints[child].parent == static_cast<int>(index)) AppendJoint(bvh, child, inner, text);
  }
  for (const Eigen::Vector3d& end : joint.end_sites) {
    text.append(inner).append("End Site\n").append(inner).append("{\n");
    AppendOffset(text, inner + "  ", end);
    text.append(inner).append("}\n");
  }
  text.append(indent).append("}\n");
}

}  // namespace

std::string FormatBvh(const BvhFile& bvh) {
  std::string text = "HIERARCHY\n";
  AppendJoint(bvh, 0, "", text);
  text.append("MOTION\nFrames: ").append(std::to_string(bvh.FrameCount())).append("\nFrame Time: ");
  AppendNumber(text, bvh.frame_s);
  text += '\n';
  const size_t channels = bvh.ChannelCount();
  for (size_t i = 0; i < bvh.values.size(); ++i) {
    AppendNumber(text, bvh.values[i]);
    text += (i + 1) % channels == 0 ? '\n' : ' ';
  }
  return text;
}

void WriteBvh(const BvhFile& bvh, const std::filesystem::path& path) {
  AtomicFile file(path);
  file.stream() << FormatBvh(bvh);
  file.Commit();
}

}  // namespace ossa::recon
