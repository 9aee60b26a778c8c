#include "tools/tracker/fit_surface_internal.h"

#include <cstdint>
#include <vector>

namespace ossa::tracker {
namespace {

/// Classified pixels and their part labels.
struct Labelled {
  std::vector<int32_t> pixels;  // of the frame
  std::vector<uint8_t> parts;
};

// Classified pixels that are still in the candidate, from which furniture may have been removed
// since. Both lists ascend.
Labelled LabelledPixels(const depth::DepthFrame& frame, const people::Detection& detection) {
  const auto& seen = detection.evidence.classification;
  const auto& own = detection.candidate.pixels;
  const int scale = detection.evidence.scale;
  const int width = (frame.camera.width + scale - 1) / scale;
  Labelled labelled;
  size_t next = 0;
  for (size_t i = 0; i < seen.pixel.size(); ++i) {
    const int u = seen.pixel[i] % width * scale, v = seen.pixel[i] / width * scale;
    const int32_t pixel = v * frame.camera.width + u;
    while (next < own.size() && own[next] < pixel) ++next;
    if (next == own.size()) break;
    if (own[next] != pixel) continue;
    labelled.pixels.push_back(pixel);
    labelled.parts.push_back(seen.label[i]);
  }
  return labelled;
}

}  // namespace

std::optional<recon::SurfaceFit> FitSurface(const depth::DepthFrame& frame,
                                            const people::Detection& detection, const Body& body,
                                            Person& person) {
  const Labelled labelled = LabelledPixels(frame, detection);
  recon::SurfaceFitInput input;
  input.joints_m = body.refined ? *body.refined : body.raw.posture;
  // The refinement also places joints that the forest did not find; these get confidence 0.
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    const bool found = body.raw.state[j] != recon::TrackingState::kNotTracked;
    if (found) input.confidence[j] = body.raw.confidence[j];
    if (!found && body.refined) input.confidence[j] = 0.0;
  }
  input.depth = &frame;
  input.pixels = detection.candidate.pixels;
  input.samples = labelled.pixels;
  input.parts = labelled.parts;
  input.sample_step = detection.evidence.scale;
  input.shape = person.shape.shape;
  input.shape_frames = person.shape.frames;
  auto fit = person.fitter->Fit(input);
  if (fit) person.shape.Add(*fit);
  return fit;
}

void DoubtUnexplained(const recon::SurfaceFit& fit, const recon::BodySurface& surface,
                      double doubt_residual_m, recon::JointArray<double>& trust) {
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    const auto& residual_m = fit.residual_m[surface.landmark_segment[j]];
    if (!residual_m) continue;
    const double off = *residual_m / doubt_residual_m;
    trust[j] /= 1.0 + off * off;
  }
}

}  // namespace ossa::tracker
