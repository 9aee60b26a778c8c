#include "tools/commands/track_outputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "depth/image/camera_presets.h"
#include "tools/commands/outputs.h"
#include "tools/tracker/picture.h"

namespace ossa::commands {
namespace {

size_t TrackedJoints(const tracker::BodyFrame& bodies) {
  size_t count = 0;
  for (const tracker::Body& body : bodies.bodies) {
    count += static_cast<size_t>(std::count_if(
        body.joints.begin(), body.joints.end(),
        [](const tracker::JointEstimate& j) { return j.state == recon::TrackingState::kTracked; }));
  }
  return count;
}

// Bounds of nearly all adults; for a child the message appears, too, and may be right.
constexpr double kLeastStature_m = 1.35, kMostStature_m = 2.15;  // by hand

bool IsUnlikelyStature(const recon::Stature& stature) {
  constexpr double kSigmas = 2.0;  // standard deviations, by hand: unlikely by chance
  const double sure_m = kSigmas * stature.sigma_m;
  return stature.stature_m + sure_m < kLeastStature_m ||
         stature.stature_m - sure_m > kMostStature_m;
}

/// Presets with which a person of this stature by `camera` would have a common one; "" if there is
/// none.
std::string ListLikelierCameras(double stature_m, const depth::Camera& camera) {
  constexpr double kShort_m = 1.5, kTall_m = 2.0;  // by hand
  std::string list;
  for (const std::string_view name : depth::CameraPresetNames()) {
    const depth::Camera other = depth::PresetCamera(name, camera.width, camera.height);
    const double so_m = stature_m * camera.fx / other.fx;
    if (so_m < kShort_m || so_m > kTall_m) continue;
    list += fmt::format("{}{}: {:.2f} m", list.empty() ? " (" : ", ", name, so_m);
  }
  return list.empty() ? list : list + ")";
}

}  // namespace

SkeletonOutput::SkeletonOutput(const TrackOptions& options)
    : path_(options.out), recorder_(options) {
  if (path_.empty()) return;
  PrintLeftovers(path_);
  writer_.emplace(path_, options.write.For(path_));
}

void SkeletonOutput::Write(const tracker::BodyFrame& bodies) {
  if (!writer_) return;
  for (const tracker::Body& body : bodies.bodies) {
    if (body.shape) writer_->SetShape(body.id, body.shape->shape);
  }
  try {
    writer_->Write(recorder_.Record(bodies));
  } catch (const DiskFull& full) {
    full_ = full;
    throw;
  }
}

void SkeletonOutput::Finish() {
  if (!writer_) return;
  try {
    if (full_) throw DiskFull(*full_);
    writer_->Finish();
  } catch (const DiskFull& full) {
    throw FinishWithWhatFits(full, *writer_);
  }
}

Pictures::Pictures(const TrackOptions& options) : one_(options.picture), folder_(options.pictures) {
  if (!folder_.empty()) std::filesystem::create_directories(folder_);
  if (!one_.empty()) AtomicFile::CheckWritable(one_);
}

void Pictures::Take(const depth::DepthFrame& frame, const tracker::BodyFrame& bodies) {
  WriteToFolder(frame, bodies);
  if (one_.empty() || (has_best_ && TrackedJoints(bodies) < TrackedJoints(best_))) return;
  has_best_ = true;
  best_frame_ = frame;
  best_ = bodies;
}

void Pictures::WriteToFolder(const depth::DepthFrame& frame, const tracker::BodyFrame& bodies) {
  if (folder_.empty()) return;
  const auto name = fmt::format("{:06d}.png", bodies.index);
  try {
    tracker::WritePicture(std::filesystem::path(folder_) / name, frame, bodies);
  } catch (const DiskFull& full) {
    full_ = full;
    throw;
  }
  ++in_folder_;
}

void Pictures::Finish() const {
  if (!one_.empty() && has_best_) tracker::WritePicture(one_, best_frame_, best_);
  if (full_) throw MakeKeptError(*full_, in_folder_, in_folder_ + 1);
}

PersonKeeper::PersonKeeper(const TrackOptions& options) : path_(options.save_person) {
  if (!path_.empty()) AtomicFile::CheckWritable(path_);
}

void PersonKeeper::Take(const tracker::BodyFrame& bodies) {
  for (const tracker::Body& body : bodies.bodies) {
    if (!body.shape) continue;
    Kept& kept = kept_[body.id];
    kept.shape = *body.shape;
    kept.fits += body.fit ? 1 : 0;
  }
}

const std::pair<const int, PersonKeeper::Kept>* PersonKeeper::FindMostFitted() const {
  const auto most = std::max_element(kept_.begin(), kept_.end(), [](const auto& a, const auto& b) {
    return a.second.fits < b.second.fits;
  });
  return most == kept_.end() || most->second.fits == 0 ? nullptr : &*most;
}

void PersonKeeper::PrintUnlikelyStature(const TrackOptions& options,
                                        const depth::Camera& camera) const {
  const std::string& preset = *options.source.guessed;
  const auto* most = FindMostFitted();
  if (options.quiet || !options.source.camera.empty() || preset.empty() || most == nullptr) return;
  const recon::Stature stature =
      recon::MeasureStature(most->second.shape, *options.tracker.models->surface);
  if (!IsUnlikelyStature(stature)) return;
  PrintError(
      fmt::format("ossa track: {}: person {} is {:.2f} m tall as a {} sees them (f {:.0f} px), "
                  "which nothing but the image size spoke for: unless they are, see whether "
                  "--camera{} and --depth-scale are right\n",
                  options.source.name, most->first, stature.stature_m, preset, camera.fx,
                  ListLikelierCameras(stature.stature_m, camera)));
}

void PersonKeeper::Finish(const TrackOptions& options) const {
  if (path_.empty()) return;
  const auto* most = FindMostFitted();
  if (most == nullptr) {
    throw InputError(path_ + ": expected a person in the recording, found none; not written");
  }
  const recon::PersonShape& shape = most->second.shape;
  const recon::BodySurface& surface = *options.tracker.models->surface;
  shape.Save(path_, surface);
  const recon::Stature stature = recon::MeasureStature(shape, surface);
  if (options.quiet) return;
  fmt::print("{}: person {}, {:.2f} m tall, give or take {:.0f} cm, by {} frames\n", path_,
             most->first, stature.stature_m, 100.0 * stature.sigma_m, shape.frames);
}

}  // namespace ossa::commands
