#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "depth/image/camera.h"
#include "forest/forest.h"
#include "forest/training/reducer.h"

namespace ossa::forest {

// Constants: Shotton 2011, section 3.3, where it has them (trees, depth, pixels, candidates,
// thresholds), else chosen by hand on validation subjects.

/// One labelled object, cropped from a depth image.
struct TrainingImage {
  depth::Camera camera;            // of the crop: width, height and shifted principal point
  std::vector<uint16_t> depth_mm;  // height × width, 0 where it is not the object
  std::vector<uint8_t> label;      // class of each pixel, 0 where it is not the object
  uint8_t context = 0;
  std::vector<Eigen::Vector3f> target_m;  // camera space, one per target; NaN: unknown
  std::vector<uint8_t> target_visible;    // 1: its surface is visible
};

/// A source of training images. Read is called from many threads concurrently.
class TrainingSource {
 public:
  virtual ~TrainingSource() = default;
  virtual size_t size() const = 0;
  /// Throws InputError for damaged images. Images without pixels are allowed and skipped.
  virtual TrainingImage Read(size_t index) const = 0;
};

/// Names and targets of the new model: the meaning of the numbers in the images.
struct TrainingVocabulary {
  std::vector<std::string> class_names;    // 0 is background
  std::vector<std::string> context_names;  // at least one
  std::vector<ProposalTarget> targets;     // name and classes only; the rest is learned
};

struct TrainProgress {
  int tree = 0;  // from 0
  int trees = 0;
  int level = 0;  // -1: reading; depth: leaves; depth + 1: proposals
  int levels = 0;
  size_t nodes = 0;      // nodes to split at this level
  double mean_gain = 0;  // bits per sample, of the last level
  double evaluations_per_s = 0;
  double seconds_left = 0;  // 0: unknown
};

struct TrainOptions {
  int trees = 3;
  int depth = 20;         // levels of splits, 1..24
  int candidates = 2000;  // offset pairs per node (Shotton 2011, sec. 3.1)
  int thresholds = 50;    // per candidate, 2..63
  int pixels = 2000;      // per image; equally many of each present class, if available
  int refill_pixels = 0;  // per image, for leaves and votes; 0: as `pixels`
  /// Distinct offsets drawn per node. Departure: candidates are pairs of these (or of one of them
  /// and the pixel itself), so that a pixel is probed `offsets` times, not 2 · candidates times.
  int offsets = 128;
  double box_pixel_m = 260;  // longest offset each way at f = 575 px: 129 px at Shotton's 285 px
  /// Pixels used per node; larger nodes are sampled. 20 000 pixels rank 10^5 splits as well as all
  /// pixels do.
  int node_pixels = 20000;
  int min_node_pixels = 100;    // smaller nodes are leaves
  double min_gain_bits = 0.01;  // minimum gain of a split
  double context_share = 0.15;  // share of nodes that split for the context instead of the class
  int vote_depth = 13;          // votes are stored by nodes of this depth, one row per context
  uint64_t seed = 1;
  int threads = 0;                             // 0: all
  uint64_t memory_bytes = uint64_t{8} << 30U;  // for images; larger data are streamed in parts
  std::filesystem::path checkpoint;  // written after each level if not empty, removed at the end
  bool resume = false;               // continue from the checkpoint if it exists
  std::string fingerprint;           // identifies the data in the checkpoint
  std::function<void(const TrainProgress&)> progress;
  std::function<bool()> stop;  // true: stop with TrainInterrupted, keeping the checkpoint

  /// Throws std::invalid_argument with name, value and range.
  void Check() const;
};

/// Totals of a training run, for the model card and benchmarks.
struct TrainSummary {
  uint64_t images = 0;
  uint64_t pixels = 0;       // sampled for the structure of all trees
  uint64_t evaluations = 0;  // histogram increments
  double split_seconds = 0;  // time of split search, including routing and reading
  double total_seconds = 0;
};

/// Grows a forest breadth-first (Shotton et al. 2011, sec. 3.2) and fills its leaves. Pixels are
/// sampled so that classes are balanced within each image. Model bytes depend only on the source
/// and on options other than threads and memory: not on the number of threads and ranks. Throws
/// InputError if the images have no pixels, or only one class.
ForestModel Train(const TrainingSource& source, const TrainingVocabulary& vocabulary,
                  const TrainOptions& options, const Reducer& reducer = Reducer(),
                  TrainSummary* summary = nullptr);

/// Learns the relative positions of targets in each context from training truth. Returns the model
/// with pose priors, and unchanged inference parameters; unchanged altogether if there are too few
/// images with known targets.
ForestModel LearnPosePriors(const ForestModel& model, const TrainingSource& source,
                            size_t max_images, int threads);

/// Learns evidence scale, proposal parameters and confidences on images never used for training.
/// Throws InputError if none shows an object, or if they have other targets or contexts than the
/// model.
ForestModel LearnProposals(const ForestModel& model, const TrainingSource& validation,
                           size_t max_images, int threads);

struct RefinementOptions {
  int hidden = 512;      // units of the hidden layer, 1..1024
  int epochs = 5;        // passes over the images
  float dropped = 0.1F;  // dropout, share of hidden units: 0 up to but not including 1
  uint64_t seed = 1;
  int threads = 0;                                 // 0: all; they do not change the model
  std::function<void(int64_t, int64_t)> progress;  // steps done, steps in all
  std::function<bool()> stop;                      // true: stop with TrainInterrupted
};

/// Learns the second stage on images of training subjects that no tree has seen. Returns the model
/// with a refinement and unchanged thresholds; LearnConfidences updates these. Throws InputError if
/// the model has no pose priors, or the images are too few.
ForestModel LearnRefinement(const ForestModel& model, const TrainingSource& source,
                            const RefinementOptions& options);

/// Learns joint-conditioned relabelling (Relabel) on images that neither trees nor refinement have
/// seen. Throws InputError if they show no object, or have unknown classes.
ForestModel LearnRelabelling(const ForestModel& model, const TrainingSource& source, uint64_t seed,
                             int threads);

/// Relearns, on images never used for training, the confidence thresholds of tracked and inferred
/// targets, and the confidence of modes apart from the refined position.
ForestModel LearnConfidences(const ForestModel& model, const TrainingSource& validation,
                             size_t max_images, int threads);

}  // namespace ossa::forest
