// P. Plantard, H. P. H. Shum, F. Multon, Filtered pose graph for efficient Kinect pose
// reconstruction, 2016, section 4; Shum et al. 2013 section V-A.
#include "recon/database/posture_database.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "depth/base/error.h"
#include "recon/database/posture_grid_internal.h"
#include "recon/orientation.h"

namespace ossa::recon {
namespace {

bool IsFinite(const Posture& posture) {
  return std::all_of(posture.position_m.begin(), posture.position_m.end(),
                     [](const Eigen::Vector3d& p) { return p.allFinite() && p.norm() < 1e4; });
}

void CheckThreshold(double threshold_m) {
  if (threshold_m >= kSmallestThreshold_m && threshold_m <= kLargestThreshold_m) return;
  throw InputError(fmt::format("posture database: threshold is {} m, must be in [{}, {}] m",
                               threshold_m, kSmallestThreshold_m, kLargestThreshold_m));
}

using Quaternions = std::array<float, 4 * kJointCount>;  // w x y z of each joint

struct ClipPosture {
  PostureVector vector;
  Quaternions quaternions;
};

Quaternions ToQuaternions(const JointOrientations& orientations, double yaw_rad) {
  const Eigen::Quaterniond unturn(Eigen::AngleAxisd(-yaw_rad, Eigen::Vector3d::UnitY()));
  Quaternions out;
  for (size_t i = 0; i < kJointCount; ++i) {
    const Eigen::Quaterniond q = (unturn * orientations[i]).normalized();
    out[4 * i] = static_cast<float>(q.w());
    out[4 * i + 1] = static_cast<float>(q.x());
    out[4 * i + 2] = static_cast<float>(q.y());
    out[4 * i + 3] = static_cast<float>(q.z());
  }
  return out;
}

/// Algorithm 1: the postures kept of one clip, and the distances between successive kept ones.
/// Departure: each posture is compared with the one kept last, not with all of P_intra. Connections
/// are then steps that people make without a discontinuity, and their spread is small, as in the
/// paper (0.21 +- 0.02 m for thres_1 = 0.2 m). Compared with all kept postures, a movement back
/// through known postures would make one connection a metre long. Algorithm 2 removes duplicates.
std::vector<ClipPosture> FilterIntraPoses(const PostureClip& clip, const DatabaseOptions& options,
                                          std::vector<double>& connections) {
  JointWeights all;
  all.fill(1.0);
  const auto threshold = static_cast<float>(options.threshold_m);
  std::vector<ClipPosture> kept;
  double yaw_rad = 0.0;
  for (size_t frame = 0; frame < clip.postures.size(); ++frame) {
    if (!IsFinite(clip.postures[frame])) continue;
    const Placement placement = EstimatePlacement(clip.postures[frame], all, yaw_rad);
    yaw_rad = placement.yaw_rad;
    const PostureVector vector =
        ToVector(Retargeted(Normalised(clip.postures[frame], placement), StandardBoneLengths()));
    const auto distance_from_last = [&](DatabaseFilter filter) {
      constexpr float kFar_m = 100.0F;  // a bound: farther than any posture
      return FilterDistance(kept.back().vector.data(), vector.data(), filter, kFar_m);
    };
    if (!kept.empty()) {
      if (distance_from_last(options.filter) <= threshold) continue;
      connections.push_back(distance_from_last(DatabaseFilter::kMaxJoint));
    }
    const bool has_turns = frame < clip.orientations.size();
    kept.push_back({vector, ToQuaternions(has_turns ? clip.orientations[frame]
                                                    : ComputeOrientations(clip.postures[frame]),
                                          yaw_rad)});
  }
  return kept;
}

}  // namespace

PostureVector ToVector(const Posture& posture) {
  PostureVector vector;
  for (size_t i = 0; i < kJointCount; ++i) {
    vector.segment<3>(FirstCoordinate(i)) = posture.position_m[i].cast<float>();
  }
  return vector;
}

Posture ToPosture(const PostureVector& vector) {
  Posture posture;
  for (size_t i = 0; i < kJointCount; ++i) {
    posture.position_m[i] = vector.segment<3>(FirstCoordinate(i)).cast<double>();
  }
  return posture;
}

PostureDatabase PostureDatabase::Build(const std::vector<PostureClip>& clips,
                                       const DatabaseOptions& options,
                                       const std::function<bool()>& stop) {
  CheckThreshold(options.threshold_m);
  PostureDatabase db;
  db.options_ = options;
  db.bone_lengths_m_ = StandardBoneLengths();
  PostureGrid grid(static_cast<float>(options.threshold_m), options.filter);
  std::vector<double> connections;
  for (const PostureClip& clip : clips) {
    if (stop && stop()) return db;
    const auto clip_index = static_cast<uint32_t>(db.clip_names_.size());
    db.clip_names_.push_back(clip.name);
    db.source_postures_ += static_cast<int64_t>(clip.postures.size());
    for (const ClipPosture& p : FilterIntraPoses(clip, options, connections)) {  // algorithm 1
      if (grid.AnyWithin(p.vector)) continue;                                    // algorithm 2
      grid.Insert(p.vector);
      db.clip_of_.push_back(clip_index);
      db.quaternions_.insert(db.quaternions_.end(), p.quaternions.begin(), p.quaternions.end());
    }
  }
  if (grid.size() == 0) throw InputError("posture database: the clips hold no finite posture");
  db.postures_.resize(kPostureDims, grid.size());
  for (int i = 0; i < grid.size(); ++i) db.postures_.col(i) = grid.posture(i);

  double mean = options.threshold_m, variance = 0.0;  // eq. 2
  if (!connections.empty()) {
    const auto n = static_cast<double>(connections.size());
    mean = 0.0;
    for (const double c : connections) mean += c / n;
    for (const double c : connections) variance += (c - mean) * (c - mean) / n;
  }
  db.edge_threshold_m_ = mean + 2.0 * std::sqrt(variance);
  db.Connect(stop);
  db.Summarise();
  return db;
}

// Algorithm 3, nearest first. Where `most_edges` truncates, an edge may remain in one direction
// only: in a denser region a node has nearer neighbours to keep.
void PostureDatabase::Connect(const std::function<bool()>& stop) {
  PostureGrid grid(static_cast<float>(edge_threshold_m_), DatabaseFilter::kMaxJoint);
  for (int i = 0; i < size(); ++i) grid.Insert(postures_.col(i));
  edge_begin_.assign(1, 0);
  edges_.clear();
  for (int i = 0; i < size(); ++i) {
    if (stop && i % 64 == 0 && stop()) return;
    auto near = grid.Within(postures_.col(i));
    std::erase_if(near, [i](const auto& entry) { return entry.second == i; });
    const size_t keep = std::min(near.size(), static_cast<size_t>(options_.most_edges));
    std::partial_sort(near.begin(), near.begin() + static_cast<ptrdiff_t>(keep), near.end());
    for (size_t k = 0; k < keep; ++k) edges_.push_back(near[k].second);
    edge_begin_.push_back(static_cast<int64_t>(edges_.size()));
  }
}

void PostureDatabase::Summarise() { mean_ = postures_.rowwise().mean(); }

JointOrientations PostureDatabase::orientations(int i) const {
  JointOrientations out;
  const float* q = quaternions_.data() + static_cast<size_t>(i) * 4 * kJointCount;
  for (size_t j = 0; j < kJointCount; ++j, q += 4) out[j] = {q[0], q[1], q[2], q[3]};
  return out;
}

std::span<const int32_t> PostureDatabase::neighbours(int i) const {
  const auto n = static_cast<size_t>(i);
  const auto begin = static_cast<size_t>(edge_begin_[n]);
  return std::span(edges_).subspan(begin, static_cast<size_t>(edge_begin_[n + 1]) - begin);
}

bool PostureDatabase::Has(const PostureVector& posture) const {
  const auto threshold = static_cast<float>(options_.threshold_m);
  const Postures kept = postures();
  for (int i = 0; i < size(); ++i) {
    const float* other = kept.data() + static_cast<size_t>(i) * kPostureDims;
    if (FilterDistance(other, posture.data(), options_.filter, threshold) <= threshold) return true;
  }
  return false;
}

void PostureDatabase::Add(const PostureVector& posture, const JointOrientations& orientations,
                          const std::string& clip) {
  const Eigen::Index n = size();
  if (n == postures_.cols()) postures_.conservativeResize(Eigen::NoChange, 2 * n);
  postures_.col(n) = posture;
  const Quaternions quaternions = ToQuaternions(orientations, 0.0);
  quaternions_.insert(quaternions_.end(), quaternions.begin(), quaternions.end());
  if (clip_names_.empty() || clip_names_.back() != clip) clip_names_.push_back(clip);
  clip_of_.push_back(static_cast<uint32_t>(clip_names_.size() - 1));
  edge_begin_.push_back(edge_begin_.back());
}

PostureDatabase PostureDatabase::Filtered(double threshold_m) const {
  std::vector<PostureClip> clips;
  for (int i = 0; i < size(); ++i) {
    if (clips.empty() || clips.back().name != clip_of(i)) clips.push_back({clip_of(i), {}, {}});
    clips.back().postures.push_back(posture(i));
    clips.back().orientations.push_back(orientations(i));
  }
  DatabaseOptions options = options_;
  options.threshold_m = threshold_m;
  return Build(clips, options);
}

PostureDatabase PostureDatabase::WithEdges(int most_edges) const {
  PostureDatabase db = *this;
  db.options_.most_edges = most_edges;
  db.Connect();
  return db;
}

}  // namespace ossa::recon
