#pragma once
#include <cstdint>
#include <vector>

#include "recon/models/gaussian_process.h"

namespace ossa::recon {

// Constants: Liu 2016, section 4.2, where it has them, else by hand.

/// Liu 2016 sec. 4.2.
struct LocalMixtureOptions {
  int regions = 30;        // Q, by K-means
  int samples = 50;        // S of each local model, chosen by posture budgeting
  uint64_t seed = 1;       // of K-means
  double w_similar = 0.1;  // algorithm 2: below it a new local model is made; the paper gives none;
                           // no unit, in (0, 1]
  /// A local model that has learned more than so many on is budgeted (sec. 3.2) down to nine in ten
  /// of them, at once, because a removal costs as much as ten: its parameters' kernel is inverted.
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
  /// From models already learned (files).
  explicit LocalMixture(std::vector<GaussianProcess> models);

  /// Algorithm 1, online part: eq. 13 over the `nearby` most similar models (eq. 10).
  GaussianPrediction Predict(const Eigen::VectorXd& input, int nearby) const;
  /// Algorithm 2: the sample joins the most similar model, or opens one where none is similar. A
  /// new model has the parameters of the most similar one (the paper names none).
  void Update(const Eigen::VectorXd& input, const Eigen::Vector3d& output,
              const LocalMixtureOptions& options);

  /// Eq. 10 of the most similar model, in (0, 1]; 0 without models.
  double Similarity(const Eigen::VectorXd& input) const;

  bool empty() const { return models_.empty(); }
  const std::vector<GaussianProcess>& models() const { return models_; }

 private:
  /// Logarithm of eq. 10. Its W has no index of a model, as in the local processes of
  /// Nguyen-Tuong 2008 that the paper follows: one width for all. With each model's own, the model
  /// of the widest kernel is similar to everything and speaks everywhere.
  double LogSimilarity(size_t model, const Eigen::VectorXd& input) const;
  size_t MostSimilar(const Eigen::VectorXd& input) const;

  std::vector<GaussianProcess> models_;
  // C_q: the mean of the model's samples, as algorithm 2 keeps it. Departure: also before the first
  // update, when the paper's is that of K-means, with the samples that budgeting dropped.
  std::vector<Eigen::VectorXd> centres_;
  double w_ = 0.0;  // W of eq. 10: the median of those learned in the regions
};

/// Lloyd's K-means with seeded k-means++ starts; returns the region of each row.
std::vector<int> KMeans(const Eigen::MatrixXd& rows, int regions, uint64_t seed,
                        int iterations = 15);

}  // namespace ossa::recon
