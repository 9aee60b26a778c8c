#include "recon/refine/refinement_cascade.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "tests/recon/refine/refinement_scene.h"

namespace ossa::recon {
namespace {

using test::kCentre;
using test::kHeight;
using test::kWall_m;
using test::kWidth;
using test::NetworkOf;
using test::Scene;
using test::Silent;

std::optional<Posture> JointsOf(const std::optional<RefinedPerson>& refined) {
  return refined ? std::optional(refined->joints_m) : std::nullopt;
}

TEST(RefinementCascade, FeatureIsTheDepthBehindTheJoint) {
  Scene scene;
  const auto seen = SampledPerson::Sample(scene.input);
  ASSERT_TRUE(seen);
  for (size_t j = 0; j < kJointCount; ++j) {
    const double along = scene.input.proposed.position_m[j].norm() / (kWall_m + 0.05);
    EXPECT_NEAR(seen->samples[j][kCentre].behind_mm(), -50.0 * along, 2.0) << j;
  }
  // Straight ahead the coarser grid reaches as far up as it should: the ray is level there.
  EXPECT_NEAR((seen->frame_from_camera * Eigen::Vector3d::UnitY()).y(), 1.0, 0.1);
}

TEST(RefinementCascade, DistinguishesBackgroundAndOcclusion) {
  Scene scene;
  const auto centre = [&] {
    return SampledPerson::Sample(scene.input)->samples[Joint::kHead][kCentre];
  };
  std::fill(scene.is_person.begin(), scene.is_person.end(), uint8_t{0});
  const auto all = [&](double depth_m) {
    std::fill(scene.frame.depth_mm.begin(), scene.frame.depth_mm.end(),
              static_cast<uint16_t>(1000 * depth_m));
  };
  EXPECT_EQ(centre().hidden(), 1.0F);  // a wall just before the head, not the person's
  all(kWall_m + 1.0);
  EXPECT_EQ(centre().beside(), 1.0F);
  all(0.0);  // no reading
  EXPECT_EQ(centre().beside(), 1.0F);
  all(kWall_m - 1.0);
  EXPECT_EQ(centre().hidden(), 1.0F);
  scene.input.proposed[Joint::kHead].x() = 50.0;  // outside the image
  all(kWall_m + 1.0);
  EXPECT_EQ(centre().hidden(), 1.0F);
}

// A person without symmetry, on a slanted surface.
void MakeAsymmetric(Scene& scene) {
  scene.frame.camera.cx = (kWidth - 1) / 2.0;
  scene.input.proposed[Joint::kHandLeft] += Eigen::Vector3d(0.1, 0.3, -0.2);
  scene.input.confidence[Joint::kKneeRight] = 0.1;
  scene.input.seen[Joint::kFootLeft] = false;
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      const auto i = static_cast<size_t>(v * kWidth + u);
      scene.frame.depth_mm[i] = static_cast<uint16_t>(1900 + u + 2 * v);
      scene.is_person[i] = u < 100 ? 1 : 0;
    }
  }
}

void MirrorInto(const Scene& scene, Scene& mirror) {
  mirror.frame.camera = scene.frame.camera;
  for (size_t j = 0; j < kJointCount; ++j) {
    const auto other = kMirroredJoint[j];
    mirror.input.proposed.position_m[other] =
        scene.input.proposed.position_m[j].cwiseProduct(Eigen::Vector3d(-1, 1, 1));
    mirror.input.confidence[other] = scene.input.confidence[j];
    mirror.input.seen[other] = scene.input.seen[j];
  }
  for (size_t i = 0; i < scene.is_person.size(); ++i) {
    const size_t row = i / kWidth * kWidth, other = row + kWidth - 1 - i % kWidth;
    mirror.frame.depth_mm[other] = scene.frame.depth_mm[i];
    mirror.is_person[other] = scene.is_person[i];
  }
}

