#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "depth/image/camera.h"
#include "depth/image/depth_frame.h"
#include "depth/image/image.h"
#include "recon/posture.h"

namespace ossa::tools {

/// The true skeleton of one person of a labelled frame.
struct TruthBody {
  int id = 1;               // the person's value in LabelledFrame::users
  recon::Posture joints_m;  // camera space, inside the body, all 20 known
  /// True where the sensor sees surface of the joint's own body part near the joint.
  recon::JointArray<bool> visible{};
};

/// A depth image with a label for each pixel. Frames read from packed shards are cropped to the
/// people and a border of background; their camera is shifted accordingly, so that projections stay
/// correct.
struct LabelledFrame {
  depth::DepthFrame depth;      // index = number of the frame in the data set
  depth::Image<uint8_t> parts;  // 0 background, 1..31 body part, 32 other (recon/body/parts.h)
  depth::Image<uint8_t> users;  // 0 nobody, else TruthBody::id; an object has its person's id
  std::vector<TruthBody> bodies;
  std::optional<Eigen::Vector4d> floor;  // a b c d of ax + by + cz + d = 0, camera space
  std::optional<depth::Camera> whole;  // of the uncropped image, if it differs from the data set's
};

/// The content of a data set's manifest.json.
struct DatasetManifest {
  int64_t frames = 0;
  depth::Camera camera;  // of the uncropped images
  uint64_t seed = 0;
  std::string command;               // that made the data set
  std::string split;                 // "train" or "test"
  std::string view;                  // "front", "any", "near" or "ceiling"
  std::vector<std::string> sources;  // motion
  std::string motion;                // digest of the poses in the sources; "" if not recorded
  std::string ossa;                  // version that made it; "" if not recorded
  std::vector<std::string> terms;    // origin and licences of motion and bodies
  bool png = true;                   // has depth/, parts/, users/ and truth.jsonl
  bool packed = false;               // has shards/
  int64_t frames_per_shard = 0;
};

/// True if the folder has the manifest of a finished data set.
bool IsDataset(const std::filesystem::path& folder);
/// True if `ossa render` has begun a data set in the folder and not finished it.
bool IsUnfinishedDataset(const std::filesystem::path& folder);

/// Reads a data set (docs/architecture.md, "Data set") from its shards if it has them, else from
/// its PNG files. Damaged files throw an InputError that names the file. Read() is thread-safe;
/// consecutive frames of one shard are fast.
class DatasetReader {
 public:
  explicit DatasetReader(const std::filesystem::path& folder);
  ~DatasetReader();
  DatasetReader(DatasetReader&&) noexcept;
  DatasetReader& operator=(DatasetReader&&) noexcept;

  const DatasetManifest& manifest() const;
  int64_t frame_count() const { return manifest().frames; }

  /// Frame 0 <= index < frame_count().
  LabelledFrame Read(int64_t index) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The frame at the size of its uncropped image (`frame.whole`, else `of_data_set`), without depth
/// outside of the crop. Needed where the image's border matters, e.g. to know which joints are
/// outside of it. With `--camera generic` the data set's optical centre is used: a few pixels off.
LabelledFrame Uncropped(const LabelledFrame& frame, const depth::Camera& of_data_set);

}  // namespace ossa::tools
