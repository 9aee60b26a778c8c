#include "tools/synth/interaction.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "depth/render/shapes.h"
#include "recon/body/standard_body.h"
#include "tools/synth/mobility_aids.h"
#include "tools/synth/pose_bank.h"

namespace ossa::tools {
namespace {

// Constants: sizes of objects and reaches of arms, metres, chosen by hand; bone indices of the rig.

using Eigen::Affine3f;
using Eigen::Matrix3f;
using Eigen::Vector3d;
using Eigen::Vector3f;
using recon::Joint;

constexpr size_t kSpine1 = 13;
constexpr size_t kLeftArm[2] = {17, 24}, kRightArm[2] = {24, 31};  // collar to thumb: first, end

float Draw(Random& random, double low, double high) {
  return static_cast<float>(random.Uniform(low, high));
}

/// Makes the right arm nearly a mirror image of the left one.
void MirrorLeftArm(recon::RigPose* pose, Random& random) {
  const Eigen::Quaterniond trunk = pose->world_from_rest[kSpine1];
  const double x = random.Normal(0, 0.05), y = random.Normal(0, 0.05), z = random.Normal(0, 0.05);
  const Eigen::Quaterniond little = Eigen::Quaterniond(1, x, y, z).normalized();
  for (size_t b = kLeftArm[0]; b < kLeftArm[1]; ++b) {
    const Eigen::Quaterniond q = trunk.conjugate() * pose->world_from_rest[b];
    pose->world_from_rest[b + kRightArm[0] - kLeftArm[0]] =
        trunk * little * Eigen::Quaterniond(q.w(), q.x(), -q.y(), -q.z());
  }
}

/// Position of a joint of the standard body, relative to the base of the neck, in the chest's axes.
Vector3d InChest(const recon::RigPose& pose, const recon::Posture& posture, Joint joint) {
  return pose.world_from_rest[kSpine1].conjugate() *
         (posture[joint] - posture[Joint::kShoulderCenter]);
}

bool HasHandsInFront(const recon::RigPose& pose) {
  const Vector3d hand = InChest(pose, recon::StandardPosture(pose), Joint::kHandLeft);
  return hand.z() > 0.2 && hand.x() > 0.05 && hand.x() < 0.5 && hand.y() > -0.4 && hand.y() < 0.3;
}

bool IsForearmLevel(const recon::RigPose& pose) {
  const recon::Posture posture = recon::StandardPosture(pose);
  const Vector3d elbow = InChest(pose, posture, Joint::kElbowLeft);
  const Vector3d hand = InChest(pose, posture, Joint::kHandLeft);
  const double rise_m = posture[Joint::kHandLeft].y() - posture[Joint::kElbowLeft].y();
  return std::abs(rise_m) < 0.05 && hand.z() > elbow.z() + 0.1 && elbow.y() < -0.15 &&
         hand.x() < 0.5;
}

/// Axes in the world: from hand to hand, horizontal, to the person's left; up; to the front.
struct Before {
  Vector3f left, up, front;
};

Before ComputeFrontAxes(const recon::Posture& joints) {
  const Vector3f across =
      (joints[Joint::kShoulderLeft] - joints[Joint::kShoulderRight]).cast<float>();
  const Vector3f up = Vector3f::UnitY();
  const Vector3f left = (across - across.dot(up) * up).normalized();
  return {left, up, left.cross(up)};
}

Affine3f Frame(const Vector3f& x, const Vector3f& y, const Vector3f& z, const Vector3f& at_m) {
  Affine3f frame = Affine3f::Identity();
  frame.linear() << x, y, z;
  frame.translation() = at_m;
  return frame;
}

/// A sheet in the plane z = 0, from y = 0 downwards; each row has its own width, centred at x = 0.
depth::TriangleMesh Sheet(float width_m, float height_m, const std::vector<float>& row_width) {
  constexpr uint32_t kColumns = 24;
  depth::TriangleMesh mesh;
  const auto rows = static_cast<uint32_t>(row_width.size());
  for (uint32_t r = 0; r < rows; ++r) {
    for (uint32_t c = 0; c < kColumns; ++c) {
      const float x = static_cast<float>(c) / (kColumns - 1) - 0.5F;
      const float y = static_cast<float>(r) / static_cast<float>(rows - 1);
      mesh.vertices_m.emplace_back(x * width_m * row_width[r], -y * height_m, 0.0F);
    }
  }
  for (uint32_t r = 0; r + 1 < rows; ++r) {
    for (uint32_t c = 0; c + 1 < kColumns; ++c) {
      const uint32_t here = r * kColumns + c;
      mesh.triangles.push_back({here, here + kColumns, here + 1});
      mesh.triangles.push_back({here + 1, here + kColumns, here + kColumns + 1});
    }
  }
  return mesh;
}

/// Adds folds that grow downwards, and sagging between the hands.
void Fold(depth::TriangleMesh* mesh, float width_m, float height_m, Random& random) {
  const float folds = Draw(random, 1.0, 5.0), phase = Draw(random, 0.0, 6.3);
  const float deep_m = Draw(random, 0.005, 0.06), sag_m = Draw(random, 0.0, 0.12) * width_m;
  const float blown_m = Draw(random, -0.1, 0.1);
  for (Vector3f& p : mesh->vertices_m) {
    const float across = p.x() / width_m, down = -p.y() / height_m;
    p.z() +=
        deep_m * (0.2F + down) * std::sin(6.2832F * folds * across + phase + down) + blown_m * down;
    p.y() -= sag_m * (1.0F - 4.0F * across * across) * (1.0F - down);
  }
}

/// An object held up by its upper corners or its sides; x to the left, y up, its centre above or
/// between the hands.
depth::TriangleMesh SampleHeldUpObject(float span_m, Random& random) {
  constexpr size_t kRows = 20;
  const size_t kind = random.Index(5);
  std::vector<float> rows(kRows, 1.0F);
  if (kind < 2) {  // cloth, or a garment: shoulders with sleeves, then the trunk
    const float width_m = std::max(0.25F, span_m * Draw(random, 0.95, 1.3));
    const float height_m = Draw(random, 0.4, 1.1);
    const float trunk = Draw(random, 0.5, 0.75);
    for (size_t r = 0; kind == 1 && r < kRows; ++r) rows[r] = r < kRows / 3 ? 1.0F : trunk;
    depth::TriangleMesh cloth = Sheet(width_m, height_m, rows);
    Fold(&cloth, width_m, height_m, random);
    return depth::Moved(cloth, Affine3f(Eigen::Translation3f(0, 0.03F, 0)));
  }
  if (kind == 2) {  // a board, as wide as the hands or wider
    const float width_m = std::max(0.25F, span_m * Draw(random, 1.0, 1.6));
    const float height_m = Draw(random, 0.25, 0.9);
    const float raised_m = Draw(random, -0.3, 0.3) * height_m;
    return depth::Moved(depth::MakeBox({width_m, height_m, Draw(random, 0.004, 0.03)}),
                        Affine3f(Eigen::Translation3f(0, raised_m, 0)));
  }
  if (kind == 3) {  // paper, a book, a tablet; bent a little
    const float width_m = Draw(random, 0.15, 0.45), height_m = width_m * Draw(random, 0.7, 1.4);
    depth::TriangleMesh paper = Sheet(width_m, height_m, rows);
    const float bent = Draw(random, -1.5, 1.5);
    for (Vector3f& p : paper.vertices_m) p.z() += bent * p.x() * p.x();
    return depth::Moved(paper, Affine3f(Eigen::Translation3f(0, 0.5F * height_m, 0)));
  }
  const float width_m = std::clamp(span_m, 0.12F, 0.8F), height_m = Draw(random, 0.1, 0.6);
  const float deep_m = Draw(random, 0.08, 0.4);
  return depth::MakeBox({width_m, height_m, deep_m});
}

void AddHeldUp(const recon::Posture& joints, Random& random, std::vector<Prop>* props) {
  const Vector3f left_m = joints[Joint::kHandLeft].cast<float>();
  const Vector3f right_m = joints[Joint::kHandRight].cast<float>();
  const Before before = ComputeFrontAxes(joints);
  const Vector3f across = left_m - right_m;
  const float span_m = across.norm();
  const Vector3f x = span_m > 0.05F ? Vector3f(across / span_m) : before.left;
  // Upright, or tilted like paper that is read.
  const float lean = Draw(random, -0.35, 0.35);
  const Vector3f wish = (before.up - lean * before.front).normalized();
  const Vector3f y = (wish - wish.dot(x) * x).normalized();
  const float ahead_m = Draw(random, -0.02, 0.05);
  const Vector3f at_m = (left_m + right_m) / 2 + ahead_m * before.front;
  props->push_back({depth::Moved(SampleHeldUpObject(span_m, random), Frame(x, y, x.cross(y), at_m)),
                    true, Grip::kBothHands});
}

/// Objects on a desk: first a screen or a laptop, then small ones.
depth::TriangleMesh SampleDeskObject(size_t number, Random& random) {
  if (number == 0 && random.Chance(0.6)) {
    const float wide_m = Draw(random, 0.28, 0.6), high_m = wide_m * Draw(random, 0.55, 0.7);
    const float lean = Draw(random, 0.0, 0.45);
    return depth::Moved(depth::MakeBox({wide_m, high_m, 0.02F}),
                        Eigen::AngleAxisf(lean, Vector3f::UnitX()) *
                            Eigen::Translation3f(0, high_m / 2, 0) * Affine3f::Identity());
  }
  const float wide_m = Draw(random, 0.05, 0.3), high_m = Draw(random, 0.01, 0.2);
  return depth::Moved(depth::MakeBox({wide_m, high_m, Draw(random, 0.05, 0.25)}),
                      Affine3f(Eigen::Translation3f(0, high_m / 2, 0)));
}

/// Height of the surface under both forearms, metres.
float LevelUnderForearms_m(const recon::Posture& joints) {
  constexpr double kForearm_m = 0.045;  // from the wrist's centre to the skin and cloth below
  double low_m = 1e9;
  for (const Joint joint : {Joint::kElbowLeft, Joint::kWristLeft, Joint::kHandLeft,
                            Joint::kElbowRight, Joint::kWristRight, Joint::kHandRight}) {
    low_m = std::min(low_m, joints[joint].y());
  }
  return static_cast<float>(low_m - kForearm_m);
}

void AddDesk(const recon::Posture& joints, Random& random, std::vector<Prop>* props) {
  const Before before = ComputeFrontAxes(joints);
  const float level_m = LevelUnderForearms_m(joints);
  const float wide_m = Draw(random, 0.9, 2.0), deep_m = Draw(random, 0.5, 0.9);
  const Vector3f hips_m = joints[Joint::kHipCenter].cast<float>();
  const float belly_m = Draw(random, 0.14, 0.24);
  const float aside_m = Draw(random, -0.3, 0.3);
  Vector3f middle_m = hips_m + (belly_m + deep_m / 2) * before.front + aside_m * before.left;
  middle_m.y() = 0.0F;
  const bool counts = random.Chance(0.7);
  const auto put = [&](const depth::TriangleMesh& mesh, const Vector3f& at_m, float turn) {
    const Affine3f frame = Frame(before.left, before.up, before.front, at_m);
    const Eigen::AngleAxisf about(turn, Vector3f::UnitY());
    props->push_back({depth::Moved(mesh, frame * about), counts});
  };
  put(depth::MakeTable({wide_m, std::max(0.2F, level_m), deep_m}), middle_m, 0.0F);
  const size_t things = random.Index(4);
  for (size_t i = 0; i < things; ++i) {
    const float out_m = Draw(random, i == 0 ? 0.05 : -0.3, 0.45) * deep_m;
    const float along_m = Draw(random, -0.35, 0.35) * wide_m;
    Vector3f at_m = middle_m + out_m * before.front + along_m * before.left;
    at_m.y() = level_m;
    const float turn = Draw(random, -0.4, 0.4);
    put(SampleDeskObject(i, random), at_m, turn);
  }
}

/// Armrests and back of a chair, and their posts.
void AddArmrests(const recon::Posture& joints, Random& random, std::vector<Prop>* props) {
  const Before before = ComputeFrontAxes(joints);
  const Vector3f hips_m = joints[Joint::kHipCenter].cast<float>();
  const float level_m = std::max(0.2F, LevelUnderForearms_m(joints));
  const float thick_m = Draw(random, 0.03, 0.07), wide_m = Draw(random, 0.06, 0.12);
  const float long_m = Draw(random, 0.28, 0.45), back_m = Draw(random, 0.45, 0.8);
  const auto box = [&](const Vector3f& size_m, const Vector3f& at_m) {
    props->push_back(
        {depth::Moved(depth::MakeBox(size_m), Frame(before.left, before.up, before.front, at_m))});
  };
  for (const Joint elbow : {Joint::kElbowLeft, Joint::kElbowRight}) {
    Vector3f at_m = joints[elbow].cast<float>() + 0.4F * long_m * before.front;
    at_m.y() = level_m - thick_m / 2;
    box({wide_m, thick_m, long_m}, at_m);
    at_m.y() = (level_m - thick_m) / 2;
    box({0.04F, level_m - thick_m, 0.05F}, at_m);
  }
  Vector3f behind_m = hips_m - Draw(random, 0.16, 0.24) * before.front;
  behind_m.y() = std::max(0.0F, hips_m.y() - 0.1F) + back_m / 2;
  box({Draw(random, 0.4, 0.6), back_m, 0.06F}, behind_m);
}

bool AreArmsAt(Interaction interaction, const recon::RigPose& pose) {
  if (interaction == Interaction::kHeldUp) return HasHandsInFront(pose);
  if (interaction == Interaction::kCrutches) return HoldsCrutch(pose);
  return IsForearmLevel(pose);
}

}  // namespace

Interaction DrawInteraction(Occluders kind, Random& random) {
  if (kind == Occluders::kHeldUp) return Interaction::kHeldUp;
  if (kind == Occluders::kWheelchair) return Interaction::kWheelchair;
  if (kind == Occluders::kCrutches) return Interaction::kCrutches;
  const double draw = random.Unit();
  if (kind == Occluders::kDesk) return draw < 0.7 ? Interaction::kAtDesk : Interaction::kArmrests;
  if (kind != Occluders::kAll) return Interaction::kNone;
  return draw < 0.2    ? Interaction::kHeldUp
         : draw < 0.3  ? Interaction::kAtDesk
         : draw < 0.35 ? Interaction::kArmrests
         : draw < 0.38 ? Interaction::kWheelchair
         : draw < 0.41 ? Interaction::kCrutches
                       : Interaction::kNone;
}

Interaction ArrangeArms(Interaction interaction, recon::RigPose* pose, Random& random) {
  constexpr double kUpright = 0.85;  // cosine of the chest's lean
  constexpr int kMostTries = 200;    // draws of an arm; most need a tenth of them
  if (interaction == Interaction::kNone) return interaction;
  const Vector3d up = pose->world_from_rest[kSpine1] * Vector3d::UnitY();
  if (up.y() < kUpright) return Interaction::kNone;
  if (interaction == Interaction::kWheelchair) {
    constexpr double kArmsRest =
        0.5;  // share of wheelchair users with the arms on the armrests; by hand
    SitDown(pose, random);
    if (!random.Chance(kArmsRest)) return interaction;
  }
  recon::RigPose tried = *pose;
  for (int i = 0; i < kMostTries; ++i) {
    RandomArm(0, &tried, random);
    if (!AreArmsAt(interaction, tried)) continue;
    MirrorLeftArm(&tried, random);
    *pose = tried;
    return interaction;
  }
  return interaction == Interaction::kWheelchair ? interaction : Interaction::kNone;
}

std::vector<Prop> InteractionProps(Interaction interaction, const recon::Posture& joints_in_world,
                                   const Eigen::Isometry3d& camera_from_world, Random& random) {
  std::vector<Prop> props;
  if (interaction == Interaction::kHeldUp) AddHeldUp(joints_in_world, random, &props);
  if (interaction == Interaction::kAtDesk) AddDesk(joints_in_world, random, &props);
  if (interaction == Interaction::kArmrests) AddArmrests(joints_in_world, random, &props);
  if (interaction == Interaction::kWheelchair) props = SampleWheelchair(joints_in_world, random);
  if (interaction == Interaction::kCrutches) props = SampleCrutches(joints_in_world, random);
  const Affine3f move(camera_from_world.cast<float>().matrix());
  for (Prop& prop : props) prop.mesh_in_cam = depth::Moved(std::move(prop.mesh_in_cam), move);
  return props;
}

}  // namespace ossa::tools
