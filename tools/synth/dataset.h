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
  /// True where surface of the joint's own body part, or near it, is seen by the sensor.
  recon::JointArray<bool> visible{};
};

/// A depth image with the label of each pixel. From packed shards it is cropped to the people with
/// a border of background, and its camera is shifted accordingly: projections stay right.
struct LabelledFrame {
  depth::DepthFrame depth;      // index = number of the frame in the data set
  depth::Image<uint8_t> parts;  // 0 background, 1..31 body part, 32 other (recon/body/parts.h)
  depth::Image<uint8_t> users;  // 0 nobody, else TruthBody::id; an `other` pixel has its person's
  std::vector<TruthBody> bodies;
  std::optional<Eigen::Vector4d> floor;  // a b c d of ax + by + cz + d = 0, camera space
  std::optional<depth::Camera> whole;    // of the uncropped image, where it is not the data set's
};

/// What manifest.json says of a data set.
struct DatasetManifest {
  int64_t frames = 0;
  depth::Camera camera;  // of the uncropped images
  uint64_t seed = 0;
  std::string command;               // made by
  std::string split;                 // "train" or "test"
  std::string view;                  // "front", "any", "near" or "ceiling"
  std::vector<std::string> sources;  // motion
  std::string motion;                // digest of the poses in them; "" of sets that do not say
  std::string ossa;                  // version that made it; "" of sets that do not say
  std::vector<std::string> terms;    // where motion and bodies come from and their licences
  bool png = true;                   // depth/, parts/, users/ and truth.jsonl are there
  bool packed = false;               // shards/ are there
  int64_t frames_per_shard = 0;
};

/// True when the folder has the manifest of a finished data set.
bool IsDataset(const std::filesystem::path& folder);
/// True of one that `ossa render` has begun: DatasetReader says so, whoever else reads it does not.
bool IsUnfinishedDataset(const std::filesystem::path& folder);

/// Reads a DATASET (docs/architecture.md, "Data set"), from its shards when it has them, else from
/// its PNG files. Every damage throws an InputError that names the file. Read may be called from
/// many threads; frames of one shard asked one after another are fast.
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

/// The frame in an image of its own whole size, else of its data set's, with nothing where the crop
/// was cut off: where an image ends says much about what is not seen. (Of `--camera generic` the
/// optical centre is taken for the data set's: a few pixels off.)
LabelledFrame Uncropped(const LabelledFrame& frame, const depth::Camera& of_data_set);

}  // namespace ossa::tools
