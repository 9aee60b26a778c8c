// What depth, forest and recon compute of a clip, a line each: a name and the checksum of its
// bytes. The same on every processor; tests/arm64/run compares.
//   room_bytes CLIP MODELS      MODELS: the folder of the shipped models
#include <xxhash.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "depth/sensor/frame_source.h"
#include "forest/classification/classify.h"
#include "forest/forest.h"
#include "forest/proposals/propose.h"
#include "recon/database/posture_database.h"
#include "recon/files/skeleton_io.h"
#include "recon/files/skeleton_jsonl.h"
#include "recon/fit/surface_fit.h"
#include "recon/methods/reconstruct_sequence.h"
#include "recon/refine/refinement_cascade.h"

namespace ossa {
namespace {

using Path = std::filesystem::path;

// The bytes of one result, as they are added.
class Bytes {
 public:
  template <typename T>
  void Add(const T* first, size_t count) {
    const auto* bytes = reinterpret_cast<const char*>(first);
    bytes_.append(bytes, count * sizeof(T));
  }
  template <typename T>
  void Add(const std::vector<T>& values) {
    Add(values.data(), values.size());
  }
  void Add(const Eigen::Vector3d& vector) { Add(vector.data(), 3); }
  void Add(const recon::Posture& posture) {
    for (const auto& joint_m : posture.position_m) Add(joint_m);
  }
  void Add(const std::string& text) { bytes_ += text; }
  void Print(const std::string& name) const {
    std::printf("%s %016llx %zu\n", name.c_str(),
                static_cast<unsigned long long>(XXH3_64bits(bytes_.data(), bytes_.size())),
                bytes_.size());
  }

