#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "forest/training/train.h"
#include "tools/synth/dataset.h"

namespace ossa::tools {

/// Facing sectors: the yaw of a person against the line of sight, in steps of 45°; sector 0 faces
/// the camera, 4 shows its back. They are the contexts of a body model.
inline constexpr int kFacingSectors = 8;  // by hand

/// Yaw against the line of sight to the person, radians; 0 faces the camera, positive when the
/// person's left side comes nearer.
double YawRelativeToRay(const recon::Posture& joints_m);
uint8_t FacingSector(const recon::Posture& joints_m);
/// From the ceiling, where there is no line of sight to face: the heading in the image, clockwise
/// in steps of 45°; sector 0 faces its upper border.
uint8_t HeadingSector(const recon::Posture& joints_m);

/// Classes, contexts and targets of a forest for people: 31 parts and `other`, facing sectors, SDK
/// joints.
forest::TrainingVocabulary BodyVocabulary();

/// One person of a labelled frame, cut out. An image of no pixels when the body has none.
forest::TrainingImage PersonImage(const LabelledFrame& frame, const TruthBody& body);

/// How much of a frame a training image holds: trees ask for no more than the people, and many of
/// them fit into memory; the refinement also looks at where the image ends.
enum class Extent { kPeople, kWholeImage };

/// Frames of data sets as training images: one person of each frame, in turn where there are
/// several. `keep` chooses among each hundred frames: those whose number modulo 100 lies in
/// [begin, end).
class PersonSource final : public forest::TrainingSource {
 public:
  struct Range {
    int begin = 0;
    int end = 100;
  };

  PersonSource(const std::vector<std::filesystem::path>& datasets, Range keep,
               Extent extent = Extent::kPeople);

  size_t size() const override { return places_.size(); }
  forest::TrainingImage Read(size_t index) const override;
  const std::vector<DatasetManifest>& manifests() const { return manifests_; }
  /// Names the data: folders' manifests, counts and choice.
  std::string fingerprint() const { return fingerprint_; }

 private:
  struct Place {
    uint32_t dataset = 0;
    int64_t frame = 0;
  };
  std::vector<DatasetReader> readers_;
  std::vector<DatasetManifest> manifests_;
  std::vector<Place> places_;
  Extent extent_;
  std::string fingerprint_;
};

/// The image of the person's mirror image: left and right change places.
forest::TrainingImage Mirrored(const forest::TrainingImage& image);

/// Each image of another source, and after them each mirrored.
class MirroredSource final : public forest::TrainingSource {
 public:
  explicit MirroredSource(const forest::TrainingSource& source) : source_(source) {}

  size_t size() const override { return 2 * source_.size(); }
  forest::TrainingImage Read(size_t index) const override {
    const size_t half = source_.size();
    return index < half ? source_.Read(index) : Mirrored(source_.Read(index - half));
  }

 private:
  const forest::TrainingSource& source_;
};

}  // namespace ossa::tools
