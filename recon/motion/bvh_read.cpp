#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <sstream>
#include <string_view>

#include "depth/base/error.h"
#include "depth/base/lower_case.h"
#include "recon/motion/bvh.h"
#include "recon/motion/bvh_source_internal.h"
#include "recon/motion/text_scanner_internal.h"

namespace ossa::recon {
namespace {

constexpr size_t kMaxJoints = 2000;  // a damaged file must not fill the memory; a bound, by hand
constexpr std::array<std::string_view, 6> kLowerCaseChannels = {
    "xposition", "yposition", "zposition", "xrotation", "yrotation", "zrotation"};

class Parser {
 public:
  Parser(std::string text, const std::string& source) : scan_(std::move(text), source) {}

  BvhFile Run() {
    scan_.Expect("HIERARCHY");
    do {
      scan_.Expect("ROOT");
      root_ = bvh_.joints.size();
      ReadJoints();
    } while (LowerCase(scan_.PeekWord()) == "root");
    scan_.Expect("MOTION");
    ReadMotion();
    return std::move(bvh_);
  }

 private:
  /// Parses the hierarchy with an explicit stack: a hostile file of a million nested joints must
  /// not overflow the call stack.
  void ReadJoints() {
    OpenJoint(-1);
    while (!open_.empty()) {
      const std::string_view word = scan_.Word();
      const std::string key = LowerCase(word);
      if (key == "offset") {
        bvh_.joints[Top()].offset = Vector("OFFSET");
      } else if (key == "channels") {
        ReadChannels();
      } else if (key == "joint") {
        OpenJoint(open_.back());
      } else if (key == "end") {
        ReadEndSite();
      } else if (key == "}") {
        open_.pop_back();
      } else {
        scan_.Fail("OFFSET, CHANNELS, JOINT, End Site or '}' of joint " + bvh_.joints[Top()].name,
                   word);
      }
    }
  }

  size_t Top() const { return static_cast<size_t>(open_.back()); }

  void OpenJoint(int parent) {
    BvhJoint joint;
    joint.parent = parent;
    for (const std::string_view word : scan_.ReadRestOfLine()) {
      if (!joint.name.empty()) joint.name += ' ';
      joint.name += word;
    }
    if (joint.name.empty()) scan_.Fail("a joint's name", "nothing");
    for (size_t other = root_; other < bvh_.joints.size(); ++other) {
      if (bvh_.joints[other].name == joint.name) {
        scan_.Fail("every joint name once", joint.name);
      }
    }
    scan_.Expect("{");
    if (bvh_.joints.size() == kMaxJoints) {
      scan_.Fail("at most " + std::to_string(kMaxJoints) + " joints", joint.name);
    }
    open_.push_back(static_cast<int>(bvh_.joints.size()));
    bvh_.joints.push_back(std::move(joint));
  }

  Eigen::Vector3d Vector(const std::string& what) {
    const double x = scan_.Number(what + " x"), y = scan_.Number(what + " y");
    return {x, y, scan_.Number(what + " z")};
  }

  void ReadChannels() {
    BvhJoint& joint = bvh_.joints[Top()];
    if (!joint.channels.empty()) scan_.Fail("CHANNELS once in joint " + joint.name, "CHANNELS");
    const double count = scan_.Number("the number of channels");
    if (count < 0 || count > 6 || count != std::floor(count)) {
      scan_.Fail("0 to 6 channels", std::to_string(count));
    }
    for (int i = 0; i < static_cast<int>(count); ++i) {
      const std::string_view word = scan_.Word();
      const auto name =
          std::find(kLowerCaseChannels.begin(), kLowerCaseChannels.end(), LowerCase(word));
      if (name == kLowerCaseChannels.end()) {
        scan_.Fail("a channel such as Xposition or Zrotation", word);
      }
      const auto channel = static_cast<BvhChannel>(name - kLowerCaseChannels.begin());
      if (std::count(joint.channels.begin(), joint.channels.end(), channel) > 0) {
        scan_.Fail("each channel once in joint " + joint.name, word);
      }
      joint.channels.push_back(channel);
    }
  }

