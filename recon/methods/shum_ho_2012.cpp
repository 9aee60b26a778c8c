// H. P. H. Shum, E. S. L. Ho, Real-time physical modelling of character movements with Microsoft
// Kinect, VRST 2012: sections 5 and 6 (positions and axial rotations of the matched posture).

#include "recon/methods/bone_turns_internal.h"
#include "recon/methods/methods_internal.h"
#include "recon/methods/prepared_posture_internal.h"
#include "recon/spectrum.h"

namespace ossa::recon {
namespace {

constexpr int kReducedDims = 7;  // sec. 5.2: 60 dimensions reduced to 7

using Reduced = Eigen::VectorXf;

/// P_dr: the database projected by its global PCA.
struct ReducedDatabase {
  Eigen::MatrixXf projection;  // 60 x 7
  Eigen::MatrixXf postures;    // 7 x N
};

ReducedDatabase Reduce(const PostureDatabase& database) {
  Eigen::MatrixXf centred = database.postures();
  centred.colwise() -= database.mean();
  const Eigen::MatrixXf covariance =
      centred * centred.transpose() / static_cast<float>(database.size());
  ReducedDatabase reduced;
  reduced.projection = DecomposeSymmetric(covariance).vectors.rightCols(kReducedDims);
  reduced.postures = reduced.projection.transpose() * centred;
  return reduced;
}

class ShumHo2012 : public Reconstructor {
 public:
  explicit ShumHo2012(const ReconstructorOptions& options)
      : database_(options.database), reduced_(Reduce(*database_)), person_({}, options.bones_m) {}

  ReconstructedPosture Step(const ReconstructionInput& input) override {
    const PreparedPosture prepared = person_.Prepare(input);
    const int match = BestMatch(prepared);
    // Sec. 6.1: observed joints are kept, missing ones come from the matched posture. Departure: a
    // missing joint keeps its offset from the parent in the matched posture. The paper takes its
    // position, which preserves no segment's length, and leaves that to the physical character;
    // without a character, eqs. 3-4 would shorten bones by the difference of the two positions.
    Posture merged = prepared.normalised;
    const Posture matched = database_->posture(match);
    for (size_t i = 1; i < kJointCount; ++i) {
      if (prepared.present[i] > 0.0) continue;
      const auto parent = ParentOf(i);
      merged.position_m[i] =
          merged.position_m[parent] + matched.position_m[i] - matched.position_m[parent];
    }
    ReconstructedPosture out{person_.InCamera(merged, prepared), prepared.reliability};
    // Sec. 6.2. Departure: all axial rotations are the matched posture's, because positions alone,
    // without the SDK's orientations, do not determine them.
    const int matches[] = {match};
    const double weights[] = {1.0};
    out.orientation =
        TurnedOntoBones(*database_, matches, weights, out.posture, prepared.placement.yaw_rad);
    person_.Remember(out.posture, prepared);
    return out;
  }

  std::optional<BoneLengths> Bones() const override { return person_.size().Latest(); }
  void Reset() override { person_.Reset(); }

 private:
  /// Sec. 5.2: the nearest posture in the reduced space; joints missing in this frame are set to
  /// the mean. The paper has no reliability: inferred joints count as present.
  int BestMatch(const PreparedPosture& prepared) const {
    PostureVector difference = ToVector(prepared.normalised) - database_->mean();
    for (size_t i = 0; i < kJointCount; ++i) {
      if (prepared.present[i] == 0.0) difference.segment<3>(FirstCoordinate(i)).setZero();
    }
    const Reduced query = reduced_.projection.transpose().lazyProduct(difference);
    Eigen::Index best = 0;
    (reduced_.postures.colwise() - query).colwise().squaredNorm().minCoeff(&best);
    return static_cast<int>(best);
  }

  std::shared_ptr<const PostureDatabase> database_;
  ReducedDatabase reduced_;
  Person person_;
};

}  // namespace

std::unique_ptr<Reconstructor> MakeShumHo2012(const ReconstructorOptions& options) {
  return std::make_unique<ShumHo2012>(options);
}

}  // namespace ossa::recon