TEST(RefinementCascade, IsEquivariantUnderMirroring) {
  Scene scene, mirror;
  MakeAsymmetric(scene);
  MirrorInto(scene, mirror);
  const SampledPerson expected = *SampledPerson::Sample(mirror.input);
  const SampledPerson got = SampledPerson::Sample(scene.input)->Mirrored();
  EXPECT_TRUE(got.middle_m.isApprox(expected.middle_m));
  EXPECT_TRUE(got.frame_from_camera.isApprox(expected.frame_from_camera));
  int different = 0;
  for (size_t j = 0; j < kJointCount; ++j) {
    EXPECT_LT((got.place.position_m[j] - expected.place.position_m[j]).norm(), 1e-9) << j;
    EXPECT_EQ(got.confidence[j], expected.confidence[j]) << j;
    EXPECT_EQ(got.seen[j], expected.seen[j]) << j;
    for (size_t s = 0; s < kSurfaceSamples; ++s) {
      const SurfaceSample &one = got.samples[j][s], &other = expected.samples[j][s];
      different += std::abs(one.behind_mm() - other.behind_mm()) > 1 ? 1 : 0;
      different += one.surface() != other.surface() || one.hidden() != other.hidden() ? 1 : 0;
    }
  }
  // Only where one falls between two pixels may the other one be read.
  EXPECT_LT(different, kJointCount * kSurfaceSamples / 100);
  EXPECT_TRUE(ComputeStageFeatures(got, Joint::kHead).allFinite());
}

TEST(RefinementCascade, MirrorsTheNetworkForTheOtherSide) {
  Scene scene;
  RefinementCascade cascade = Silent();
  cascade.stages[0][NetworkOf(Joint::kHead)].layers[1].bias = Eigen::Vector3f(0.0F, 0.5F, 0.0F);
  cascade.stages[0][NetworkOf(Joint::kKneeLeft)].layers[1].bias = Eigen::Vector3f(0.4F, 0.0F, 0.0F);
  const auto joints_m = JointsOf(JointRefiner(cascade).Refine(scene.input));
  ASSERT_TRUE(joints_m);
  const auto moved_m = [&](Joint joint) -> Eigen::Vector3d {
    return (*joints_m)[joint] - scene.input.proposed[joint];
  };
  EXPECT_NEAR(moved_m(Joint::kHead).norm(), 0.05, 1e-6);
  EXPECT_GT(moved_m(Joint::kHead).y(), 0.045);
  EXPECT_NEAR(moved_m(Joint::kKneeLeft).x(), 0.04, 0.002);
  EXPECT_NEAR(moved_m(Joint::kKneeRight).x(), -0.04, 0.002);
  EXPECT_EQ(moved_m(Joint::kSpine).norm(), 0.0);
}

TEST(RefinementCascade, StagesStartFromThePreviousJoints) {
  Scene scene;
  RefinementCascade cascade = Silent();
  cascade.stages[0][NetworkOf(Joint::kHead)].layers[1].bias = Eigen::Vector3f(0.0F, 0.5F, 0.0F);
  const auto once_m = JointsOf(JointRefiner(cascade).Refine(scene.input));
  ASSERT_TRUE(once_m);
  // The second says that the head is back where it was proposed, which it knows as it moved.
  cascade.stages.push_back(Silent().stages[0]);
  Perceptron& head = cascade.stages[1][NetworkOf(Joint::kHead)];
  constexpr int kMoved = 3 * kSurfaceSamples + 3 * kJointCount;  // of the inputs: moves so far
  head = ossa::test::SilentPerceptron({kStageFeatures, 3});
  for (int axis = 0; axis < 3; ++axis) {
    head.layers[0].weight(kMoved + FirstCoordinate(Index(Joint::kHead)) + axis, axis) =
        -1.0F / static_cast<float>(RefinementCascade::kOffsets.step_m);
  }
  const auto twice_m = JointsOf(JointRefiner(cascade).Refine(scene.input));
  ASSERT_TRUE(twice_m);
  EXPECT_GT(((*once_m)[Joint::kHead] - scene.input.proposed[Joint::kHead]).norm(), 0.04);
  // Its weights are bytes: a part in five hundred.
  EXPECT_NEAR(((*twice_m)[Joint::kHead] - scene.input.proposed[Joint::kHead]).norm(), 0.0, 1e-4);

  const RefinementInput moved = scene.input.MovedTo(*once_m);
  const auto first = SampledPerson::Sample(scene.input), second = SampledPerson::Sample(moved);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->moved[Joint::kHead].norm(), 0.0);
  EXPECT_GT(second->moved[Joint::kHead].y(), 0.04);
  EXPECT_GT(second->place[Joint::kHead].y(), first->place[Joint::kHead].y() + 0.03);
  EXPECT_EQ(second->Mirrored().moved[Joint::kHead].x(), -second->moved[Joint::kHead].x());
}

