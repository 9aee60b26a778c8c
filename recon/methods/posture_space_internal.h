#pragma once
#include <Eigen/Core>
#include <optional>
#include <span>

#include "recon/database/posture_database.h"
#include "recon/methods/reconstructor.h"

namespace ossa::recon {

/// Shum 2013 sec. V-B, the natural posture space: local PCA of the K nearest postures. A point q
/// is the posture x = mean + basis * q.
struct PostureSpace {
  PostureVector mean = PostureVector::Zero();
  Eigen::Matrix<float, kPostureDims, Eigen::Dynamic> basis;  // orthonormal columns, largest first
  Eigen::VectorXf deviation;   // standard deviation of the neighbours along each column, metres
  Eigen::MatrixXf neighbours;  // dimensions x K: the neighbours in the space
  Eigen::VectorXf outside;     // squared distance of each neighbour from the space, m^2

  int dimensions() const { return static_cast<int>(basis.cols()); }
  PostureVector Posture(const Eigen::VectorXf& q) const;
  Eigen::VectorXf Project(const PostureVector& x) const;
};

PostureSpace MakePostureSpace(const PostureDatabase& database, std::span<const int> neighbours,
                              int dimensions);

/// Inputs of the energy of eq. 15, all in the normalised frame.
struct EnergyInputs {
  PostureVector observed = PostureVector::Zero();  // p_k
  JointWeights reliability{};                      // R_i
  BoneLengths lengths_m{};                         // of the database
  std::optional<PostureVector> last;               // p_{x-1}; both or none
  std::optional<PostureVector> before_last;        // p_{x-2}
};

/// E of eq. 15 for each row of q (samples x dimensions).
Eigen::ArrayXf Energies(const PostureSpace& space, const EnergyInputs& inputs,
                        const LocalPcaOptions& options, const Eigen::MatrixXf& q);

/// E of eq. 15 as least squares: E = |r(q)|^2. Rows: control 60, kinematics 19, continuity 60 (zero
/// without history), style one per dimension (relative to neighbour `nearest`; its distance from
/// the space is constant).
class EnergyResiduals {
 public:
  EnergyResiduals(const PostureSpace& space, const EnergyInputs& inputs,
                  const LocalPcaOptions& options, int nearest);
  int rows() const;
  /// jacobian (rows x dimensions) may be null.
  void Evaluate(const Eigen::VectorXd& q, Eigen::VectorXd& residuals,
                Eigen::MatrixXd* jacobian) const;

 private:
  Eigen::MatrixXd basis_;
  Eigen::VectorXd mean_, observed_, control_weight_, continuity_target_, style_target_;
  BoneLengths lengths_m_;
  double kinematics_weight_, continuity_weight_, style_weight_;
};

struct SearchResult {
  Eigen::VectorXf q;
  double energy = 0.0;
  int steps = 0;
};

/// Sec. VI-E, local stochastic search from `start`; the same seed gives the same result.
SearchResult SearchStochastic(const PostureSpace& space, const EnergyInputs& inputs,
                              const LocalPcaOptions& options, const Eigen::VectorXf& start,
                              uint64_t seed);

/// Ours: minimises the same energy by Levenberg-Marquardt (Ceres); the nearest neighbour of the
/// style term is updated between runs.
SearchResult SearchCeres(const PostureSpace& space, const EnergyInputs& inputs,
                         const LocalPcaOptions& options, const Eigen::VectorXf& start);

/// The weights repeated for each coordinate.
PostureVector CoordinateWeights(const JointWeights& weights);

}  // namespace ossa::recon
