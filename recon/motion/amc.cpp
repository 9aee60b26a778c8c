#include <algorithm>
#include <numbers>

#include "depth/base/error.h"
#include "depth/base/lower_case.h"
#include "recon/motion/acclaim_internal.h"
#include "recon/motion/text_scanner_internal.h"

namespace ossa::recon {
namespace {

namespace fs = std::filesystem;

/// The values of all frames, concatenated for all bones in skeleton order.
struct AmcData {
  std::shared_ptr<const AcclaimSkeleton> skeleton;
  std::vector<size_t> first;  // offset of each bone's values in a frame
  size_t per_frame = 0;
  bool degrees = true;
  std::vector<double> values;
};

class AmcParser {
 public:
  AmcParser(std::string text, const std::string& source,
            std::shared_ptr<const AcclaimSkeleton> skeleton)
      : scan_(std::move(text), source) {
    data_.skeleton = std::move(skeleton);
    data_.degrees = data_.skeleton->degrees;
    for (const AcclaimBone& bone : data_.skeleton->bones) {
      data_.first.push_back(data_.per_frame);
      data_.per_frame += bone.dofs.size();
    }
  }

  AmcData Run() {
    if (data_.per_frame == 0) {
      throw InputError(data_.skeleton->source + ": expected degrees of freedom, found none");
    }
    std::vector<std::string_view> line = ReadHeader();
    if (line.empty()) scan_.Fail("a frame number", "");
    while (!line.empty()) {
      const double number = scan_.ToNumber(line[0], "a frame number");
      if (line.size() != 1 || number <= last_number_) scan_.Fail("the next frame number", line[0]);
      last_number_ = number;
      line = ReadFrame();
    }
    return std::move(data_);
  }

 private:
  std::vector<std::string_view> Next() {
    auto line = scan_.ReadWordsOfLine();
    while (!line.empty() && line.front().starts_with('#')) line = scan_.ReadWordsOfLine();
    return line;
  }

  /// Reads the ":..." lines before the first frame; an angle unit here overrides the skeleton's.
  std::vector<std::string_view> ReadHeader() {
    auto line = Next();
    for (; !line.empty() && line.front().starts_with(':'); line = Next()) {
      const std::string word = LowerCase(line.front());
      if (word == ":degrees") data_.degrees = true;
      if (word == ":radians") data_.degrees = false;
    }
    return line;
  }

  static bool IsNumber(std::string_view word) {
    return !word.empty() && word.find_first_not_of("0123456789") == std::string_view::npos;
  }

  /// Bones missing in a frame keep their values. Returns the line after the frame.
  std::vector<std::string_view> ReadFrame() {
    const size_t begin = data_.values.size();
    // A bound by hand: two hours of CMU's 62 values at 120 Hz. A frame of a few bytes may repeat
    // thousands of values.
    constexpr size_t kMostValues = size_t{1} << 26;
    if (begin + data_.per_frame > kMostValues) {
      throw InputError(scan_.source() + ": expected at most " + std::to_string(kMostValues) +
                       " numbers (frames x degrees of freedom), found more");
    }
    if (begin == 0) {
      data_.values.assign(data_.per_frame, 0.0);
    } else {
      const std::vector<double> before(
          data_.values.end() - static_cast<std::ptrdiff_t>(data_.per_frame), data_.values.end());
      data_.values.insert(data_.values.end(), before.begin(), before.end());
    }
    bool any = false;
    auto line = Next();
    for (; !line.empty() && !IsNumber(line.front()); line = Next()) {
      const int bone = data_.skeleton->BoneNamed(line.front());
      if (bone < 0) scan_.Fail("a bone of " + data_.skeleton->source, line.front());
      const size_t dofs = data_.skeleton->bones[static_cast<size_t>(bone)].dofs.size();
      if (line.size() != dofs + 1) {
        scan_.Fail(std::to_string(dofs) + " numbers for bone " + std::string(line.front()),
                   std::to_string(line.size() - 1) + " numbers");
      }
      for (size_t d = 0; d < dofs; ++d) {
        data_.values[begin + data_.first[static_cast<size_t>(bone)] + d] =
            scan_.ToNumber(line[d + 1], "a bone's value");
      }
      any = true;
    }
    if (!any) scan_.Fail("the bones of a frame", line.empty() ? "" : line.front());
    return line;
  }