// The first stage moves the head by little or by more, and of the knees only the one on the side
// towards which the head moves; the second would move all three by 5 cm.
TEST(RefinementCascade, JointsSkippedByAStageStayUnrefined) {
  Scene scene;
  const auto moved_m = [&](float by_m, Joint joint) {
    RefinementCascade cascade = Silent();
    cascade.stages.resize(2, cascade.stages[0]);
    constexpr auto kStep = static_cast<float>(RefinementCascade::kOffsets.step_m);
    const size_t head = NetworkOf(Joint::kHead), knee = NetworkOf(Joint::kKneeLeft);
    cascade.stages[0][head].layers[1].bias[1] = by_m / kStep;
    Perceptron& knees = cascade.stages[0][knee];
    knees = ossa::test::SilentPerceptron({kStageFeatures, 1, 3});
    knees.layers[0].weight(3 * kSurfaceSamples + FirstCoordinate(Index(Joint::kHead)), 0) =
        1.0F;  // from the knee
    knees.layers[1].weight(0, 1) = 1.0F;
    for (const size_t k : {head, knee}) cascade.stages[1][k].layers[1].bias[1] = 0.05F / kStep;
    const auto joints_m = JointsOf(JointRefiner(cascade).Refine(scene.input));
    return joints_m ? ((*joints_m)[joint] - scene.input.proposed[joint]).norm() : -1.0;
  };
  EXPECT_NEAR(moved_m(0.004F, Joint::kHead), 0.004, 1e-4);
  EXPECT_NEAR(moved_m(0.02F, Joint::kHead), 0.07, 1e-3);
  EXPECT_EQ(moved_m(0.02F, Joint::kSpine), 0.0);
  // The head is to the right (+x) of both knees, in the mirror to the left: rectified to nought.
  scene.input.proposed[Joint::kHead].x() += 0.5;
  EXPECT_GT(moved_m(0.0F, Joint::kKneeLeft), 0.05);
  EXPECT_EQ(moved_m(0.0F, Joint::kKneeRight), 0.0);
  scene.input.proposed[Joint::kHead].x() -= 1.0;
  EXPECT_EQ(moved_m(0.0F, Joint::kKneeLeft), 0.0);
  EXPECT_GT(moved_m(0.0F, Joint::kKneeRight), 0.05);
}

TEST(RefinementCascade, BoundsTheMotionOfJoints) {
  Scene scene;
  RefinementCascade cascade = Silent();
  cascade.stages[0][NetworkOf(Joint::kSpine)].layers[1].bias =
      Eigen::Vector3f(300.0F, 0.0F, -400.0F);
  const auto joints_m = JointsOf(JointRefiner(cascade).Refine(scene.input));
  ASSERT_TRUE(joints_m);
  EXPECT_NEAR(((*joints_m)[Joint::kSpine] - scene.input.proposed[Joint::kSpine]).norm(),
              RefinementCascade::kOffsets.farthest_m, 1e-6);
}

