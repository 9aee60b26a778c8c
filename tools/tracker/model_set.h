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

/// What ModelFiles::pose_network says for the network that ossa ships.
inline constexpr std::string_view kShippedNetwork = "shipped";

/// The files of a ModelSet, each one a path; or "", what ossa ships where that belongs to the other
/// files and to the method; or "none", do without. README.md says which command makes which file.
struct ModelFiles {
  std::string forest;        // .ossa; "": the shipped one
  std::string refinement;    // .ossarefine; "": the shipped ones of the shipped forests, for
                             // methods that start from refined joints. A named one takes the place
                             // of that for cameras where it was learned: level, or above people
  std::string pose_network;  // .ossanet, or kShippedNetwork; "": that where the shipped
                             // cascade refines joints. Under the ceiling it has no say
  std::string surface;       // .ossasurface; "": the shipped one
  std::string learned;   // .ossagp; "": what is known of the errors that the shipped forest and a
                         // refinement leave, for methods that take a correction
  std::string prior;     // .ossaprior; "": the shipped one, for methods that complete by a prior
                         // where no database is named
  std::string database;  // .ossadb; "": the shipped one, for methods that need one
};

/// All that a tracker has learned, in memory. Read once, it serves any number of trackers, also at
/// the same time; members may be exchanged for others.
struct ModelSet {
  std::shared_ptr<const forest::ForestModel> forest;       // body parts and joint proposals; needed
  std::shared_ptr<const recon::JointRefiner> refinement;   // moves its joints at the depth image
  std::shared_ptr<const recon::PoseNetwork> pose_network;  // reads joints off the whole person
  std::shared_ptr<const recon::BodySurface> surface;       // whose fit explains the depth
  std::shared_ptr<const recon::LearnedModels> learned;     // the correction of systematic errors
  std::shared_ptr<const recon::PosturePrior> prior;        // of postures: joints unseen from seen
  std::shared_ptr<const recon::PostureDatabase> database;  // postures to look up
  // Where those came from, for messages.
  std::string forest_file, refinement_file, learned_file;
  /// The forest of a camera that looks down from the ceiling, read when one is met; "": none.
  std::string ceiling_file;
  std::string ceiling_refinement_file;  // of its joints, read with it; "": none
  bool from_ceiling = false;            // `forest` is one for such cameras
  /// Of named files that do not belong together, for people to see, one line each.
  std::vector<std::string> warnings;

  /// What ossa ships for a method of reconstruction (recon::MethodTable). Throws InputError where a
  /// file is missing or damaged, and for a method that does not exist.
  static ModelSet Shipped(std::string_view method = recon::kDefaultMethod);
  /// Named files. Those that the method does not read are not opened. Throws as Shipped does.
  static ModelSet Load(const ModelFiles& files, std::string_view method = recon::kDefaultMethod);
};

/// The forest of ceiling_file. Throws InputError where it is missing or damaged.
std::shared_ptr<const forest::ForestModel> LoadCeilingForest(const ModelSet& models);

/// The set for a camera under the ceiling: that forest, its refinement, read now, and nothing that
/// was learned on the errors of the others. Throws InputError where a file is missing or damaged.
ModelSet LoadCeilingModels(const ModelSet& models,
                           std::shared_ptr<const forest::ForestModel> ceiling_forest);

/// The shipped refinement of a shipped forest's joints, level or for ceilings; null of another one.
const char* FindShippedRefinement(const ModelFiles& files);

/// The prior of `files` alone, for methods that run on skeletons; null where the method reads none.
/// Throws InputError.
std::shared_ptr<const recon::PosturePrior> LoadPrior(const ModelFiles& files,
                                                     std::string_view method);
/// The database of `files` alone, likewise.
std::shared_ptr<const recon::PostureDatabase> LoadDatabase(const ModelFiles& files,
                                                           std::string_view method);
/// A pose network as ModelFiles names it; null of "none". Throws InputError.
std::shared_ptr<const recon::PoseNetwork> LoadPoseNetwork(const std::string& file);

/// A sensor whose errors are known: its name (recon::SkeletonSequence::sensor), whose skeletons
/// those are, for messages, and the shipped file that takes them off (ShippedFile).
struct KnownSensor {
  std::string_view sensor, description, correction;
};
/// Null of a sensor that is not known.
const KnownSensor* FindKnownSensor(std::string_view sensor);

/// Whether the forest is the shipped one, by whichever path.
bool IsShippedForest(const ModelFiles& files);

}  // namespace ossa::tracker
