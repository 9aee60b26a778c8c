#include "tools/tracker/model_set.h"

#include <algorithm>
#include <array>
#include <future>
#include <utility>

#include "depth/base/checksummed_container.h"
#include "depth/base/large_pages.h"
#include "depth/base/one_line.h"
#include "forest/forest.h"
#include "forest/kept_tables.h"
#include "recon/database/posture_database.h"
#include "recon/fit/body_surface.h"
#include "recon/models/learned_models.h"
#include "recon/models/posture_prior.h"
#include "recon/refine/pose_network.h"
#include "recon/refine/refinement_cascade.h"
#include "recon/skeleton_sequence.h"
#include "tools/tracker/shipped.h"

namespace ossa::tracker {
namespace {

using recon::MethodInfo;
using recon::Reads;

constexpr const char* kForest = "body.ossa";
constexpr const char* kCeilingForest = "body_ceiling.ossa";
constexpr const char* kCeilingRefinement = "body_ceiling.ossarefine";
constexpr const char* kCorrection = "body.ossagp";
constexpr const char* kDatabase = "authored.ossadb";
constexpr const char* kWithout = "none";
constexpr std::array<KnownSensor, 2> kKnownSensors = {
    {{recon::kKinectV2, "a Kinect v2's skeletons", "kinect_v2.ossagp"},
     {recon::kRefinedJoints, "ossa's joints after the refinement cascade", kCorrection}}};

std::filesystem::path NamedOrShipped(const std::string& file, std::string_view shipped) {
  return file.empty() ? ShippedFile(shipped) : std::filesystem::path(file);
}

// A file for a camera under the ceiling; the shipped one is given by name only.
std::filesystem::path PathOrShipped(const std::string& file, const char* shipped) {
  return file == shipped ? ShippedFile(shipped) : std::filesystem::path(file);
}

// Optional files are read if named, required ones always.
bool IsRead(Reads reads, const std::string& file) {
  if (file == kWithout || reads == Reads::kNothing) return false;
  return reads == Reads::kRequired || !file.empty();
}

bool IsCeilingForest(const ModelFiles& files) {
  return !files.forest.empty() && IsShippedFile(files.forest, kCeilingForest);
}

std::shared_ptr<const recon::JointRefiner> ReadRefinement(const std::filesystem::path& path) {
  auto refinement = std::make_shared<recon::JointRefiner>(recon::JointRefiner::Load(path));
  ReturnFreedMemory();
  return refinement;
}

// The loaded refinement, and the file of the one for a camera under the ceiling.
struct Refinements {
  std::shared_ptr<const recon::JointRefiner> now;
  std::string now_file;     // of `now`
  bool is_shipped = false;  // `now`
  std::string ceiling_file;
  // Of the named one:
  uint64_t forest_checksum = 0;  // as RefinementCascade's
  bool is_for_ceiling = false;   // it is ceiling_file
};

// A named refinement is loaded for every method, because its joints may be the wanted output. With
// the shipped forest it replaces only the one for its own mount.
Refinements LoadRefinements(const ModelFiles& files, const MethodInfo& method) {
  if (files.refinement == kWithout) return {};
  const bool named = !files.refinement.empty();
  if (!named && !method.refined) return {};
  Refinements out;
  if (named) {
    out.now = ReadRefinement(files.refinement);
    out.now_file = files.refinement;
    out.forest_checksum = out.now->forest_checksum();
    out.is_shipped = IsShippedFile(files.refinement, recon::kShippedRefinement);
  }
  if (IsShippedForest(files)) {
    out.ceiling_file = kCeilingRefinement;
    if (named && out.now->from_above()) {
      out.ceiling_file = files.refinement;
      out.is_for_ceiling = true;
      out.now = nullptr;
    }
  }
  const char* const shipped = FindShippedRefinement(files);
  if (!out.now && shipped != nullptr) {
    out.now = ReadRefinement(ShippedFile(shipped));
    out.now_file = shipped;
    out.is_shipped = true;
  }
  return out;
}

// A refinement cascade is wrong on the joints of another forest than the one it was trained with.
// Files before version 8 do not name their forest.
std::vector<std::string> WarnOfOtherForest(const ModelFiles& files, const Refinements& read) {
  if (read.forest_checksum == 0) return {};
  const auto forest =
      read.is_for_ceiling ? ShippedFile(kCeilingForest) : NamedOrShipped(files.forest, kForest);
  if (ReadContainerChecksum(forest) == read.forest_checksum) return {};
  return {OnOneLine(files.refinement + ": learned at the joints of another forest than " +
                    forest.string() + ": 'ossa refine' trains one at those")};
}

// The forest from tables kept by an earlier start; null if there are none.
std::shared_ptr<const forest::ForestModel> KeptForest(const ModelFiles& files,
                                                      const std::filesystem::path& path) {
  if (!IsShippedForest(files)) return nullptr;
  auto model = forest::ReadKeptTables(path);
  return model ? std::make_shared<forest::ForestModel>(std::move(*model)) : nullptr;
}

std::shared_ptr<const forest::ForestModel> LoadForest(const ModelFiles& files,
                                                      const std::filesystem::path& path) {
  auto model = std::make_shared<forest::ForestModel>(
      forest::ReadForestModel(path, forest::ModelUse::kRunOnly));
  if (IsShippedForest(files)) forest::KeepTables(path, *model);
  return model;
}

std::shared_ptr<const recon::BodySurface> LoadSurface(const ModelFiles& files) {
  if (files.surface == kWithout) return nullptr;
  return std::make_shared<recon::BodySurface>(
      recon::BodySurface::Load(NamedOrShipped(files.surface, recon::kShippedSurface)));
}

// For a forest trained on our own bodies: bones have the proportions of the standard body.
std::shared_ptr<const recon::LearnedModels> StandardProportions() {
  auto models = std::make_shared<recon::LearnedModels>();
  models->correction.proportions.fill(1.0);
  return models;
}

// The network is used with the shipped cascade only; a named cascade is evaluated alone.
std::string PoseNetworkOf(const ModelFiles& files, const Refinements& read) {
  if (!files.pose_network.empty()) return files.pose_network;
  return std::string(read.is_shipped && IsShippedForest(files) ? kShippedNetwork : kWithout);
}

// A correction of the errors that refinement leaves in the shipped forest's joints is shipped
// (tools/train_correction). For other joints, bones are expected in the proportions of the standard
// body, on which their forest was trained.
std::shared_ptr<const recon::LearnedModels> LoadLearned(const ModelFiles& files,
                                                        const MethodInfo& method, bool refined) {
  if (IsRead(method.learned, files.learned) && !files.learned.empty()) {
    return std::make_shared<recon::LearnedModels>(recon::LearnedModels::Load(files.learned));
  }
  if (method.learned != Reads::kOptional) return nullptr;
  if (files.learned.empty() && refined && IsShippedForest(files)) {
    return std::make_shared<recon::LearnedModels>(
        recon::LearnedModels::Load(ShippedFile(kCorrection)));
  }
  return StandardProportions();
}

}  // namespace

const KnownSensor* FindKnownSensor(std::string_view sensor) {
  const auto* const known = std::find_if(kKnownSensors.begin(), kKnownSensors.end(),
                                         [&](const KnownSensor& k) { return k.sensor == sensor; });
  return known == kKnownSensors.end() ? nullptr : &*known;
}

bool IsShippedForest(const ModelFiles& files) {
  return files.forest.empty() || IsShippedFile(files.forest, kForest);
}

std::shared_ptr<const recon::PosturePrior> LoadPrior(const ModelFiles& files,
                                                     std::string_view method) {
  const MethodInfo& info = recon::RequireMethod(method);
  const bool by_database = files.prior.empty() && IsRead(info.database, files.database);
  if (!info.prior || files.prior == kWithout || by_database) return nullptr;
  return std::make_shared<recon::PosturePrior>(
      recon::PosturePrior::Load(NamedOrShipped(files.prior, recon::kShippedPrior)));
}

std::shared_ptr<const recon::PoseNetwork> LoadPoseNetwork(const std::string& file) {
  if (file == kWithout) return nullptr;
  return std::make_shared<recon::PoseNetwork>(
      recon::PoseNetwork::Load(file == kShippedNetwork ? ShippedFile(recon::kShippedPoseNetwork)
                                                       : std::filesystem::path(file)));
}

std::shared_ptr<const recon::PostureDatabase> LoadDatabase(const ModelFiles& files,
                                                           std::string_view method) {
  if (!IsRead(recon::RequireMethod(method).database, files.database)) return nullptr;
  return std::make_shared<recon::PostureDatabase>(
      recon::PostureDatabase::Load(NamedOrShipped(files.database, kDatabase)));
}

ModelSet ModelSet::Shipped(std::string_view method) { return Load({}, method); }

ModelSet ModelSet::Load(const ModelFiles& files, std::string_view method) {
  const MethodInfo& info = recon::RequireMethod(method);
  ModelSet set;
  const auto forest = NamedOrShipped(files.forest, kForest);
  auto refinements = std::async(std::launch::async, [&] { return LoadRefinements(files, info); });
  // Reading a refinement and kept tables both need much temporary memory: one after the other.
  if (IsShippedForest(files) && forest::MayHaveKeptTables(forest)) refinements.wait();
  set.forest_file = files.forest.empty() ? kForest : files.forest;
  set.forest = KeptForest(files, forest);
  if (set.forest == nullptr) set.forest = LoadForest(files, forest);
  Refinements read = refinements.get();
  set.warnings = WarnOfOtherForest(files, read);
  set.refinement = std::move(read.now);
  set.refinement_file = std::move(read.now_file);
  set.ceiling_refinement_file = std::move(read.ceiling_file);
  set.pose_network = LoadPoseNetwork(PoseNetworkOf(files, read));
  set.surface = LoadSurface(files);
  set.database = LoadDatabase(files, method);
  set.prior = LoadPrior(files, method);
  set.learned = LoadLearned(files, info, set.refinement != nullptr);
  set.learned_file = files.learned;
  set.from_ceiling = IsCeilingForest(files);
  if (IsShippedForest(files)) set.ceiling_file = kCeilingForest;
  ReturnFreedMemory();
  return set;
}

std::shared_ptr<const forest::ForestModel> LoadCeilingForest(const ModelSet& models) {
  return std::make_shared<forest::ForestModel>(forest::ReadForestModel(
      PathOrShipped(models.ceiling_file, kCeilingForest), forest::ModelUse::kRunOnly));
}

ModelSet LoadCeilingModels(const ModelSet& models,
                           std::shared_ptr<const forest::ForestModel> ceiling_forest) {
  ModelSet set = models;
  set.ceiling_file.clear();
  set.from_ceiling = true;
  set.forest_file = models.ceiling_file;
  set.forest = std::move(ceiling_forest);
  set.refinement_file = models.ceiling_refinement_file;
  set.refinement = set.refinement_file.empty()
                       ? nullptr
                       : ReadRefinement(PathOrShipped(set.refinement_file, kCeilingRefinement));
  if (set.learned && set.learned_file.empty()) set.learned = StandardProportions();
  return set;
}

const char* FindShippedRefinement(const ModelFiles& files) {
  if (IsShippedForest(files)) return recon::kShippedRefinement;
  return IsCeilingForest(files) ? kCeilingRefinement : nullptr;
}

}  // namespace ossa::tracker