// A square image of a sloping surface, turned about the camera's axis by quarters.
struct SquareScene : Scene {
  explicit SquareScene(int quarters) {
    constexpr int kSide = 120;
    frame.camera = depth::KinectV1Camera(kSide, kSide);
    frame.camera.fy = frame.camera.fx;
    frame.camera.cx = frame.camera.cy = (kSide - 1) / 2.0;
    frame.depth_mm.assign(kSide * kSide, 0);
    is_person.assign(frame.depth_mm.size(), 0);
    for (int v = 0; v < kSide; ++v) {
      for (int u = 0; u < kSide; ++u) {
        int column = u, row = v;
        for (int q = 0; q < quarters; ++q) column = kSide - 1 - std::exchange(row, column);
        const auto to = static_cast<size_t>(row * kSide + column);
        frame.depth_mm[to] = static_cast<uint16_t>(1900 + u + 2 * v);
        is_person[to] = u < 80 ? 1 : 0;
      }
    }
    input.is_person = is_person;
  }
};

// Scene, and everything in it turned about the camera's axis; `floor` below the feet.
void TurnAboutTheAxis(double angle_rad, Scene* scene) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  for (auto& joint_m : scene->input.proposed.position_m) joint_m = turn * joint_m;
  const Eigen::Vector3d up = Eigen::Vector3d(0.1, 0.6, -0.8).normalized();
  scene->input.floor.emplace();
  *scene->input.floor << turn * up, 2.5;
}

TEST(RefinementCascade, FromAboveIsInvariantUnderRotationInTheImage) {
  Scene scene;
  TurnAboutTheAxis(0.0, &scene);
  const auto first = ProposedPerson::Locate(scene.input);
  Scene turned;
  TurnAboutTheAxis(2.0, &turned);
  const auto second = ProposedPerson::Locate(turned.input);
  ASSERT_TRUE(first && second);
  EXPECT_NEAR(first->frame_from_camera.determinant(), 1.0, 1e-9);
  for (size_t j = 0; j < kJointCount; ++j) {
    EXPECT_LT((first->place.position_m[j] - second->place.position_m[j]).norm(), 1e-9) << j;
  }
  EXPECT_LT((first->where_m - second->where_m).norm(), 1e-9);
  // From the left side of the body to the right one, as far as the ray lets it.
  const Eigen::Vector3d across = first->place[Joint::kHipRight] - first->place[Joint::kHipLeft];
  EXPECT_GT(across.x(), 0.05);
  EXPECT_NEAR(across.y(), 0.0, 1e-9);
}

TEST(RefinementCascade, FromAboveSamplesTheSameSurfaceOfATurnedImage) {
  SquareScene scene(0), turned(1);
  TurnAboutTheAxis(0.0, &scene);
  TurnAboutTheAxis(std::numbers::pi / 2, &turned);
  const auto first = SampledPerson::Sample(scene.input),
             second = SampledPerson::Sample(turned.input);
  ASSERT_TRUE(first && second);
  for (const Joint joint : {Joint::kHead, Joint::kHandLeft, Joint::kKneeRight}) {
    const Eigen::RowVectorXf off =
        ComputeStageFeatures(*first, joint) - ComputeStageFeatures(*second, joint);
    // Only where a sample falls between two pixels may the other one be read.
    EXPECT_LT((off.array().abs() > 2e-3F).count(), kStageFeatures / 50) << Index(joint);
  }
  scene.input.floor.reset();
  const Eigen::RowVectorXf level =
      ComputeStageFeatures(*SampledPerson::Sample(scene.input), Joint::kHead);
  EXPECT_GT((level - ComputeStageFeatures(*second, Joint::kHead)).norm(), 0.5F);
}

// Shoulders and hips aligned with the ray: the axes stay level.
TEST(RefinementCascade, FromAboveWithoutHeadingKeepsLevelAxes) {
  Scene scene;
  TurnAboutTheAxis(0.0, &scene);
  for (const Joint joint :
       {Joint::kShoulderLeft, Joint::kShoulderRight, Joint::kHipLeft, Joint::kHipRight}) {
    scene.input.proposed[joint] = {0.0, 0.0, kWall_m + 0.1 * static_cast<double>(Index(joint))};
  }
  const auto person = ProposedPerson::Locate(scene.input);
  scene.input.floor.reset();
  const auto level = ProposedPerson::Locate(scene.input);
  ASSERT_TRUE(person && level);
  EXPECT_TRUE(person->frame_from_camera.isApprox(level->frame_from_camera));
}