  void ReadEndSite() {
    scan_.ReadRestOfLine();  // "Site", or a name that some exporters write
    scan_.Expect("{");
    scan_.Expect("OFFSET");
    bvh_.joints[Top()].end_sites.push_back(Vector("End Site OFFSET"));
    if (LowerCase(scan_.PeekWord()) == "channels") {
      scan_.Word();
      const std::string_view count = scan_.Word();
      if (count != "0") scan_.Fail("no channels in an End Site", count);
    }
    scan_.Expect("}");
  }

  /// The number after "NAME:", with or without white space around the colon and in the name.
  double NumberAfter(const std::string& name, const std::string& what) {
    std::string wanted = LowerCase(name);
    std::erase(wanted, ' ');
    std::string seen;
    while (true) {
      const std::string_view word = scan_.Word();
      const size_t colon = word.find(':');
      seen += LowerCase(word.substr(0, colon));
      if (word.empty() || !wanted.starts_with(seen) ||
          (colon != std::string_view::npos && seen != wanted)) {
        scan_.Fail("'" + name + ":'", word);
      }
      if (colon == std::string_view::npos) continue;
      const std::string_view rest = word.substr(colon + 1);
      return rest.empty() ? scan_.Number(what) : scan_.ToNumber(rest, what);
    }
  }

  /// Warns if the frame time looks like a frame rate: motions do not have steps of more than a
  /// second.
  void WarnOfRate() {
    constexpr double kSlowest_s = 1.0;  // by hand
    if (bvh_.frame_s <= kSlowest_s) return;
    std::ostringstream message;
    message << scan_.source() << ": Frame Time says " << bvh_.frame_s
            << " s a frame, and is read so (should it be " << bvh_.frame_s
            << " frames a second, write " << 1.0 / bvh_.frame_s << ")";
    bvh_.warnings.push_back(message.str());
  }

  void ReadMotion() {
    const double frames = NumberAfter("Frames", "the number of frames");
    if (frames < 0 || frames != std::floor(frames)) {
      scan_.Fail("a number of frames of at least 1", std::to_string(frames));
    }
    bvh_.frame_s = NumberAfter("Frame Time", "the frame time");
    if (bvh_.frame_s < 1e-4 || bvh_.frame_s > 60.0) {
      scan_.Fail("a frame time between 0.0001 and 60 s", std::to_string(bvh_.frame_s));
    }
    WarnOfRate();
    const size_t channels = bvh_.ChannelCount();
    if (channels == 0) scan_.Fail("at least one channel in the file", "none");
    // A number takes at least a digit and a separator: a wrong header cannot exhaust memory.
    const size_t most = (scan_.BytesLeft() + 1) / 2;
    bvh_.values.reserve(std::min(static_cast<size_t>(frames) * channels, most));
    while (ReadFrame(channels)) {
    }
    CheckFrames(static_cast<size_t>(frames));
  }

  /// Reads the next row; false at the end.
  bool ReadFrame(size_t channels) {
    const auto words = scan_.ReadWordsOfLine();
    if (words.empty()) return false;
    if (words.size() != channels) {
      scan_.Fail(std::to_string(channels) + " numbers in a frame",
                 std::to_string(words.size()) + " numbers");
    }
    for (const std::string_view word : words) {
      bvh_.values.push_back(scan_.ToNumber(word, "a channel's value"));
    }
    return true;
  }

  void CheckFrames(size_t declared) {
    const size_t frames = bvh_.FrameCount();
    if (frames == 0) scan_.Fail("frame 1 of " + std::to_string(declared), "");
    if (scan_.IsCutInLastNumber()) scan_.Fail("a whole last frame", "a number that is cut");
    if (frames == declared) return;
    bvh_.values.shrink_to_fit();
    bvh_.warnings.push_back(scan_.source() + ": the header says " + std::to_string(declared) +
                            " frames, the file has " + std::to_string(frames) + ": those are read");
  }

