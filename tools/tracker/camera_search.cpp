#include "tools/tracker/camera_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <system_error>
#include <utility>

namespace ossa::tracker {
namespace {

using recon::Joint;

// Of whoever is seen, these are; where limbs are says little of their size.
constexpr std::array kTrunk = {Joint::kHead,          Joint::kShoulderCenter, Joint::kShoulderLeft,
                               Joint::kShoulderRight, Joint::kSpine,          Joint::kHipCenter,
                               Joint::kHipLeft,       Joint::kHipRight};

double MeasureSurety(const Body& body) {
  double sum = 0.0;
  for (const Joint joint : kTrunk) sum += body.joints[joint].confidence;
  return sum / static_cast<double>(kTrunk.size());
}

TrackerOptions OptionsOfStills(TrackerOptions options) {
  options.method = "none";
  options.physics = options.keep_parts = options.trace = false;
  options.keep_probabilities = options.keep_proposals = false;
  options.scene.reset();
  options.fit.reset();
  options.smoothing.reset();
  options.bones_m.clear();
  options.shapes.clear();
  options.lag = 0;
  return options;
}

bool HoldsImages(const std::filesystem::path& source) {
  std::error_code unknown;  // told of when the source is opened
  if (std::filesystem::is_directory(source, unknown)) return true;
  return std::filesystem::is_regular_file(source, unknown) && depth::IsRecording(source) &&
         source.extension() != ".oni" && source.extension() != ".mkv";
}

// Where it is guessed by the images' size.
std::optional<depth::CameraGuess> FindGuess(const std::string& source,
                                            depth::SourceOptions options) {
  std::optional<depth::CameraGuess> guessed;
  options.guessed = [&guessed](const depth::CameraGuess& guess) { guessed = guess; };
  depth::OpenSource(source, options);
  return guessed;
}

// Stills far apart: a quarter of a minute of a recording, all of a few photographs.
void LookAtSome(depth::FrameSource& source, const std::function<bool()>& idle,
                CameraSearch& search) {
  constexpr int64_t kMostFrames = 480, kMostStep = 15;  // by hand
  const int64_t step = std::clamp(source.frame_count().value_or(0) / 16, int64_t{1}, kMostStep);
  for (int64_t n = 0; n < kMostFrames && !search.is_sure() && idle();) {
    depth::ReadResult read = source.Read(std::chrono::milliseconds(100));
    if (read.status == depth::ReadStatus::kEnd) return;
    if (read.status == depth::ReadStatus::kFrame && n++ % step == 0) {
      search.Look(std::move(read.frame));
    }
  }
}

}  // namespace

CameraSearch::CameraSearch(std::vector<depth::Camera> cameras, TrackerOptions options)
    : cameras_(std::move(cameras)),
      surety_(cameras_.size(), 0.0),
      tracker_(OptionsOfStills(std::move(options))) {}

void CameraSearch::Look(depth::DepthFrame frame) {
  constexpr double kAnybody = 0.3;  // surety, no unit; by hand: less is no part of anybody
  std::vector<double> surety(cameras_.size(), 0.0);
  for (size_t c = 0; c < cameras_.size(); ++c) {
    frame.camera = cameras_[c];
    tracker_.Reset();
    for (const Body& body : tracker_.Track(frame).bodies) {
      surety[c] = std::max(surety[c], MeasureSurety(body));
    }
  }
  if (*std::max_element(surety.begin(), surety.end()) < kAnybody) return;
  for (size_t c = 0; c < cameras_.size(); ++c) surety_[c] += surety[c];
  ++looks_;
}

size_t CameraSearch::Best() const {
  // Mean surety, no unit, by hand: real people seen by the right camera differ by less than 0.05
  // from the same seen by one of a view 1.44 times narrower, and by 0.17 to 1 the other way round.
  constexpr double kMuchSurer = 0.15;
  const auto best = std::max_element(surety_.begin(), surety_.end());
  return *best > surety_.front() + kMuchSurer * looks_ ? static_cast<size_t>(best - surety_.begin())
                                                       : 0;
}

std::string CameraText(const depth::CameraGuess& camera) {
  if (!camera.preset.empty()) return std::string(camera.preset);
  const depth::Camera& c = camera.camera;
  return fmt::format("{:.1f},{:.1f},{:.1f},{:.1f}", c.fx, c.fy, c.cx, c.cy);
}

std::string Describe(const CameraFinding& finding) {
  const auto& [guess, found] = finding;
  return fmt::format(
      "no camera is stated; people in its images of {}x{} are far surer as --camera {} (f {:.0f} "
      "px) sees them than as a {} does (f {:.0f} px): taken for that",
      guess.camera.width, guess.camera.height, CameraText(found), found.camera.fx, guess.preset,
      guess.camera.fx);
}

std::optional<CameraFinding> FindNarrowerCamera(
    const std::string& source, const depth::SourceOptions& options,
    const std::function<TrackerOptions()>& tracker_options, const std::function<bool()>& idle) {
  if (!HoldsImages(source)) return std::nullopt;
  const auto guess = FindGuess(source, options);
  if (!guess) return std::nullopt;
  const auto others = depth::NarrowerCameras(guess->camera.width, guess->camera.height);
  if (others.empty()) return std::nullopt;
  std::vector<depth::Camera> cameras = {guess->camera};
  for (const depth::CameraGuess& other : others) cameras.push_back(other.camera);
  CameraSearch search(cameras, tracker_options());
  LookAtSome(*depth::OpenSource(source, options), idle, search);
  const size_t best = search.Best();
  if (best == 0) return std::nullopt;
  return CameraFinding{*guess, others[best - 1]};
}

}  // namespace ossa::tracker