TEST(RefinementCascade, FromAboveUsesTheHeightAboveTheFloor) {
  Scene scene;
  TurnAboutTheAxis(1.0, &scene);
  const auto person = ProposedPerson::Locate(scene.input);
  ASSERT_TRUE(person);
  const Eigen::Vector3d on_floor_m =
      person->middle_m + person->frame_from_camera.transpose() * person->where_m;
  EXPECT_NEAR(scene.input.floor->head<3>().dot(on_floor_m) + (*scene.input.floor)[3], 0.0, 1e-9);
  const ProposedPerson mirrored = person->Mirrored();
  EXPECT_TRUE(mirrored.where_m.isApprox(Eigen::Vector3d(-1, 1, 1).cwiseProduct(person->where_m)));
}

TEST(RefinementCascade, FromAboveNeedsAFloorAndALevelCascadeIgnoresIt) {
  Scene scene;
  RefinementCascade cascade = Silent();
  cascade.stages[0][NetworkOf(Joint::kHead)].layers[1].bias = Eigen::Vector3f(0.5F, 0.0F, 0.0F);
  const auto level_m = JointsOf(JointRefiner(cascade).Refine(scene.input));
  TurnAboutTheAxis(0.0, &scene);
  EXPECT_EQ(JointsOf(JointRefiner(cascade).Refine(scene.input))->position_m, level_m->position_m);

  cascade.from_above = true;
  TurnAboutTheAxis(1.5, &scene);
  const JointRefiner refiner(cascade);
  EXPECT_TRUE(refiner.from_above());
  const auto turned_m = JointsOf(refiner.Refine(scene.input));
  ASSERT_TRUE(turned_m);
  // Along the body's own axis, not the camera's.
  const Eigen::Vector3d moved_m = (*turned_m)[Joint::kHead] - scene.input.proposed[Joint::kHead];
  const Eigen::Vector3d across_m =
      scene.input.proposed[Joint::kHipRight] - scene.input.proposed[Joint::kHipLeft];
  EXPECT_GT(moved_m.normalized().dot(across_m.normalized()), 0.95);
  scene.input.floor.reset();
  EXPECT_FALSE(refiner.Refine(scene.input));
}

TEST(RefinementCascade, LeavesJointsWithoutSurface) {
  const RefinementCascade cascade = Silent();
  const auto spoiled = [&](void (*spoil)(Scene&)) {
    Scene scene;
    EXPECT_TRUE(JointRefiner(cascade).Refine(scene.input));
    spoil(scene);
    return !JointRefiner(cascade).Refine(scene.input);
  };
  EXPECT_TRUE(spoiled([](Scene& s) { s.input.depth = nullptr; }));
  EXPECT_TRUE(spoiled([](Scene& s) { s.input.is_person = s.input.is_person.first(5); }));
  EXPECT_TRUE(spoiled([](Scene& s) { s.frame.depth_mm.pop_back(); }));
  EXPECT_TRUE(spoiled([](Scene& s) { s.input.proposed[Joint::kHead].x() = std::nan(""); }));
  EXPECT_TRUE(spoiled([](Scene& s) { s.input.proposed[Joint::kHead].y() = 1e300; }));
  EXPECT_TRUE(spoiled([](Scene& s) { s.input.confidence[3] = std::nan(""); }));
  RefinementCascade from_above = cascade;
  from_above.from_above = true;
  Scene without_floor;
  without_floor.input.floor = Eigen::Vector4d(0.0, 0.0, -1.0, std::nan(""));
  EXPECT_FALSE(JointRefiner(from_above).Refine(without_floor.input));
  EXPECT_TRUE(spoiled([](Scene& s) {
    for (auto& p_m : s.input.proposed.position_m) p_m.z() = -2.0;
  }));
}

}  // namespace
}  // namespace ossa::recon
