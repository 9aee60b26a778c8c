#pragma once
#include "recon/body/body_files_internal.h"
#include "recon/body/body_model.h"

namespace ossa::recon {

/// Makes a BodyModel of the files, and keeps it in a checksummed container for the next start.
struct BodyModelBuilder {
  static BodyModel Build(const BodyFiles& files);
  static void WriteCache(const std::filesystem::path& path, const BodyModel& model);
  static BodyModel ReadCache(const std::filesystem::path& path);

 private:
  static void AddLayer(const BodyFiles& files, const std::string& group, BodyLayer layer,
                       std::vector<uint32_t>* kept, BodyModel* model);
  static void AddTargets(const BodyFiles& files, const std::vector<uint32_t>& kept,
                         BodyModel* model);
  static void AddInfluences(const BodyFiles& files, const std::vector<uint32_t>& kept,
                            BodyModel* model);
};

/// What part labelling reads of one triangle or vertex of the neutral mesh, decimetres.
struct PartLabelInput {
  Eigen::Vector3f centroid_dm = Eigen::Vector3f::Zero();
  std::array<float, kRigBoneCount> bone_weight;  // mean over the triangle's corners
};
struct PartLandmarks {
  std::array<Eigen::Vector3f, kRigBoneCount> bone_head_dm;
  std::array<Eigen::Vector3f, kRigBoneCount> bone_tail_dm;
};

/// The part (1..31) of a place on the neutral body's skin.
uint8_t LabelPart(const PartLabelInput& place, const PartLandmarks& landmarks);

}  // namespace ossa::recon
