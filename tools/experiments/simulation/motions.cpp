#include "tools/experiments/simulation/motions.h"

#include <fmt/format.h>

#include <algorithm>

#include "depth/base/error.h"
#include "recon/motion/authored.h"
#include "recon/motion/mocap.h"
#include "tools/experiments/compare/select_evenly.h"

namespace ossa::tools {
namespace {

// Clips of CMU subjects that the shipped model was not trained on: striking, bending and lifting,
// swordplay, washing, turning dances.
const std::vector<std::string> kHeldOutClips = {"02_05", "02_06", "02_07", "02_08", "02_09",
                                                "02_10", "60_01", "60_05", "60_10", "60_14"};
// Two CMU subjects, and the subject of another corpus with a mapping file beside it.
const std::vector<std::string> kOfCmu = {"02_05", "02_07", "02_08", "02_10",
                                         "60_06", "60_11", "60_12"};
const std::vector<std::string> kOfBandai = {
    "dataset-1_byebye_tired_001", "dataset-1_kick_normal_001", "dataset-1_slash_normal_001"};
// Constants: chosen by hand unless stated otherwise.

constexpr uint64_t kOtherMovers =
    7919;  // added to the seed, for other movers than the shipped database's

bool StaysInView(const recon::MotionClip& clip, size_t frames) {
  constexpr double kRoom_m = 1.4;
  Eigen::Vector3d low = clip.frames[0].root_m;
  Eigen::Vector3d high = low;
  for (size_t f = 0; f < std::min(frames, clip.frames.size()); ++f) {
    low = low.cwiseMin(clip.frames[f].root_m);
    high = high.cwiseMax(clip.frames[f].root_m);
  }
  return std::max(high.x() - low.x(), high.z() - low.z()) < kRoom_m;
}

/// The named clips of a folder that are long enough.
std::vector<recon::MotionClip> Named(const std::filesystem::path& folder,
                                     const std::vector<std::string>& names,
                                     const recon::MocapOptions& options, int frames) {
  std::vector<recon::MotionClip> found;
  if (!std::filesystem::exists(folder)) return found;
  for (recon::MotionClip& clip : recon::LoadMocap({folder.string()}, options)) {
    const bool wanted = std::any_of(names.begin(), names.end(), [&](const std::string& name) {
      return clip.name.find(name) != std::string::npos;
    });
    if (wanted && clip.frames.size() >= static_cast<size_t>(frames) / 2) {
      found.push_back(std::move(clip));
    }
  }
  return found;
}

}  // namespace

void ReadMotions(ExperimentContext& context) {
  context.parameters.Motion("motion", "");
  context.parameters.Texts("only", {});
}

StudyMotion TenPerformances(ExperimentContext& context, int frames) {
  const auto mocap = context.shared / "mocap";
  recon::MocapOptions options;
  auto of_cmu = Named(mocap / "cmu30", kOfCmu, options, frames);
  options.mapping_file = (mocap / "bandai_validation" / "mapping.txt").string();
  auto others = Named(mocap / "bandai_validation", kOfBandai, options, frames);
  const bool has_all = of_cmu.size() == kOfCmu.size() && others.size() == kOfBandai.size();
  const bool other_asked = !context.parameters.Motion("motion", "").empty() ||
                           !context.parameters.Texts("only", {}).empty();
  if (context.shared.empty() || !has_all || other_asked) {
    return StudyMotions(context, kOfCmu.size() + kOfBandai.size(), frames);
  }
  StudyMotion motion;
  for (size_t i = 0; i < 4; ++i) {  // alternates between the three people
    motion.clips.push_back(std::move(of_cmu[i]));
    if (i < 3) motion.clips.push_back(std::move(of_cmu[4 + i]));
    if (i < 3) motion.clips.push_back(std::move(others[i]));
  }
  motion.note =
      "Motions: ten performances of three people, none of them in the shipped database or forest "
      "(settings of best were chosen on one of them). ";
  return motion;
}

StudyMotion StudyMotions(ExperimentContext& context, size_t count, int frames) {
  const auto mocap = context.shared / "mocap" / "cmu30";
  const bool shared = !context.shared.empty() && std::filesystem::exists(mocap);
  const std::string source =
      context.parameters.Motion("motion", shared ? mocap.string() : "authored");
  const auto only = context.parameters.Texts(
      "only", shared && source == mocap ? kHeldOutClips : std::vector<std::string>{});
  recon::MocapOptions options;
  options.seed = context.seed + kOtherMovers;
  StudyMotion motion;
  for (recon::MotionClip& clip : recon::LoadMocap({source}, options)) {
    const bool wanted =
        only.empty() || std::any_of(only.begin(), only.end(), [&](const std::string& part) {
          return clip.name.find(part) != std::string::npos;
        });
    const auto least = static_cast<size_t>(frames) / 2;
    if (!wanted || clip.frames.size() < least) continue;
    if (StaysInView(clip, static_cast<size_t>(frames))) motion.clips.push_back(std::move(clip));
  }
  if (motion.clips.empty()) {
    throw InputError(
        fmt::format("{}: expected clips of at least {} frames, found none", source, frames / 2));
  }
  motion.clips = SelectEvenly(std::move(motion.clips), count);
  motion.note =
      source == "authored"
          ? "Motions: ossa's authored clips by other movers than the shipped database's. "
          : fmt::format("Motions: {} clips of mocap, none of them in the shipped database. ",
                        motion.clips.size());
  return motion;
}

std::vector<recon::MotionClip> AuthoredMotions(const ExperimentContext& context,
                                               const std::vector<std::string>& actions,
                                               int variations) {
  recon::AuthoredOptions options;
  options.seed = context.seed + kOtherMovers;
  options.variations = variations;
  std::vector<recon::MotionClip> clips;
  for (recon::MotionClip& clip : recon::AuthoredClips(options)) {
    const bool wanted = std::any_of(actions.begin(), actions.end(), [&](const std::string& action) {
      return clip.name.find("/" + action + "/") != std::string::npos;
    });
    if (wanted) clips.push_back(std::move(clip));
  }
  return clips;
}

}  // namespace ossa::tools
