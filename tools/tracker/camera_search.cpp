#include "tools/tracker/camera_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <system_error>
#include <utility>

#include "depth/base/lower_case.h"

namespace ossa::tracker {
namespace {

using recon::Joint;

// The trunk's confidence measures the fit of the scale; limbs are often occluded.
constexpr std::array kTrunk = {Joint::kHead,          Joint::kShoulderCenter, Joint::kShoulderLeft,
                               Joint::kShoulderRight, Joint::kSpine,          Joint::kHipCenter,
                               Joint::kHipLeft,       Joint::kHipRight};

double MeasureConfidence(const Body& body) {
  double sum = 0.0;
  for (const Joint joint : kTrunk) sum += body.joints[joint].confidence;
  return sum / static_cast<double>(kTrunk.size());
}

TrackerOptions OptionsForStills(TrackerOptions options) {
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
  std::error_code unknown;  // reported when the source is opened
  if (std::filesystem::is_directory(source, unknown)) return true;
  return std::filesystem::is_regular_file(source, unknown) && depth::IsRecording(source) &&
         LowerCaseExtension(source) != ".oni" && LowerCaseExtension(source) != ".mkv";
}

// The default camera, where it is chosen by the images' size.
std::optional<depth::CameraGuess> FindGuess(const std::string& source,
                                            depth::SourceOptions options) {
  std::optional<depth::CameraGuess> guessed;
  options.guessed = [&guessed](const depth::CameraGuess& guess) { guessed = guess; };
  depth::OpenSource(source, options);
  return guessed;
}

// Every n-th frame: of a quarter of a minute of a recording, all of a few photographs.
void AddSomeImages(depth::FrameSource& source, const std::function<bool()>& idle,
                   CameraSearch& search) {
  constexpr int64_t kMostFrames = 480, kMostStep = 15;  // by hand
  const int64_t step = std::clamp(source.frame_count().value_or(0) / 16, int64_t{1}, kMostStep);
  for (int64_t n = 0; n < kMostFrames && !search.is_sure() && idle();) {
    depth::ReadResult read = source.Read(std::chrono::milliseconds(100));
    if (read.status == depth::ReadStatus::kEnd) return;
    if (read.status == depth::ReadStatus::kFrame && n++ % step == 0) {
      search.AddImage(std::move(read.frame));
    }
  }
}

}  // namespace

CameraSearch::CameraSearch(std::vector<depth::Camera> cameras, TrackerOptions options)
    : cameras_(std::move(cameras)),
      confidence_sum_(cameras_.size(), 0.0),
      tracker_(OptionsForStills(std::move(options))) {}

void CameraSearch::AddImage(depth::DepthFrame frame) {
  constexpr double kMinConfidence = 0.3;  // confidence; by hand: lower ones are false positives
  std::vector<double> confidence(cameras_.size(), 0.0);
  for (size_t c = 0; c < cameras_.size(); ++c) {
    frame.camera = cameras_[c];
    tracker_.Reset();
    for (const Body& body : tracker_.Track(frame).bodies) {
      confidence[c] = std::max(confidence[c], MeasureConfidence(body));
    }
  }
  if (*std::max_element(confidence.begin(), confidence.end()) < kMinConfidence) return;
  for (size_t c = 0; c < cameras_.size(); ++c) confidence_sum_[c] += confidence[c];
  ++images_;
}

size_t CameraSearch::Best() const {
  // Difference of mean confidence, by hand: for real people the right camera differs by less than
  // 0.05 from one with a view 1.44 times narrower, and by 0.17 to 1 the other way round.
  constexpr double kMinGain = 0.15;
  const auto best = std::max_element(confidence_sum_.begin(), confidence_sum_.end());
  return *best > confidence_sum_.front() + kMinGain * images_
             ? static_cast<size_t>(best - confidence_sum_.begin())
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
      "no camera is stated; people in its images of {}x{} have much higher scores with --camera {} "
      "(f {:.0f} px) than with {} (f {:.0f} px): that camera is used",
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
  AddSomeImages(*depth::OpenSource(source, options), idle, search);
  const size_t best = search.Best();
  if (best == 0) return std::nullopt;
  return CameraFinding{*guess, others[best - 1]};
}

}  // namespace ossa::tracker
