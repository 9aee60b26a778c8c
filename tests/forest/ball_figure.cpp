#include "tests/forest/ball_figure.h"

#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

#include "tests/support/temporary_folder.h"

namespace ossa::forest::test {
namespace {

struct Ball {
  Eigen::Vector3d centre_m;
  double radius_m;
};

std::vector<Ball> FigureAt(std::mt19937_64& random, bool back) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const double yaw = 0.6 * unit(random) + (back ? 3.14159265358979 : 0.0);
  const Eigen::Vector3d place(0.3 * unit(random), 0.2 * unit(random), 2.2 + 0.5 * unit(random));
  const Eigen::AngleAxisd turn(yaw, Eigen::Vector3d::UnitY());
  // A figure that faces the camera looks along -z; its left is at negative x.
  const std::vector<Ball> rest = {{{0, 0, 0}, 0.25},
                                  {{0, 0.4, 0}, 0.14},
                                  {{-0.4, 0.2 * unit(random), 0}, 0.09},
                                  {{0.4, 0.2 * unit(random), 0}, 0.09},
                                  {{0, 0.4, -0.14}, 0.05}};
  std::vector<Ball> figure;
  for (const Ball& ball : rest) figure.push_back({turn * ball.centre_m + place, ball.radius_m});
  return figure;
}

// Depth of the first surface on the ray (x, y, 1), or 0.
double Hit(const Ball& ball, const Eigen::Vector3d& ray) {
  const double along = ray.dot(ball.centre_m) / ray.squaredNorm();
  const double square = ball.radius_m * ball.radius_m - (ball.centre_m - along * ray).squaredNorm();
  return square <= 0 ? 0.0 : along - std::sqrt(square / ray.squaredNorm());
}

}  // namespace

TrainingImage BallFigures::Read(size_t index) const {
  std::mt19937_64 random(seed_ * 1000003 + index);
  TrainingImage image;
  image.context = static_cast<uint8_t>(index % 2);
  const std::vector<Ball> figure = FigureAt(random, image.context == 1);
  image.camera = depth::KinectV1Camera(width_, width_ * 3 / 4);
  const auto pixels = static_cast<size_t>(image.camera.width * image.camera.height);
  image.depth_mm.assign(pixels, 0);
  image.label.assign(pixels, 0);
  for (int v = 0; v < image.camera.height; ++v) {
    for (int u = 0; u < image.camera.width; ++u) {
      const Eigen::Vector3d ray = depth::BackProject(image.camera, u, v, 1000.0);
      double nearest_m = 0;
      const auto at = static_cast<size_t>(v * image.camera.width + u);
      for (size_t b = 0; b < figure.size(); ++b) {
        const double z_m = Hit(figure[b], ray);
        if (z_m <= 0 || (nearest_m > 0 && z_m >= nearest_m)) continue;
        nearest_m = z_m;
        image.label[at] = static_cast<uint8_t>(b + 1);
      }
      image.depth_mm[at] = static_cast<uint16_t>(std::lround(nearest_m * 1000));
    }
  }
  for (const size_t b : {1U, 2U, 3U}) image.target_m.push_back(figure[b].centre_m.cast<float>());
  image.target_visible = {1, 1, 1};
  return image;
}

TrainingVocabulary BallVocabulary() {
  TrainingVocabulary vocabulary;
  vocabulary.class_names = {"background", "belly", "head", "left hand", "right hand", "nose"};
  vocabulary.context_names = {"front", "back"};
  ProposalTarget head;
  head.name = "Head";
  head.classes = {2, 5};
  head.push_back_m = 0.1F;
  ProposalTarget left;
  left.name = "HandLeft";
  left.classes = {3};
  ProposalTarget right;
  right.name = "HandRight";
  right.classes = {4};
  vocabulary.targets = {head, left, right};
  return vocabulary;
}

TrainOptions QuickOptions() {
  TrainOptions options;
  options.trees = 2;
  options.depth = 8;
  options.candidates = 200;
  options.thresholds = 20;
  options.offsets = 48;
  options.pixels = 60;
  options.refill_pixels = 120;
  options.min_node_pixels = 20;
  options.vote_depth = 5;
  return options;
}

const ForestModel& BallModel() {
  static const ForestModel model = Train(BallFigures(800, 1), BallVocabulary(), QuickOptions());
  return model;
}

std::vector<int32_t> ObjectPixels(const TrainingImage& image) {
  std::vector<int32_t> pixels;
  for (size_t i = 0; i < image.label.size(); ++i) {
    if (image.label[i] != 0) pixels.push_back(static_cast<int32_t>(i));
  }
  return pixels;
}

std::vector<char> ToBytes(const ForestModel& model) {
  const ossa::test::TemporaryFolder folder;
  WriteForestModel(folder / "model.ossa", model);
  std::ifstream file(folder / "model.ossa", std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace ossa::forest::test
