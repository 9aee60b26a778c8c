// Shum et al. 2013, sections V-B and VI.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "depth/base/random.h"
#include "recon/methods/posture_space_internal.h"

namespace ossa::recon {

PostureVector CoordinateWeights(const JointWeights& weights) {
  PostureVector out;
  for (size_t i = 0; i < kJointCount; ++i) {
    out.segment<3>(FirstCoordinate(i)).setConstant(static_cast<float>(weights[i]));
  }
  return out;
}

// Lazy products: the sizes are small, and GCC 12 warns of an infinite loop in the blocked kernel.
PostureVector PostureSpace::Posture(const Eigen::VectorXf& q) const {
  return mean + basis.lazyProduct(q);
}

Eigen::VectorXf PostureSpace::Project(const PostureVector& x) const {
  const PostureVector d = x - mean;
  return basis.transpose().lazyProduct(d);
}

namespace {

/// The database postures at `neighbours`, a column each.
Eigen::Matrix<float, kPostureDims, Eigen::Dynamic> Gather(const PostureDatabase& database,
                                                          std::span<const int> neighbours) {
  const auto k = static_cast<Eigen::Index>(neighbours.size());
  Eigen::Matrix<float, kPostureDims, Eigen::Dynamic> columns(kPostureDims, k);
  for (Eigen::Index n = 0; n < k; ++n) {
    columns.col(n) = database.postures().col(neighbours[static_cast<size_t>(n)]);
  }
  return columns;
}

/// How many principal axes to keep: at most `dimensions`, and only of a variance that rounding
/// errors cannot produce. `values`: eigenvalues, ascending.
Eigen::Index CountAxes(const Eigen::VectorXf& values, int dimensions) {
  const Eigen::Index most = values.size();
  const float smallest = std::max(1e-8F, 1e-5F * std::max(values[most - 1], 0.0F));
  Eigen::Index count = 0;
  while (count < std::min<Eigen::Index>(dimensions, most) && values[most - 1 - count] > smallest) {
    ++count;
  }
  return count;
}

}  // namespace

// The covariance D D' and the matrix D'D have the same non-zero eigenvalues, and D maps the
// eigenvectors of D'D to those of D D'. The smaller matrix is decomposed; K alone decides which.
PostureSpace MakePostureSpace(const PostureDatabase& database, std::span<const int> neighbours,
                              int dimensions) {
  const auto k = static_cast<Eigen::Index>(neighbours.size());
  const bool few = k <= kPostureDims;
  PostureSpace space;
  auto d = Gather(database, neighbours);
  space.mean = d.rowwise().mean();
  d.colwise() -= space.mean;
  Eigen::MatrixXf products;
  if (few) {
    products = d.transpose() * d;
  } else {
    products = d * d.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXf> eigen(products);
  const Eigen::VectorXf values = eigen.eigenvalues();  // ascending
  const Eigen::Index most = values.size();
  const Eigen::Index dims = CountAxes(values, dimensions);
  space.basis.resize(kPostureDims, dims);
  space.deviation.resize(dims);
  for (Eigen::Index c = 0; c < dims; ++c) {
    const float value = values[most - 1 - c];
    const auto direction = eigen.eigenvectors().col(most - 1 - c);
    if (few) {
      space.basis.col(c) = d * direction / std::sqrt(value);
    } else {
      space.basis.col(c) = direction;
    }
    space.deviation[c] = std::sqrt(value / static_cast<float>(k));
  }
  space.neighbours = space.basis.transpose() * d;
  space.outside = (d.colwise().squaredNorm() - space.neighbours.colwise().squaredNorm())
                      .cwiseMax(0.0F)
                      .transpose();
  return space;
}

namespace {

/// Squared norms of x y z columns, per sample.
Eigen::ArrayXf SquaredNorm(const Eigen::Ref<const Eigen::ArrayXXf>& xyz) {
  return xyz.col(0).square() + xyz.col(1).square() + xyz.col(2).square();
}

}  // namespace

Eigen::ArrayXf Energies(const PostureSpace& space, const EnergyInputs& inputs,
                        const LocalPcaOptions& options, const Eigen::MatrixXf& q) {
  const Eigen::Index samples = q.rows();
  Eigen::MatrixXf x = q * space.basis.transpose();  // samples x 60: a column is contiguous
  x.rowwise() += space.mean.transpose();
  Eigen::ArrayXf control = Eigen::ArrayXf::Zero(samples);
  Eigen::ArrayXf continuity = Eigen::ArrayXf::Zero(samples);
  Eigen::ArrayXf kinematics = Eigen::ArrayXf::Zero(samples);
  const bool history = inputs.last.has_value() && inputs.before_last.has_value();
  PostureVector expected = PostureVector::Zero();
  if (history) expected = 2.0F * *inputs.last - *inputs.before_last;
  Eigen::ArrayXXf d(samples, 3);
  for (size_t i = 0; i < kJointCount; ++i) {
    const auto xi = x.middleCols<3>(FirstCoordinate(i));
    const auto weight = static_cast<float>(inputs.reliability[i]);
    d = (xi.rowwise() - inputs.observed.segment<3>(FirstCoordinate(i)).transpose()).array();
    control += weight * SquaredNorm(d);  // eqs. 9-10
    if (history) {
      d = (xi.rowwise() - expected.segment<3>(FirstCoordinate(i)).transpose()).array();
      continuity += SquaredNorm(d);  // eq. 14
    }
    if (i == 0) continue;
    d = (xi - x.middleCols<3>(FirstCoordinate(ParentOf(i)))).array();
    const auto length = static_cast<float>(inputs.lengths_m[i]);
    kinematics += (SquaredNorm(d).sqrt() - length).square();  // eq. 12
  }
  // Eq. 11 within the space: |x - p_n|^2 = |q - q_n|^2 + the squared distance of p_n from the
  // space.
  Eigen::ArrayXXf style = (-2.0F * q * space.neighbours).array();
  style.colwise() += q.rowwise().squaredNorm().array();
  style.rowwise() += (space.neighbours.colwise().squaredNorm() + space.outside.transpose()).array();
  const Eigen::ArrayXf nearest = style.rowwise().minCoeff().max(0.0F) / float(kJointCount);
  return static_cast<float>(options.control) * control +
         static_cast<float>(options.style) * nearest +
         static_cast<float>(options.kinematics) * kinematics / float(kJointCount - 1) +
         static_cast<float>(options.continuity) * continuity / float(kJointCount);  // eq. 15
}

namespace {

/// Nearly standard normal, which is sufficient for exploration.
float DrawNormal(Random& random) {
  const int sum = SumOfParts(random.Bits());
  return static_cast<float>(static_cast<double>(sum - 2 * 65535) / 37836.8);  // unit variance
}

}  // namespace

SearchResult SearchStochastic(const PostureSpace& space, const EnergyInputs& inputs,
                              const LocalPcaOptions& options, const Eigen::VectorXf& start,
                              uint64_t seed) {
  SearchResult best{start, 0.0, 0};
  best.energy = Energies(space, inputs, options, start.transpose())[0];
  if (space.dimensions() == 0) return best;
  Random random(seed);
  Eigen::MatrixXf q(options.samples, space.dimensions());
  // The paper gives no radius. With many samples in n dimensions, the best step is about the
  // distance to the optimum over sqrt(n) (evolution strategies, Beyer 2001). Start with the
  // neighbours' own spread over sqrt(n), widen on success, narrow on failure. Directions in which
  // the neighbours hardly differ are searched, too; otherwise the user could not differ from them
  // either.
  const float root_n = std::sqrt(static_cast<float>(q.cols()));
  const float narrowest = 0.5F * space.deviation.norm() / root_n;
  float radius = 1.0F / root_n;
  for (; best.steps < options.steps && radius > 0.005F; ++best.steps) {
    for (Eigen::Index c = 0; c < q.cols(); ++c) {
      const float spread = radius * std::max(space.deviation[c], narrowest);
      for (Eigen::Index s = 0; s < q.rows(); ++s) q(s, c) = best.q[c] + spread * DrawNormal(random);
    }
    const Eigen::ArrayXf energies = Energies(space, inputs, options, q);
    Eigen::Index winner = 0;
    const double lowest = energies.minCoeff(&winner);
    if (lowest < best.energy) {
      best.energy = lowest;
      best.q = q.row(winner).transpose();
      radius *= 1.1F;
    } else {
      radius *= 0.6F;
    }
  }
  return best;
}

}  // namespace ossa::recon
