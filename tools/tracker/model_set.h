#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "recon/methods/method_table.h"

namespace ossa::forest {
class ForestModel;  // forest/forest.h
}
namespace ossa::recon {
class JointRefiner;     // recon/refine/refinement_cascade.h
class PoseNetwork;      // recon/refine/pose_network.h
class PostureDatabase;  // recon/database/posture_database.h
struct BodySurface;     // recon/fit/body_surface.h
struct LearnedModels;   // recon/models/learned_models.h
struct PosturePrior;    // recon/models/posture_prior.h
}  // namespace ossa::recon

namespace ossa::tracker {

/// The value of ModelFiles::pose_network for the shipped network.
inline constexpr std::string_view kShippedNetwork = "shipped";

/// The files of a ModelSet: each a path; or "", the shipped file where it fits the other files and
/// the method; or "none". README.md says which command makes which file.
struct ModelFiles {
  std::string forest;      // .ossa; "": the shipped one
  std::string refinement;  // .ossarefine; "": the shipped ones for the shipped forests, for methods
                           // that start from refined joints. A named one replaces the one for its
                           // mount: level, or above people
  std::string pose_network;  // .ossanet, or kShippedNetwork; "": the latter where the shipped
                             // cascade refines joints. Not used under the ceiling
  std::string surface;       // .ossasurface; "": the shipped one
  std::string learned;  // .ossagp; "": the known errors of the shipped forest and a refinement, for
                        // methods that use a correction
  std::string prior;    // .ossaprior; "": the shipped one, for methods that complete postures by a
                        // prior, if no database is named
  std::string database;  // .ossadb; "": the shipped one, for methods that need one
};

/// All models of a tracker, in memory. A set serves any number of trackers, also concurrently;
/// members may be replaced.
struct ModelSet {
  std::shared_ptr<const forest::ForestModel> forest;       // body parts and joint proposals; needed
  std::shared_ptr<const recon::JointRefiner> refinement;   // refines its joints at the depth image
  std::shared_ptr<const recon::PoseNetwork> pose_network;  // estimates joints from the whole person
  std::shared_ptr<const recon::BodySurface> surface;       // body surface for the fit
  std::shared_ptr<const recon::LearnedModels> learned;     // the correction of systematic errors
  std::shared_ptr<const recon::PosturePrior> prior;  // of postures: unseen joints from seen ones
  std::shared_ptr<const recon::PostureDatabase> database;  // postures to look up
  // File names of those, for messages.
  std::string forest_file, refinement_file, learned_file;
  /// The forest for a camera under the ceiling, loaded when such a view is found; "": none.
  std::string ceiling_file;
  std::string ceiling_refinement_file;  // for its joints, loaded with it; "": none
  bool from_ceiling = false;            // `forest` is one for such cameras
  /// Warnings about named files that do not belong together, one line each.
  std::vector<std::string> warnings;

  /// The shipped models for a reconstruction method (recon::MethodTable). Throws InputError for a
  /// missing or damaged file and an unknown method.
  static ModelSet Shipped(std::string_view method = recon::kDefaultMethod);
  /// Loads named files. Files that the method does not read are not opened. Throws as Shipped does.
  static ModelSet Load(const ModelFiles& files, std::string_view method = recon::kDefaultMethod);
};

/// Loads ceiling_file. Throws InputError if it is missing or damaged.
std::shared_ptr<const forest::ForestModel> LoadCeilingForest(const ModelSet& models);

/// The models for a camera under the ceiling: this forest and its refinement, which is loaded now,
/// without what was learned on the errors of the level models. Throws InputError for a missing or
/// damaged file.
ModelSet LoadCeilingModels(const ModelSet& models,
                           std::shared_ptr<const forest::ForestModel> ceiling_forest);

/// The shipped refinement for a shipped forest, level or ceiling; null for another forest.
const char* FindShippedRefinement(const ModelFiles& files);

/// Loads only the prior of `files`, for methods that run on skeletons; null if the method uses
/// none. Throws InputError.
std::shared_ptr<const recon::PosturePrior> LoadPrior(const ModelFiles& files,
                                                     std::string_view method);
/// Likewise the database of `files`.
std::shared_ptr<const recon::PostureDatabase> LoadDatabase(const ModelFiles& files,
                                                           std::string_view method);
/// Loads a pose network as named in ModelFiles; null for "none". Throws InputError.
std::shared_ptr<const recon::PoseNetwork> LoadPoseNetwork(const std::string& file);

/// A sensor with known errors: its name (recon::SkeletonSequence::sensor), a description of its
/// skeletons for messages, and the shipped correction (ShippedFile).
struct KnownSensor {
  std::string_view sensor, description, correction;
};
/// Null for an unknown sensor.
const KnownSensor* FindKnownSensor(std::string_view sensor);

/// Whether the forest is the shipped one, by any path.
bool IsShippedForest(const ModelFiles& files);

}  // namespace ossa::tracker
