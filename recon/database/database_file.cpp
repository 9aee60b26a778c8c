// The .ossadb file: writing, and reading in which every field is checked.
#include <algorithm>
#include <cmath>

#include "depth/base/checksummed_container.h"
#include "depth/base/error.h"
#include "depth/base/naming_the_file.h"
#include "recon/body/standard_body.h"
#include "recon/database/posture_database.h"
#include "recon/smallest_turn.h"

namespace ossa::recon {
namespace {

constexpr ContainerFormat kDatabaseFormat = {
    {'O', 'S', 'S', 'A', 'D', 'B', '0', '0'}, PostureDatabase::kVersion, "posture database"};
constexpr uint32_t kStanceVersion = 1;  // of the file format

void ExpectFinite(const PayloadReader& reader, std::span<const float> values, float limit,
                  std::string_view field) {
  for (const float v : values) {
    if (!(std::abs(v) <= limit)) reader.Fail(field, "expected finite numbers of human size");
  }
}

/// Version 1 stores bone orientations relative to a person who stands with hanging arms, where each
/// bone's frame is the world's, turned by the smallest rotation onto the bone. The frames of
/// recon/orientation.h differ from these by one constant rotation per bone.
JointArray<Eigen::Quaterniond> TurnsFromStance() {
  const Posture stance = StandardPosture(RigPose{});
  JointArray<Eigen::Quaterniond> turns;
  for (size_t i = 0; i < kJointCount; ++i) {
    Eigen::Quaterniond frame = Eigen::Quaterniond::Identity();
    if (i > 0) {
      const Eigen::Vector3d bone = stance.position_m[i] - stance.position_m[ParentOf(i)];
      frame = SmallestTurn(Eigen::Vector3d(Eigen::Vector3d::UnitY()), bone);
    }
    turns[i] = frame.conjugate() * StandardOrientations()[i];
  }
  return turns;
}

/// `quaternions`: w x y z of each joint of each posture.
void TurnFromStance(std::span<float> quaternions) {
  const auto turns = TurnsFromStance();
  for (size_t k = 0; k + 3 < quaternions.size(); k += 4) {
    float* q = &quaternions[k];
    const Eigen::Quaterniond old(q[0], q[1], q[2], q[3]);
    const Eigen::Quaternionf now = (old * turns[k / 4 % kJointCount]).normalized().cast<float>();
    q[0] = now.w(), q[1] = now.x(), q[2] = now.y(), q[3] = now.z();
  }
}

void ExpectSdkSkeleton(PayloadReader& in) {
  if (in.Get<uint32_t>("joint count") != kJointCount) in.Fail("joint count", "expected 20");
  for (size_t i = 0; i < kJointCount; ++i) {
    if (in.Get<int32_t>("parent") != kJointParent[i]) in.Fail("parent", "not the SDK's skeleton");
  }
}

BoneLengths ReadBoneLengths(PayloadReader& in) {
  const auto lengths_m = in.Get<BoneLengths>("bone lengths");
  for (const double length_m : lengths_m) {
    if (!(length_m >= 0.0 && length_m < 5.0)) in.Fail("bone lengths", "expected 0 to 5 metres");
  }
  return lengths_m;
}

/// How the database was filtered and connected.
struct FilterSettings {
  DatabaseOptions options;
  double edge_threshold_m = 0.0;
};

FilterSettings ReadFilterSettings(PayloadReader& in) {
  FilterSettings settings;
  const auto filter = in.Get<uint32_t>("filter");
  if (filter > 1) in.Fail("filter", "expected 0 (sum-squared) or 1 (max-joint)");
  settings.options.filter = static_cast<DatabaseFilter>(filter);
  settings.options.threshold_m = in.Get<double>("threshold");
  settings.options.most_edges = in.Get<int32_t>("most edges");
  settings.edge_threshold_m = in.Get<double>("edge threshold");
  const double threshold_m = settings.options.threshold_m;
  // Bounds, by hand: an edge is shorter than the filter's distance if that sums over the joints.
  constexpr double kShortestEdge_m = 1e-5, kLongestEdge_m = 1e3;
  if (!(threshold_m >= kSmallestThreshold_m && threshold_m <= kLargestThreshold_m) ||
      !(settings.edge_threshold_m >= kShortestEdge_m &&
        settings.edge_threshold_m < kLongestEdge_m) ||
      settings.options.most_edges < 0) {
    in.Fail("settings", "expected thresholds of 0.0001 to 100 m");
  }
  return settings;
}

/// The clips of a database, and the clip of each of its postures.
struct ClipTable {
  std::vector<std::string> names;
  std::vector<uint32_t> of_posture;
};

/// `payload_size`: bytes of the whole payload, a bound of every count in it.
ClipTable ReadClipTable(PayloadReader& in, size_t payload_size) {
  ClipTable clips;
  const auto count = in.Get<uint64_t>("clip count");
  if (count > payload_size) in.Fail("clip count", "more clips than bytes");
  for (uint64_t c = 0; c < count; ++c) clips.names.push_back(in.GetString("clip name"));
  clips.of_posture = in.GetVector<uint32_t>("clip of each posture");
  if (clips.of_posture.empty()) in.Fail("clip of each posture", "expected at least one posture");
  for (const uint32_t clip : clips.of_posture) {
    if (clip >= count) in.Fail("clip of each posture", "names a clip that is not listed");
  }
  return clips;
}

/// Edges of the pose graph: those of node i are edges[begin[i]] up to edges[begin[i + 1]].
struct EdgeTable {
  std::vector<int64_t> begin;
  std::vector<int32_t> edges;
};

EdgeTable ReadEdgeTable(PayloadReader& in, size_t nodes) {
  EdgeTable table;
  table.begin = in.GetVector<int64_t>("edge offsets");
  table.edges = in.GetVector<int32_t>("edges");
  if (table.begin.size() != nodes + 1 || table.begin.front() != 0 ||
      table.begin.back() != static_cast<int64_t>(table.edges.size()) ||
      !std::is_sorted(table.begin.begin(), table.begin.end())) {
    in.Fail("edge offsets", "expected one rising offset a posture");
  }
  for (const int32_t e : table.edges) {
    if (e < 0 || static_cast<size_t>(e) >= nodes) {
      in.Fail("edges", "names a posture that is not there");
    }
  }
  return table;
}

}  // namespace

void PostureDatabase::Save(const std::filesystem::path& path) const {
  PayloadWriter out;
  out.Put<uint32_t>(kJointCount);
  for (size_t i = 0; i < kJointCount; ++i) out.Put<int32_t>(kJointParent[i]);
  out.Put(bone_lengths_m_);
  out.Put<uint32_t>(static_cast<uint32_t>(options_.filter));
  out.Put(options_.threshold_m);
  out.Put<int32_t>(options_.most_edges);
  out.Put(edge_threshold_m_);
  out.Put(source_postures_);
  out.Put<uint64_t>(clip_names_.size());
  for (const std::string& name : clip_names_) out.PutString(name);
  out.PutVector(clip_of_);
  out.PutArray(std::span<const float>(postures_.data(), static_cast<size_t>(postures().size())));
  out.PutVector(quaternions_);
  out.PutVector(edge_begin_);
  out.PutVector(edges_);
  WriteContainer(path, kDatabaseFormat, out.bytes());
}

bool PostureDatabase::IsFile(const std::filesystem::path& path) {
  return IsContainer(path, kDatabaseFormat);
}

PostureDatabase PostureDatabase::Load(const std::filesystem::path& path) {
  const ContainerFormat format = ReadContainerFormat(path, kDatabaseFormat, kStanceVersion);
  return NamingTheFile(
      path, [&] { return FromBytes(ReadContainer(path, format), path.string(), format.version); });
}

PostureDatabase PostureDatabase::FromBytes(std::span<const std::byte> bytes,
                                           const std::string& name, uint32_t version) {
  PayloadReader in(bytes, name);
  PostureDatabase db;
  ExpectSdkSkeleton(in);
  db.bone_lengths_m_ = ReadBoneLengths(in);
  const FilterSettings settings = ReadFilterSettings(in);
  db.options_ = settings.options;
  db.edge_threshold_m_ = settings.edge_threshold_m;
  db.source_postures_ = in.Get<int64_t>("source postures");
  ClipTable clips = ReadClipTable(in, bytes.size());
  db.clip_names_ = std::move(clips.names);
  db.clip_of_ = std::move(clips.of_posture);
  const size_t n = db.clip_of_.size();
  const auto postures = in.GetVector<float>("postures");
  if (postures.size() != n * kPostureDims) in.Fail("postures", "expected 60 numbers a posture");
  ExpectFinite(in, postures, 10.0F, "postures");
  db.postures_ = Eigen::Map<const Eigen::Matrix<float, kPostureDims, Eigen::Dynamic>>(
      postures.data(), kPostureDims, static_cast<Eigen::Index>(n));
  db.quaternions_ = in.GetVector<float>("rotations");
  if (db.quaternions_.size() != n * 4 * kJointCount) {
    in.Fail("rotations", "expected 80 numbers a posture");
  }
  ExpectFinite(in, db.quaternions_, 1.01F, "rotations");
  if (version == kStanceVersion) TurnFromStance(db.quaternions_);
  EdgeTable edges = ReadEdgeTable(in, n);
  db.edge_begin_ = std::move(edges.begin);
  db.edges_ = std::move(edges.edges);
  in.ExpectEnd();
  db.Summarise();
  return db;
}

}  // namespace ossa::recon
