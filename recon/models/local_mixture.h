#pragma once
#include <cstdint>
#include <vector>

#include "recon/models/gaussian_process.h"

namespace ossa::recon {

// Constants: Liu 2016, section 4.2, where it has them, else by hand.

/// Liu 2016 sec. 4.2.
struct LocalMixtureOptions {
  int regions = 30;   // Q, by K-means
  int samples = 50;   // S of each local model, chosen by posture budgeting
  uint64_t seed = 1;  // of K-means
  /// Algorithm 2: similarity in (0, 1], no unit, below which a local model is created; the paper
  /// gives none.
  double w_similar = 0.1;
  /// An online model with more samples than this is budgeted (sec. 3.2) down to nine tenths of them
  /// in one go: one removal costs as much as ten, because its kernel matrix is inverted.
  int most_samples = 100;
  int most_models = 60;
};

/// One joint's mixture of local Gaussian processes.
class LocalMixture {
 public:
  LocalMixture() = default;
  /// Algorithm 1, offline part.
  static LocalMixture Learn(const Eigen::MatrixXd& inputs, const Eigen::MatrixXd& outputs,
                            const LocalMixtureOptions& options);
  /// From models that were read from a file.
  explicit LocalMixture(std::vector<GaussianProcess> models);

  /// Algorithm 1, online part: eq. 13 over the `nearby` most similar models (eq. 10).
  GaussianPrediction Predict(const Eigen::VectorXd& input, int nearby) const;
  /// Algorithm 2: adds the sample to the most similar model, or creates one if none is similar. A
  /// new model gets the parameters of the most similar one (the paper gives none).
  void Update(const Eigen::VectorXd& input, const Eigen::Vector3d& output,
              const LocalMixtureOptions& options);

  /// Eq. 10 of the most similar model, in (0, 1]; 0 without models.
  double Similarity(const Eigen::VectorXd& input) const;

  bool empty() const { return models_.empty(); }
  const std::vector<GaussianProcess>& models() const { return models_; }

 private:
  /// Logarithm of eq. 10. Its W has no model index, as in the local processes of Nguyen-Tuong 2008
  /// that the paper follows: one width for all. With each model's own width, the model with the
  /// widest kernel would be similar to everything.
  double LogSimilarity(size_t model, const Eigen::VectorXd& input) const;
  size_t MostSimilar(const Eigen::VectorXd& input) const;

  std::vector<GaussianProcess> models_;
  // C_q: the mean of the model's samples, as algorithm 2 updates it. Departure: also before the
  // first update, where the paper uses the K-means centre, which includes samples dropped by
  // budgeting.
  std::vector<Eigen::VectorXd> centres_;
  double w_ = 0.0;  // W of eq. 10: the median over the regions
};

/// Lloyd's K-means with seeded k-means++ initialisation; returns the region of each row.
std::vector<int> KMeans(const Eigen::MatrixXd& rows, int regions, uint64_t seed,
                        int iterations = 15);

}  // namespace ossa::recon