 private:
  std::string bytes_;
};

std::vector<depth::DepthFrame> ReadFrames(const Path& clip) {
  const auto source = depth::OpenSource(clip);
  std::vector<depth::DepthFrame> frames;
  while (true) {
    depth::ReadResult read = source->Read(std::chrono::milliseconds(1000));
    if (read.status != depth::ReadStatus::kFrame) return frames;
    frames.push_back(std::move(read.frame));
  }
}

// Everything within the person's reach is taken for the person: results need be the same, not good.
std::vector<int32_t> PixelsNear(const depth::DepthFrame& frame, const Eigen::Vector3d& middle_m) {
  constexpr double kReach_m = 0.6;
  std::vector<int32_t> pixels;
  for (size_t i = 0; i < frame.depth_mm.size(); ++i) {
    const double away_m = 1e-3 * frame.depth_mm[i] - middle_m.z();
    if (frame.depth_mm[i] != 0 && std::abs(away_m) < kReach_m) {
      pixels.push_back(static_cast<int32_t>(i));
    }
  }
  return pixels;
}

void PrintForest(const std::vector<depth::DepthFrame>& frames, const recon::SkeletonSequence& truth,
                 const Path& models) {
  const forest::ForestModel model = forest::ReadForestModel(models / "body.ossa");
  Bytes labels;
  Bytes masses;
  Bytes proposals;
  for (size_t f = 0; f < frames.size(); ++f) {
    const recon::Posture joints_m = recon::ToTrackedPosture(truth.frames[f].bodies[0]).posture;
    const std::vector<int32_t> pixels = PixelsNear(frames[f], joints_m.position_m[0]);
    const auto seen = Classify(model, frames[f].view(), frames[f].camera, pixels);
    labels.Add(seen.label);
    labels.Add(seen.leaf);
    masses.Add(seen.mass);
    masses.Add(seen.mass_scale);
    masses.Add(seen.context);
    for (const auto& target : Propose(model, frames[f].view(), frames[f].camera, seen)) {
      for (const forest::Proposal& proposal : target) {
        proposals.Add(proposal.position_m);
        proposals.Add(&proposal.confidence, 1);
      }
    }
  }
  labels.Print("forest/labels");
  masses.Print("forest/masses");
  proposals.Print("forest/proposals");
}

// The clip's joints as a poor sensor would say them, without chance.
recon::SkeletonSequence Disturbed(recon::SkeletonSequence sequence) {
  constexpr double kStep_m = 0.01;
  for (size_t f = 0; f < sequence.frames.size(); ++f) {
    for (recon::BodyRecord& body : sequence.frames[f].bodies) {
      for (size_t j = 0; j < body.joints.size(); ++j) {
        auto& joint = body.joints[j];
        if (!joint) continue;
        joint->position_m.x() += kStep_m * (static_cast<double>((7 * f + 13 * j) % 11) - 5);
        joint->position_m.y() += kStep_m * (static_cast<double>((5 * f + 3 * j) % 7) - 3);
        if ((f + j) % 5 == 0) joint->state = recon::TrackingState::kInferred;
        if ((f / 6 + j) % 9 == 0) joint.reset();
      }
    }
  }
  return sequence;
}

void PrintMethods(const recon::SkeletonSequence& truth, const Path& models) {
  const recon::SkeletonSequence observed = Disturbed(truth);
  recon::ReconstructorOptions options;
  options.database = std::make_shared<const recon::PostureDatabase>(
      recon::PostureDatabase::Load(models / "authored.ossadb"));
  options.local_pca.steps = 8;
  options.local_pca.samples = 60;
  for (const recon::MethodInfo& row : recon::MethodTable()) {
    if (row.learned == recon::Reads::kRequired) continue;  // of a user's own recordings
    options.method = row.name;
    options.learned_file =
        row.learned == recon::Reads::kNothing ? "" : (models / "kinect_v2.ossagp").string();
    Bytes skeletons;
    for (const auto& frame : recon::ReconstructSequence(observed, options).frames) {
      skeletons.Add(recon::SkeletonJsonLine(frame));
    }
    skeletons.Print("recon/" + std::string(row.name));
  }
}

void PrintRefinement(const std::vector<depth::DepthFrame>& frames,
                     const recon::SkeletonSequence& truth, const Path& models) {
  const recon::SkeletonSequence observed = Disturbed(truth);
  const recon::JointRefiner refiner(
      recon::RefinementCascade::Load(models / recon::kShippedRefinement));
  const auto surface = recon::BodySurface::Load(models / "body.ossasurface");
  recon::SurfaceFitter fitter(surface);
  Bytes refined;
  Bytes fitted;
  for (size_t f = 0; f < frames.size(); ++f) {
    const recon::TrackedPosture person = recon::ToTrackedPosture(observed.frames[f].bodies[0]);
    const recon::Posture joints_m = recon::ToTrackedPosture(truth.frames[f].bodies[0]).posture;
    const std::vector<int32_t> pixels = PixelsNear(frames[f], joints_m.position_m[0]);
    std::vector<uint8_t> is_person(frames[f].depth_mm.size());
    for (const int32_t pixel : pixels) is_person[static_cast<size_t>(pixel)] = 1;
    recon::RefinementInput input;
    input.proposed = joints_m;
    input.depth = &frames[f];
    input.is_person = is_person;
    input.confidence = person.confidence;
    if (const auto result = refiner.Refine(input)) {
      refined.Add(result->joints_m);
      if (result->bones_m) refined.Add(result->bones_m->data(), result->bones_m->size());
    }
    recon::SurfaceFitInput seen;
    seen.joints_m = joints_m;
    seen.depth = &frames[f];
    seen.pixels = pixels;
    const auto fit = fitter.Fit(seen);
    if (fit) fitted.Add(fit->joints_m);
  }
  refined.Print("recon/refine");
  fitted.Print("recon/fit");
}

}  // namespace
}  // namespace ossa

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fputs("usage: room_bytes CLIP MODELS\n", stderr);
    return 2;
  }
  const ossa::Path clip = argv[1];
  const ossa::Path models = argv[2];
  const auto truth = ossa::recon::ReadSkeletons(clip / "truth.jsonl");
  const auto frames = ossa::ReadFrames(clip);
  ossa::Bytes depth;
  for (const auto& frame : frames) depth.Add(frame.depth_mm);
  depth.Print("depth/frames");
  ossa::PrintForest(frames, truth, models);
  ossa::PrintRefinement(frames, truth, models);
  ossa::PrintMethods(truth, models);
  return 0;
}
