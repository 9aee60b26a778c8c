#include "tools/synth/distractors.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "depth/render/shapes.h"

namespace ossa::tools {
namespace {

// Constants: sizes of furniture, clothes and plants, metres, chosen by hand.

using Eigen::Affine3f;
using Eigen::Vector3f;

float Draw(Random& random, double low, double high) {
  return static_cast<float>(random.Uniform(low, high));
}

void AppendBox(depth::TriangleMesh& mesh, const Vector3f& size_m, const Vector3f& at_m) {
  depth::Append(mesh, depth::Moved(depth::MakeBox(size_m), Affine3f(Eigen::Translation3f(at_m))));
}

/// A shelf with books and boxes; stands on y = 0, open to +z.
depth::TriangleMesh MakeShelf(Random& random) {
  const float wide_m = Draw(random, 0.5, 1.2), deep_m = Draw(random, 0.22, 0.4);
  const float step_m = Draw(random, 0.28, 0.45);
  const auto boards = static_cast<int>(3 + random.Index(4));
  const float high_m = step_m * static_cast<float>(boards - 1);
  depth::TriangleMesh shelf;
  for (const float side : {-1.0F, 1.0F}) {
    AppendBox(shelf, {0.02F, high_m, deep_m}, {side * wide_m / 2, high_m / 2, 0});
  }
  for (int b = 0; b < boards; ++b) {
    const float y = step_m * static_cast<float>(b);
    AppendBox(shelf, {wide_m, 0.02F, deep_m}, {0, y, 0});
    const size_t things = b + 1 < boards ? random.Index(6) : 0;
    for (size_t i = 0; i < things; ++i) {
      const float thing_m = Draw(random, 0.03, 0.3), tall_m = Draw(random, 0.1, 0.9) * step_m;
      const float x = Draw(random, -0.4, 0.4) * wide_m;
      AppendBox(shelf, {thing_m, tall_m, 0.8F * deep_m}, {x, y + tall_m / 2, 0});
    }
  }
  return shelf;
}

/// A coat on a hook or a stand: shoulders, a folded body, sleeves.
depth::TriangleMesh MakeHungCoat(Random& random) {
  const float top_m = Draw(random, 1.4, 1.9), long_m = Draw(random, 0.6, 1.2);
  const float wide_m = Draw(random, 0.14, 0.24), deep_m = Draw(random, 0.06, 0.14);
  depth::TriangleMesh coat = depth::MakeCapsule(1.0F, 2.0F, 20);
  const auto folds = static_cast<float>(3 + random.Index(5));
  for (Vector3f& p : coat.vertices_m) {
    const float down = (2.0F - p.y()) / 4.0F;  // 0 at the top, 1 at the hem
    const float fold = 1.0F + 0.25F * down * std::sin(folds * std::atan2(p.x(), p.z()));
    p = Vector3f(p.x() * wide_m * fold * (0.8F + 0.4F * down), top_m - down * long_m,
                 p.z() * deep_m * fold);
  }
  for (const float side : {-1.0F, 1.0F}) {
    const float sleeve_m = Draw(random, 0.4, 0.6);
    depth::Append(coat,
                  depth::Moved(depth::MakeCapsule(0.06F, sleeve_m, 10),
                               Affine3f(Eigen::Translation3f(side * (wide_m + 0.04F),
                                                             top_m - 0.15F - sleeve_m / 2, 0))));
  }
  if (random.Chance(0.5)) AppendBox(coat, {0.04F, top_m + 0.1F, 0.04F}, {0, top_m / 2, -0.05F});
  return coat;
}

/// A door frame; half of them have an open door.
depth::TriangleMesh MakeDoorFrame(Random& random) {
  const float wide_m = Draw(random, 0.75, 1.0), high_m = Draw(random, 1.95, 2.1);
  const float post_m = Draw(random, 0.06, 0.15);
  depth::TriangleMesh frame;
  for (const float side : {-1.0F, 1.0F}) {
    AppendBox(frame, {post_m, high_m, 0.15F}, {side * (wide_m + post_m) / 2, high_m / 2, 0});
  }
  AppendBox(frame, {wide_m + 2 * post_m, post_m, 0.15F}, {0, high_m + post_m / 2, 0});
  if (random.Chance(0.5)) {
    const float open = Draw(random, 0.3, 1.5);
    depth::Append(frame,
                  depth::Moved(depth::MakeBox({wide_m, high_m, 0.04F}),
                               Eigen::Translation3f(-wide_m / 2, high_m / 2, 0) *
                                   Eigen::AngleAxisf(open, Vector3f::UnitY()) *
                                   Eigen::Translation3f(wide_m / 2, 0, 0) * Affine3f::Identity()));
  }
  return frame;
}

/// A plant in a pot, as tall as a head to as tall as a person.
depth::TriangleMesh MakePlant(Random& random) {
  const float high_m = Draw(random, 0.5, 1.9), round_m = Draw(random, 0.15, 0.45);
  depth::TriangleMesh plant;
  AppendBox(plant, {0.28F, 0.3F, 0.28F}, {0, 0.15F, 0});
  AppendBox(plant, {0.03F, high_m, 0.03F}, {0, high_m / 2, 0});
  const size_t leaves = 8 + random.Index(20);
  for (size_t i = 0; i < leaves; ++i) {
    const float x = Draw(random, -1, 1) * round_m, z = Draw(random, -1, 1) * round_m;
    const float y = Draw(random, 0.35, 1.0) * high_m, long_m = Draw(random, 0.08, 0.3);
    const float about = Draw(random, -3.1, 3.1), lean = Draw(random, -1.2, 1.2);
    depth::Append(
        plant,
        depth::Moved(depth::MakeBox({0.3F * long_m, long_m, 0.004F}),
                     Eigen::Translation3f(x, y, z) * Eigen::AngleAxisf(about, Vector3f::UnitY()) *
                         Eigen::AngleAxisf(lean, Vector3f::UnitX()) * Affine3f::Identity()));
  }
  return plant;
}

depth::TriangleMesh MakeNobody(Random& random) {
  switch (random.Index(4)) {
    case 0:
      return MakeShelf(random);
    case 1:
      return MakeHungCoat(random);
    case 2:
      return MakeDoorFrame(random);
    default:
      return MakePlant(random);
  }
}

}  // namespace

std::vector<Prop> SampleDistractors(const Eigen::Isometry3d& camera_from_world, Random& random) {
  constexpr float kNear_m = 0.9F, kFar_m = 2.5F;
  const Affine3f move(camera_from_world.cast<float>().matrix());
  std::vector<Prop> props;
  const size_t count = 2 + random.Index(4);
  for (size_t i = 0; i < count; ++i) {
    // Beside and behind the person, not between the person and the camera.
    const float about = Draw(random, 0.4, 1.6) * std::numbers::pi_v<float>;
    const float away_m = Draw(random, kNear_m, kFar_m), turn = Draw(random, -0.5, 0.5);
    const Vector3f at_m(away_m * std::sin(about), 0, away_m * std::cos(about));
    props.push_back(
        {depth::Moved(MakeNobody(random), move * Eigen::Translation3f(at_m) *
                                              Eigen::AngleAxisf(turn, Vector3f::UnitY())),
         false});
  }
  return props;
}

}  // namespace ossa::tools
