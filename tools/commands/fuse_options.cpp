#include "tools/commands/fuse_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "depth/base/angles.h"
#include "depth/base/atomic_file.h"
#include "recon/fuse/fuse_skeletons.h"
#include "tools/commands/command.h"
#include "tools/commands/outputs.h"

namespace ossa::commands {
namespace {

void PrintCamera(const std::string& first, const recon::CameraEstimate& estimate) {
  const Eigen::Isometry3d& moved = estimate.camera.from_camera_0;
  fmt::print(
      "{}: {:.2f} m from {}, turned by {:.1f} degrees, clock offset {:.3f} s; joints {:.1f} cm "
      "apart (median) over {:.1f} s\n",
      estimate.camera.name, moved.translation().norm(), first,
      Eigen::AngleAxisd(moved.linear()).angle() / kDegree, estimate.camera.clock_offset_s,
      100.0 * estimate.disagreement_m, estimate.common_s);
}

recon::Extrinsics ReadCameras(const std::string& file, std::span<const std::string> names) {
  return recon::SelectCameras(recon::ReadExtrinsics(file), names, file);
}

recon::Extrinsics FindExtrinsics(const FuseArguments& arguments,
                                 const std::vector<std::string>& names,
                                 std::span<const recon::SkeletonSequence> recordings, bool quiet) {
  if (!arguments.File().empty()) return ReadCameras(arguments.File(), names);
  recon::Extrinsics cameras{{.name = names.front()}};
  for (size_t k = 1; k < recordings.size(); ++k) {
    auto estimate = recon::EstimateCamera(recordings.front(), recordings[k], arguments.estimate);
    estimate.camera.name = names[k];
    if (!quiet) PrintCamera(names.front(), estimate);
    cameras.push_back(estimate.camera);
  }
  return cameras;
}

}  // namespace

void FuseArguments::AddTo(CLI::App& app) {
  app.add_option("--extrinsics", extrinsics,
                 "camera poses: a file such as `ossa render --cameras` writes, matched by the "
                 "recordings' names, else by order; or auto: estimated from moving people whom the "
                 "first camera and each other one see")
      ->capture_default_str();
  app.add_option("--save-extrinsics", save_extrinsics, "write the camera poses to FILE.json");
  app.add_option("--max-offset", estimate.max_clock_offset_s,
                 "largest clock offset that auto considers, seconds")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 60.0))
      ->each([this](const std::string&) { states_max_offset = true; });
}

void FuseArguments::Check(std::span<const std::string> sources) const {
  if (states_max_offset && !File().empty()) {
    throw Contradiction("--max-offset: expected --extrinsics auto with it, found " + File());
  }
  for (const std::string& source : sources) {
    if (std::count(sources.begin(), sources.end(), source) == 1) continue;
    throw UsageError(source + ": expected a recording of each camera, found this one twice");
  }
  CheckNotOtherKind("--save-extrinsics", save_extrinsics, ".json");
  if (!save_extrinsics.empty()) AtomicFile::CheckWritable(save_extrinsics);
  if (!File().empty()) ReadCameras(File(), recon::CameraNames(sources));
}

FusedRecordings FuseRecordings(const FuseArguments& arguments, std::span<const std::string> sources,
                               std::span<const recon::SkeletonSequence> recordings, bool quiet) {
  const std::vector<std::string> names = recon::CameraNames(sources);
  recon::Extrinsics cameras = FindExtrinsics(arguments, names, recordings, quiet);
  recon::SkeletonSequence skeletons = recon::FuseSkeletons(recordings, cameras);
  return {std::move(skeletons), std::move(cameras)};
}

void WriteFused(const char* command, const FuseArguments& arguments, const std::string& out,
                const FusedRecordings& fused, const recon::SkeletonWriteOptions& options) {
  DoEach(command, {[&] {
                     if (!out.empty()) WriteSkeletonsThatFit(out, fused.skeletons, options);
                   },
                   [&] {
                     if (arguments.save_extrinsics.empty()) return;
                     recon::WriteExtrinsics(arguments.save_extrinsics, fused.cameras);
                   }});
}

}  // namespace ossa::commands