  TextScanner scan_;
  AmcData data_;
  double last_number_ = -1.0;
};

/// World rotation from rest: W = W_parent C M C^-1, where M turns about the bone's own axes in the
/// order of its degrees of freedom (the first innermost).
SourceFrame ToSourceFrame(const AmcData& data, size_t frame) {
  const double* values = data.values.data() + frame * data.per_frame;
  const double unit = data.degrees ? std::numbers::pi / 180.0 : 1.0;
  SourceFrame out;
  for (size_t b = 0; b < data.skeleton->bones.size(); ++b) {
    const AcclaimBone& bone = data.skeleton->bones[b];
    Eigen::Quaterniond motion = Eigen::Quaterniond::Identity();
    Eigen::Vector3d place = Eigen::Vector3d::Zero();
    for (size_t d = 0; d < bone.dofs.size(); ++d) {
      const double value = values[data.first[b] + d];
      const auto kind = static_cast<int>(bone.dofs[d]);
      if (kind < 3) {
        motion = Eigen::Quaterniond(Eigen::AngleAxisd(value * unit, Eigen::Vector3d::Unit(kind))) *
                 motion;
      } else if (kind < 6 && b == 0) {
        place[kind - 3] = value * data.skeleton->metres_per_unit;
      }
    }
    const Eigen::Quaterniond turn = bone.axis * motion * bone.axis.conjugate();
    if (b == 0) {
      out.position.push_back(place);
      out.rotation.push_back(turn);
      continue;
    }
    const auto parent = static_cast<size_t>(bone.parent);
    out.position.push_back(out.position[parent] +
                           out.rotation[parent] * data.skeleton->bones[parent].segment);
    out.rotation.push_back((out.rotation[parent] * turn).normalized());
  }
  return out;
}

}  // namespace

SourceMotion ParseAmc(std::string text, const std::string& source,
                      std::shared_ptr<const AcclaimSkeleton> skeleton, double frame_s) {
  const auto data = std::make_shared<const AmcData>(
      AmcParser(std::move(text), source, std::move(skeleton)).Run());
  SourceMotion motion;
  motion.source = source;
  motion.frame_s = frame_s;
  motion.frame_count = data->values.size() / data->per_frame;
  const auto& bones = data->skeleton->bones;
  for (const AcclaimBone& bone : bones) {
    const Eigen::Vector3d offset =
        bone.parent < 0 ? Eigen::Vector3d::Zero() : bones[static_cast<size_t>(bone.parent)].segment;
    motion.joints.push_back({bone.name, bone.parent, offset, {bone.segment}});
  }
  motion.frame = [data](size_t frame) { return ToSourceFrame(*data, frame); };
  return motion;
}

fs::path AsfBeside(const fs::path& amc) {
  std::vector<fs::path> skeletons;
  std::error_code error;
  const fs::path folder = amc.has_parent_path() ? amc.parent_path() : fs::path(".");
  for (auto it = fs::directory_iterator(folder, error); !error && it != fs::directory_iterator();
       it.increment(error)) {
    if (LowerCase(it->path().extension().string()) == ".asf") skeletons.push_back(it->path());
  }
  std::sort(skeletons.begin(), skeletons.end());
  if (skeletons.size() == 1) return skeletons.front();
  const fs::path* best = nullptr;
  const std::string stem = LowerCase(amc.stem().string());
  for (const fs::path& asf : skeletons) {
    const bool fits = stem.starts_with(LowerCase(asf.stem().string()));
    if (fits && (!best || asf.stem().string().size() > best->stem().string().size())) best = &asf;
  }
  if (!best) {
    throw InputError(amc.string() +
                     ": expected its skeleton beside it, an .asf whose name it begins" +
                     " with, found " + std::to_string(skeletons.size()) + " others");
  }
  return *best;
}

}  // namespace ossa::recon
