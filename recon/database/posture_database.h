#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "recon/normalise.h"
#include "recon/posture.h"

namespace ossa::recon {

/// 60 numbers: x y z of each joint in enum order, metres. Single precision: a tenth of a micrometre
/// at body size, and half the memory to read in a search.
inline constexpr int kPostureDims = 3 * kJointCount;
/// A posture as 60 numbers, metres: x y z of each joint, in enum order.
using PostureVector = Eigen::Matrix<float, kPostureDims, 1>;

/// Joints in enum order, x y z each; and back.
PostureVector ToVector(const Posture& posture);
/// Inverse of ToVector.
Posture ToPosture(const PostureVector& vector);

/// Input of the database: a motion of a person of any size, in any y-up frame, facing anywhere.
struct PostureClip {
  std::string name;
  std::vector<Posture> postures;
  /// World from bone (recon/orientation.h), one per posture; empty: computed from the
  /// joints.
  std::vector<JointOrientations> orientations;
};

/// Distance between postures by which a database is filtered.
enum class DatabaseFilter : uint32_t {
  kSumSquared = 0,  // root of the summed squared joint distances (Shum & Ho 2012 sec. 5.1, Shum
                    // 2013 sec. V-A; they put the threshold on the sum itself)
  kMaxJoint = 1,    // largest joint distance (Plantard 2016 eq. 1)
};

/// Range of the filters' threshold, metres. By hand: single precision still tells postures 0.1 mm
/// apart, and nobody is 100 m tall.
inline constexpr double kSmallestThreshold_m = 1e-4, kLargestThreshold_m = 100.0;

/// How postures are filtered and connected.
struct DatabaseOptions {
  DatabaseFilter filter = DatabaseFilter::kMaxJoint;
  double threshold_m = 0.2;  // thres_1, in the range above: postures nearer than this to a kept one
                             // are dropped; Plantard 2016, section 8.3: some 2000 are enough
  int most_edges = 64;  // per node, nearest first. Departure: the paper's are unbounded (7.8 on
                        // average); a bound keeps the query's cost independent of the density
};

/// Normalised postures of the standard size, filtered, with their source clips and the edges of the
/// filtered pose graph. Reconstructors share one database; a reconstructor that adds postures makes
/// a copy.
class PostureDatabase {
 public:
  /// File version. Version 1, which is also read, has another convention of orientations
  /// (database_file.cpp).
  static constexpr uint32_t kVersion = 2;

  /// Normalises, retargets, filters within clips then between clips (Plantard 2016 algs. 1-4; with
  /// kSumSquared the same screening under Shum's distance) and connects. Departure: algorithm 2 as
  /// printed keeps a posture that is far from any other one; the text's "same process" means far
  /// from all kept ones. Throws InputError if there is no finite posture, and for a threshold out
  /// of range. `stop` is called regularly; once it returns true, the result is incomplete and must
  /// not be used.
  static PostureDatabase Build(const std::vector<PostureClip>& clips,
                               const DatabaseOptions& options,
                               const std::function<bool()>& stop = {});

  /// .ossadb: reads refuse damaged, truncated and hostile files by name and byte.
  static PostureDatabase Load(const std::filesystem::path& path);
  static PostureDatabase FromBytes(std::span<const std::byte> bytes, const std::string& name,
                                   uint32_t version = kVersion);
  void Save(const std::filesystem::path& path) const;
  /// Whether the file has the format's magic number; it may still be damaged.
  static bool IsFile(const std::filesystem::path& path);

  int size() const { return static_cast<int>(clip_of_.size()); }
  /// 60 x size(), column i is posture i; valid until the next Add().
  using Postures =
      Eigen::Map<const Eigen::Matrix<float, kPostureDims, Eigen::Dynamic>, Eigen::Aligned16>;
  Postures postures() const { return {postures_.data(), kPostureDims, size()}; }
  Posture posture(int i) const { return ToPosture(postures_.col(i)); }
  /// Normalised from bone, in the convention of recon/orientation.h.
  JointOrientations orientations(int i) const;
  const PostureVector& mean() const { return mean_; }
  const BoneLengths& bone_lengths_m() const { return bone_lengths_m_; }
  const std::string& clip_of(int i) const { return clip_names_[clip_of_[static_cast<size_t>(i)]]; }
  int clip_count() const { return static_cast<int>(clip_names_.size()); }
  /// Filtered edges of node i, nearest first; symmetric unless a node has more than `most_edges`.
  std::span<const int32_t> neighbours(int i) const;
  int64_t edge_count() const { return static_cast<int64_t>(edges_.size()); }
  const DatabaseOptions& options() const { return options_; }
  double edge_threshold_m() const { return edge_threshold_m_; }  // thres_2, Plantard 2016 eq. 2
  int64_t source_postures() const { return source_postures_; }   // before the filters

  /// Whether the filter with which the database was built would drop this normalised posture of the
  /// standard size, because a kept one is too near.
  bool Has(const PostureVector& posture) const;
  /// Adds a normalised posture of the standard size and its orientations, unconnected to the graph;
  /// the mean does not change. Amortised constant time. Invalidates postures().
  void Add(const PostureVector& posture, const JointOrientations& orientations,
           const std::string& clip);

  /// For ablations: filtered again with a larger thres_1, or with fewer edges per node.
  PostureDatabase Filtered(double threshold_m) const;
  PostureDatabase WithEdges(int most_edges) const;

 private:
  void Connect(const std::function<bool()>& stop = {});
  void Summarise();

  DatabaseOptions options_;
  BoneLengths bone_lengths_m_{};
  Eigen::Matrix<float, kPostureDims, Eigen::Dynamic> postures_;  // and room for more to come
  PostureVector mean_ = PostureVector::Zero();
  std::vector<float> quaternions_;  // 80 a posture: 20 x (w x y z)
  std::vector<std::string> clip_names_;
  std::vector<uint32_t> clip_of_;
  std::vector<int64_t> edge_begin_;  // size() + 1 offsets into edges_
  std::vector<int32_t> edges_;
  double edge_threshold_m_ = 0.0;
  int64_t source_postures_ = 0;
};

}  // namespace ossa::recon
