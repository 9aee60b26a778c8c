// P. Plantard, H. P. H. Shum, F. Multon, Filtered pose graph for efficient Kinect pose
// reconstruction, Multimedia Tools and Applications 2016, section 6. The graph of section 4 is in
// recon/database.
#include <algorithm>

#include "recon/methods/methods_internal.h"
#include "recon/methods/natural_posture_internal.h"
#include "recon/methods/pose_graph_search_internal.h"

namespace ossa::recon {
namespace {

// Departure: the reliability is Shum 2013's (eqs. 1-8 there), which sec. 5 reviews. Eq. 3 as
// printed, one minus the mean cosine, would rate joints that move straight on as unreliable. With
// the angle that the text names it has no floor, roof or unit: in radians, every joint that turns
// by 57 degrees between two frames would be fully unreliable. Eq. 4 lets one bone's relative error
// exceed 1.
// Departure: eqs. 6, 8 and 9 print differences of positions where a norm or a square was meant:
// signs would cancel. The energies are squared as in [37] (Shum 2013), from which the paper takes
// them; eq. 8 is a mean where Shum's eq. 10 is a sum. With distances instead, eq. 8 would give up a
// whole leg to keep the other joints in place, and eq. 9 would tie the posture to one neighbour.
LocalPcaOptions WithMeanControl(LocalPcaOptions options) {
  options.control /= kJointCount;
  return options;
}

class Plantard2016 : public NaturalPostureMethod {
 public:
  explicit Plantard2016(const ReconstructorOptions& options)
      : NaturalPostureMethod(options), search_(database_) {
    options_ = WithMeanControl(options_);
  }

 private:
  /// Sec. 6.2: the K best of the nodes connected to the last ones (each is connected to itself,
  /// algorithm 3); of all nodes if there is no last frame, or if the best of these no longer
  /// resembles the observation.
  std::vector<int> Select(const EnergyInputs& energy, const PreparedPosture& prepared,
                          const ReconstructionInput&, std::vector<int> before) override {
    PoseQuery query{energy.observed, energy.reliability, energy.last};
    if (energy.last && energy.before_last) {
      const auto share = static_cast<float>(prepared.dt_s / last_dt_s_);
      *query.predicted += (*energy.last - *energy.before_last) * share;
    }
    last_dt_s_ = prepared.dt_s;
    const auto k = static_cast<size_t>(options_.neighbours);
    std::vector<int> candidates = before;
    if (!before.empty()) {
      for (const int node : before) {
        const auto near = database_->neighbours(node);
        candidates.insert(candidates.end(), near.begin(), near.end());
      }
      std::sort(candidates.begin(), candidates.end());
      candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
      // Lost: the neighbourhood is a whole edge farther away than a node of the graph can be from
      // any posture that it covers. Departure: the paper searches all nodes in the first frame
      // only.
      const double lost_m = 0.5 * database_->edge_threshold_m() + 0.1;
      PoseSelection connected = search_.SelectBest(candidates, query, k);
      if (connected.similarity_m < lost_m) return connected.nodes;
      candidates = std::move(connected.nodes);
    }
    return search_.SelectBestOfAll(query, k, candidates).nodes;
  }

  PoseGraphSearch search_;
  double last_dt_s_ = 1.0 / 30.0;
};

}  // namespace

std::unique_ptr<Reconstructor> MakePlantard2016(const ReconstructorOptions& options) {
  return std::make_unique<Plantard2016>(options);
}

}  // namespace ossa::recon
