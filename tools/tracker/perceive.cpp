#include "tools/tracker/perceive_internal.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "recon/body/parts.h"

namespace ossa::tracker {
namespace {

using Clock = std::chrono::steady_clock;
using recon::Joint;

double MillisecondsSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

struct Thinned {
  depth::DepthFrame frame;
  std::vector<int32_t> pixels;
};

// Every scale-th pixel both ways, cut to the candidate's box: features are measured in
// pixel·metres, so a smaller image with a smaller focal length shows the same body.
Thinned Thin(const depth::DepthFrame& frame, const std::vector<int32_t>& pixels, int scale) {
  const depth::Camera& full = frame.camera;
  Thinned thinned;
  depth::Camera& camera = thinned.frame.camera;
  camera.width = (full.width + scale - 1) / scale;
  camera.height = (full.height + scale - 1) / scale;
  camera.fx = full.fx / scale;
  camera.fy = full.fy / scale;
  camera.cx = full.cx / scale;
  camera.cy = full.cy / scale;
  thinned.frame.depth_mm.assign(
      static_cast<size_t>(camera.width) * static_cast<size_t>(camera.height), 0);
  for (const int32_t pixel : pixels) {
    const int u = pixel % full.width, v = pixel / full.width;
    if (u % scale != 0 || v % scale != 0) continue;
    const int32_t small = v / scale * camera.width + u / scale;
    thinned.frame.depth_mm[static_cast<size_t>(small)] = frame.depth_mm[static_cast<size_t>(pixel)];
    thinned.pixels.push_back(small);
  }
  return thinned;
}

int ScaleFor(size_t pixels, size_t max_pixels) {
  int scale = 1;
  while (pixels / static_cast<size_t>(scale * scale) > max_pixels && scale < 8) ++scale;
  return scale;
}

struct HeadCluster {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double area_m2 = 0;
  int count = 0;
  Eigen::Vector3d mean() const { return sum / count; }
};

// Where pixels of the four head parts and the neck gather. Half of a head's face (a disc of 15 cm)
// must be there to count.
std::vector<Eigen::Vector3d> HeadClusters(const depth::DepthFrame& frame,
                                          const forest::Classification& classification) {
  constexpr double kHeadSize_m = 0.17, kMinArea_m2 = 0.009;
  std::vector<HeadCluster> clusters;
  for (size_t i = 0; i < classification.pixel.size(); ++i) {
    if (classification.label[i] < 1 || classification.label[i] > 4) continue;
    const int32_t pixel = classification.pixel[i];
    const uint16_t mm = frame.depth_mm[static_cast<size_t>(pixel)];
    const Eigen::Vector3d p = depth::BackProject(frame.camera, pixel % frame.camera.width,
                                                 pixel / frame.camera.width, mm);
    auto near = std::find_if(clusters.begin(), clusters.end(), [&](const HeadCluster& cluster) {
      return (cluster.mean() - p).norm() < kHeadSize_m;
    });
    if (near == clusters.end()) near = clusters.insert(clusters.end(), HeadCluster{});
    near->sum += p;
    near->area_m2 += p.z() * p.z() / (frame.camera.fx * frame.camera.fy);
    ++near->count;
  }
  std::erase_if(clusters,
                [&](const HeadCluster& cluster) { return cluster.area_m2 < kMinArea_m2; });
  std::stable_sort(
      clusters.begin(), clusters.end(),
      [](const HeadCluster& a, const HeadCluster& b) { return a.area_m2 > b.area_m2; });
  std::vector<Eigen::Vector3d> heads_m;
  for (const HeadCluster& cluster : clusters) heads_m.push_back(cluster.mean());
  return heads_m;
}

// Share of the probability that goes to the body rather than to `other`.
double BodyShare(const forest::Classification& classification) {
  if (classification.class_count <= recon::kOtherPart || classification.pixel.empty()) return 1.0;
  double other = 0;
  const auto classes = static_cast<size_t>(classification.class_count);
  for (size_t i = 0; i < classification.pixel.size(); ++i) {
    other += static_cast<double>(classification.probability[i * classes + recon::kOtherPart]);
  }
  return 1.0 - other / static_cast<double>(classification.pixel.size());
}

// A person shows a head on shoulders: the trust in the joints that every view shows, times the
// share of the surface that is body.
double PersonScore(const Perception& perception,
                   const std::array<int, recon::kJointCount>& targets) {
  constexpr std::array kCore = {Joint::kHead, Joint::kShoulderCenter, Joint::kShoulderLeft,
                                Joint::kShoulderRight, Joint::kSpine};
  double trust = 0;
  for (const Joint joint : kCore) {
    const auto target = static_cast<size_t>(targets[static_cast<size_t>(joint)]);
    const auto& modes = perception.proposals[target];
    if (!modes.empty()) trust += modes.front().confidence / kCore.size();
  }
  return trust * BodyShare(perception.classification);
}

}  // namespace

Perception Perceive(const forest::ForestModel& model,
                    const std::array<int, recon::kJointCount>& targets,
                    const depth::DepthFrame& frame, const depth::Candidate& candidate,
                    const PerceiveOptions& options) {
  Perception perception;
  const auto start = Clock::now();
  perception.scale = ScaleFor(candidate.pixels.size(), options.max_pixels);
  const bool thin = perception.scale > 1;
  const Thinned thinned = thin ? Thin(frame, candidate.pixels, perception.scale) : Thinned{};
  const depth::DepthFrame& seen = thin ? thinned.frame : frame;
  forest::ClassifyOptions classify;
  classify.threads = options.threads;
  classify.context_prior = options.context_prior;
  perception.classification = forest::Classify(model, seen.view(), seen.camera,
                                               thin ? thinned.pixels : candidate.pixels, classify);
  perception.heads_m = HeadClusters(seen, perception.classification);
  perception.classify_ms = MillisecondsSince(start);
  const auto propose_start = Clock::now();
  perception.proposals =
      forest::Propose(model, seen.view(), seen.camera, perception.classification);
  perception.person_score = PersonScore(perception, targets);
  perception.propose_ms = MillisecondsSince(propose_start);
  return perception;
}

}  // namespace ossa::tracker
