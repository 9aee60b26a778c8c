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

/// One labelled object, cut out of a depth image.
struct TrainingImage {
  depth::Camera camera;            // of the cut: width, height and principal point shifted
  std::vector<uint16_t> depth_mm;  // height × width, 0 where it is not the object
  std::vector<uint8_t> label;      // class of each pixel, 0 where it is not the object
  uint8_t context = 0;
  std::vector<Eigen::Vector3f> target_m;  // camera space, one a target; NaN: unknown
  std::vector<uint8_t> target_visible;    // 1: its surface is seen
};

/// Where training images come from. Read is called from many threads at once.
class TrainingSource {
 public:
  virtual ~TrainingSource() = default;
  virtual size_t size() const = 0;
  /// Throws InputError for damage. An image without pixels is legal and skipped.
  virtual TrainingImage Read(size_t index) const = 0;
};

/// Names and targets of the model to be: what the numbers in the images mean.
struct TrainingVocabulary {
  std::vector<std::string> class_names;    // 0 is background
  std::vector<std::string> context_names;  // at least one
  std::vector<ProposalTarget> targets;     // name and classes; the rest is learned
};

struct TrainProgress {
  int tree = 0;  // from 0
  int trees = 0;
  int level = 0;  // -1: reading; depth: leaves; depth + 1: proposals
  int levels = 0;
  size_t nodes = 0;      // to split at this level
  double mean_gain = 0;  // bits a sample, of the level just finished
  double evaluations_per_s = 0;
  double seconds_left = 0;  // 0: not known yet
};

struct TrainOptions {
  int trees = 3;
  int depth = 20;         // levels of splits, 1..24
  int candidates = 2000;  // offset pairs a node (Shotton 2011, sec. 3.1)
  int thresholds = 50;    // a candidate, 2..63
  int pixels = 2000;      // an image; as many of each class present as there are, up to its share
  int refill_pixels = 0;  // an image, for leaves and votes; 0: as `pixels`
  /// Distinct offsets drawn a node. Departure: candidates are pairs of these (or of one of them and
  /// the pixel itself), so that a pixel is probed `offsets` times, not 2 · candidates times.
  int offsets = 128;
  double box_pixel_m = 260;  // longest offset each way at f = 575 px: 129 px at Shotton's 285 px
  /// Pixels looked at in a node; a larger node is sampled. 20 000 pixels order 10^5 splits as well
  /// as all of them do.
  int node_pixels = 20000;
  int min_node_pixels = 100;    // smaller nodes are leaves
  double min_gain_bits = 0.01;  // splits that gain less are not made
  double context_share = 0.15;  // of nodes that split for the context instead of the class
  int vote_depth = 13;          // votes are kept by nodes of this depth, one row a context
  uint64_t seed = 1;
  int threads = 0;                             // 0: all
  uint64_t memory_bytes = uint64_t{8} << 30U;  // for images; larger data stream in parts
  std::filesystem::path checkpoint;  // written after each level when not empty, removed at the end
  bool resume = false;               // go on from the checkpoint if it is there
  std::string fingerprint;           // of the data, for the checkpoint
  std::function<void(const TrainProgress&)> progress;
  std::function<bool()> stop;  // true: end with TrainInterrupted soon, the checkpoint kept

  /// Throws std::invalid_argument with name, value and range.
  void Check() const;
};

/// Totals of a training run, for the card and for benchmarks.
struct TrainSummary {
  uint64_t images = 0;
  uint64_t pixels = 0;       // sampled for structure, all trees
  uint64_t evaluations = 0;  // one response counted into one histogram
  double split_seconds = 0;  // spent searching splits, routing and reading included
  double total_seconds = 0;
};

/// Grows a forest breadth-first (Shotton et al. 2011, sec. 3.2) and fills its leaves. Pixels are
/// drawn so that classes are balanced within each image. Model bytes depend on source, options
/// other than threads and memory, and nothing else: any number of threads and ranks.
/// Throws InputError when the images hold no pixel, or only one class.
ForestModel Train(const TrainingSource& source, const TrainingVocabulary& vocabulary,
                  const TrainOptions& options, const Reducer& reducer = Reducer(),
                  TrainSummary* summary = nullptr);

/// Learns how the targets lie to each other in each context, on training truth: the model with
/// pose priors, and with the parameters of their inference as they were. As it was when the images
/// of known targets are too few.
ForestModel LearnPosePriors(const ForestModel& model, const TrainingSource& source,
                            size_t max_images, int threads);

/// Learns evidence scale, proposal parameters and confidences on images never trained on. Throws
/// InputError when none shows anything, or they are of other targets or contexts than the model.
ForestModel LearnProposals(const ForestModel& model, const TrainingSource& validation,
                           size_t max_images, int threads);

struct RefinementOptions {
  int hidden = 512;  // units of the hidden layer, 1..1024
  int epochs = 5;    // times that each image is looked at
  uint64_t seed = 1;
  int threads = 0;                                 // 0: all; they do not change the model
  std::function<void(int64_t, int64_t)> progress;  // steps done, steps in all
  std::function<bool()> stop;                      // true: end with TrainInterrupted
};

/// Learns the second stage on images of training subjects that no tree has seen: the model with a
/// refinement. Its thresholds are those of the model before; LearnConfidences sets them again.
/// Throws InputError when the model has no pose priors, or the images are too few.
ForestModel LearnRefinement(const ForestModel& model, const TrainingSource& source,
                            const RefinementOptions& options);

/// Learns joint-conditioned relabelling (Relabel) on images that neither trees nor refinement have
/// seen. Throws InputError when they show nothing, or classes that the model has not.
ForestModel LearnRelabelling(const ForestModel& model, const TrainingSource& source, uint64_t seed,
                             int threads);

/// Learns again, on images never trained on, from which confidence on targets are tracked and
/// inferred, and how likely modes are right that stand apart from where a refinement puts them.
ForestModel LearnConfidences(const ForestModel& model, const TrainingSource& validation,
                             size_t max_images, int threads);

}  // namespace ossa::forest