  TextScanner scan_;
  BvhFile bvh_;
  std::vector<int> open_;
  size_t root_ = 0;  // root joint of the current skeleton
};

}  // namespace

size_t BvhFile::ChannelCount() const {
  size_t count = 0;
  for (const BvhJoint& joint : joints) count += joint.channels.size();
  return count;
}

size_t BvhFile::FrameCount() const {
  const size_t channels = ChannelCount();
  return channels == 0 ? 0 : values.size() / channels;
}

BvhFramePose ComputePose(const BvhFile& bvh, size_t frame) {
  const double* value = bvh.values.data() + frame * bvh.ChannelCount();
  BvhFramePose pose;
  pose.position.reserve(bvh.joints.size());
  pose.rotation.reserve(bvh.joints.size());
  for (const BvhJoint& joint : bvh.joints) {
    // A position channel replaces its component of OFFSET, for any joint.
    Eigen::Vector3d local = joint.offset;
    Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
    for (const BvhChannel channel : joint.channels) {
      const int axis = static_cast<int>(channel) % 3;
      if (channel < BvhChannel::kXrotation) {
        local[axis] = *value++;
      } else {
        const double angle_rad = *value++ * std::numbers::pi / 180.0;
        rotation = rotation * Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::Unit(axis));
      }
    }
    if (joint.parent < 0) {
      pose.position.push_back(local);
      pose.rotation.push_back(rotation);
    } else {
      const auto parent = static_cast<size_t>(joint.parent);
      pose.position.push_back(pose.position[parent] + pose.rotation[parent] * local);
      pose.rotation.push_back((pose.rotation[parent] * rotation).normalized());
    }
  }
  return pose;
}

std::vector<BvhFile> SplitRoots(BvhFile bvh) {
  std::vector<size_t> roots;
  for (size_t j = 0; j < bvh.joints.size(); ++j) {
    if (bvh.joints[j].parent < 0) roots.push_back(j);
  }
  std::vector<BvhFile> files;
  if (roots.size() == 1) {
    files.push_back(std::move(bvh));
    return files;
  }
  const size_t channels = bvh.ChannelCount(), frames = bvh.FrameCount();
  size_t first_channel = 0;
  for (size_t r = 0; r < roots.size(); ++r) {
    const size_t end = r + 1 < roots.size() ? roots[r + 1] : bvh.joints.size();
    BvhFile& own = files.emplace_back();
    own.frame_s = bvh.frame_s;
    if (r == 0) own.warnings = bvh.warnings;
    for (size_t j = roots[r]; j < end; ++j) {
      own.joints.push_back(bvh.joints[j]);
      if (own.joints.back().parent >= 0) own.joints.back().parent -= static_cast<int>(roots[r]);
    }
    const size_t own_channels = own.ChannelCount();
    own.values.reserve(frames * own_channels);
    for (size_t f = 0; f < frames; ++f) {
      const auto begin =
          bvh.values.begin() + static_cast<std::ptrdiff_t>(f * channels + first_channel);
      own.values.insert(own.values.end(), begin, begin + static_cast<std::ptrdiff_t>(own_channels));
    }
    first_channel += own_channels;
  }
  return files;
}

BvhFile ParseBvh(std::string text, const std::string& source) {
  return Parser(std::move(text), source).Run();
}

BvhFile ReadBvh(const std::filesystem::path& path) {
  return ParseBvh(ReadTextFile(path), path.string());
}

SourceMotion ToSourceMotion(BvhFile file, const std::string& source) {
  const auto bvh = std::make_shared<const BvhFile>(std::move(file));
  SourceMotion motion;
  motion.source = source;
  motion.frame_s = bvh->frame_s;
  motion.frame_count = bvh->FrameCount();
  if (motion.frame_count == 0) {
    throw InputError(source + ": expected channels of the root '" + bvh->joints.front().name +
                     "', found none");
  }
  for (const BvhJoint& joint : bvh->joints) {
    motion.joints.push_back({joint.name, joint.parent, joint.offset, joint.end_sites});
  }
  motion.frame = [bvh](size_t frame) {
    BvhFramePose pose = ComputePose(*bvh, frame);
    return SourceFrame{std::move(pose.position), std::move(pose.rotation)};
  };
  return motion;
}

void ForEachPerson(BvhFile bvh, const std::string& source, std::vector<std::string>& warnings,
                   const std::function<void(BvhFile)>& take) {
  std::optional<InputError> nobody;
  bool anybody = false;
  for (BvhFile& root : SplitRoots(std::move(bvh))) {
    const std::string name = root.joints.front().name;
    try {
      take(std::move(root));
      anybody = true;
    } catch (const InputError& error) {
      if (!nobody) nobody = error;
      std::string reason = error.what();
      if (reason.starts_with(source + ": ")) reason.erase(0, source.size() + 2);
      warnings.push_back(source + ": the root '" + name + "' is ignored: " + reason);
    }
  }
  if (!anybody && nobody) throw *nobody;
}

}  // namespace ossa::recon
