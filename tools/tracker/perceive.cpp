#include "tools/tracker/perceive_internal.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "forest/proposals/relabel.h"
#include "tools/tracker/thin_internal.h"

namespace ossa::tracker {
namespace {

using Clock = std::chrono::steady_clock;

double MillisecondsSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

int ScaleFor(const depth::DepthFrame& frame, const depth::Candidate& candidate,
             const PerceiveOptions& options) {
  const double z_m = std::max(0.3, static_cast<double>(candidate.region.mean_m.z()));
  int scale = std::clamp(static_cast<int>(options.sample_m * frame.camera.fx / z_m), 1, 8);
  while (candidate.pixels.size() / static_cast<size_t>(scale * scale) > options.max_pixels &&
         scale < 16) {
    ++scale;
  }
  return scale;
}

// Half of a face (a disc of 15 cm) must be there to be somebody's head; and nobody stands on
// another one's shoulders: heads of two people are side by side, and not of very different size.
std::vector<Eigen::Vector3d> HeadsOfPeople(const std::vector<Head>& heads) {
  constexpr double kMinHead_m2 = 0.009, kMinShare = 0.4, kApart_m = 0.3;
  std::vector<Eigen::Vector3d> kept;
  for (const Head& head : heads) {
    if (head.area_m2 < std::max(kMinHead_m2, kMinShare * heads.front().area_m2)) continue;
    const bool apart = std::all_of(kept.begin(), kept.end(), [&](const Eigen::Vector3d& other) {
      return std::hypot(head.mean_m.x() - other.x(), head.mean_m.z() - other.z()) > kApart_m;
    });
    if (apart) kept.push_back(head.mean_m);
  }
  return kept;
}

}  // namespace

Perception Perceive(const forest::ForestModel& model, const recon::JointArray<int>& targets,
                    const depth::DepthFrame& frame, const depth::Candidate& candidate,
                    const PerceiveOptions& options) {
  Perception perception;
  const auto start = Clock::now();
  perception.scale = ScaleFor(frame, candidate, options);
  const bool thin = perception.scale > 1;
  const Thinned thinned = thin ? Thin(frame, candidate.pixels, perception.scale) : Thinned{};
  const depth::DepthFrame& seen = thin ? thinned.frame : frame;
  forest::ClassifyOptions classify;
  classify.threads = options.threads;
  classify.context_prior = options.context_prior;
  perception.classification = forest::Classify(model, seen.view(), seen.camera,
                                               thin ? thinned.pixels : candidate.pixels, classify);
  const std::vector<Head> heads = FindHeadClusters(seen, perception.classification);
  perception.heads_m = HeadsOfPeople(heads);
  perception.leg_area_m2 = LegArea(seen, perception.classification);
  LookAtSurface(seen, candidate, perception.classification, heads, perception.sign);
  perception.person_score = SurfaceScore(perception.sign);
  perception.classify_ms = MillisecondsSince(start);
  perception.proposals.resize(model.targets().size());
  if (perception.person_score < options.least_score) return perception;
  const auto propose_start = Clock::now();
  perception.proposals =
      forest::Propose(model, seen.view(), seen.camera, perception.classification);
  LookAtProposals(perception.proposals, targets, perception.sign);
  perception.person_score = PersonScore(perception.sign);
  perception.propose_ms = MillisecondsSince(propose_start);
  return perception;
}

void PaintParts(const forest::ForestModel& model, const depth::DepthFrame& frame,
                const depth::Candidate& candidate, const Perception& perception,
                depth::Image<uint8_t>& parts) {
  forest::ClassifyOptions options;
  options.context_prior = perception.classification.context;
  const forest::Classification seen =
      forest::Classify(model, frame.view(), frame.camera, candidate.pixels, options);
  const std::vector<uint8_t> labels =
      forest::Relabel(model, frame.view(), frame.camera, seen, perception.proposals);
  for (size_t i = 0; i < labels.size(); ++i) {
    parts.data[static_cast<size_t>(seen.pixel[i])] = labels[i];
  }
}

}  // namespace ossa::tracker
