#include "recon/look/close_look.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>

#include "depth/error.h"
#include "depth/file/sealed_file.h"
#include "recon/body/standard_body.h"
#include "recon/look/bone_measure.h"
#include "recon/normalise.h"
#include "tests/support/temporary_folder.h"

namespace ossa::recon {
namespace {

constexpr int kWidth = 160, kHeight = 120;
constexpr double kWall_m = 2.0;
constexpr int kCentre = (kLookGrid / 2) * (kLookGrid + 1);  // of the finer grid

// Somebody two metres away whose surface is a wall that fills the image, all joints 5 cm within.
struct Scene {
  depth::DepthFrame frame;
  std::vector<uint8_t> is_person;
  LookInput input;

  Scene() {
    frame.camera = depth::KinectV1Camera(kWidth, kHeight);
    frame.depth_mm.assign(kWidth * kHeight, static_cast<uint16_t>(1000 * kWall_m));
    is_person.assign(frame.depth_mm.size(), 1);
    const Posture standing = StandardPosture(RigPose{});
    for (size_t j = 0; j < kJointCount; ++j) {
      const Eigen::Vector3d& p_m = standing.position_m[j];
      input.proposed.position_m[j] = {0.5 * p_m.x(), 0.5 * p_m.y(), kWall_m + 0.05};
    }
    input.confidence.fill(0.8);
    input.seen.fill(true);
    input.depth = &frame;
    input.is_person = is_person;
  }
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;
};

CloseLook Silent() {
  CloseLook look;
  look.people = 7;
  for (RectifiedNetwork& network : look.glances.emplace_back()) {
    network.input_mean = Eigen::VectorXf::Zero(kLookInputs);
    network.input_scale = Eigen::VectorXf::Ones(kLookInputs);
    network.layers = {{Eigen::MatrixXf::Zero(2, kLookInputs), Eigen::VectorXf::Zero(2)},
                      {Eigen::MatrixXf::Zero(3, 2), Eigen::VectorXf::Zero(3)}};
  }
  return look;
}

std::optional<Posture> JointsOf(const std::optional<Looked>& looked) {
  return looked ? std::optional(looked->joints_m) : std::nullopt;
}

size_t NetworkOf(Joint joint) {
  return static_cast<size_t>(std::find(kLookJoints.begin(), kLookJoints.end(), joint) -
                             kLookJoints.begin());
}

// Of random weights, as files have them.
RectifiedNetwork RandomNetwork(int hidden, Eigen::Index units, Eigen::Index inputs,
                               Eigen::Index outputs = 3) {
  RectifiedNetwork network;
  network.input_mean = Eigen::VectorXf::Random(inputs);
  network.input_scale = 3.0F * Eigen::VectorXf::Random(inputs).cwiseAbs();
  for (int l = 0; l < hidden; ++l, inputs = units) {
    network.layers.push_back(
        {Eigen::MatrixXf::Random(units, inputs), Eigen::VectorXf::Random(units)});
  }
  network.layers.push_back(
      {Eigen::MatrixXf::Random(outputs, inputs), Eigen::VectorXf::Random(outputs)});
  for (RectifiedNetwork::Layer& layer : network.layers) {
    layer.weight = BytesOf(layer.weight).Weights();
  }
  return network;
}

TEST(CloseLook, SeesHowFarBehindTheJointSurfaceLies) {
  Scene scene;
  const auto seen = LookDescription::Of(scene.input);
  ASSERT_TRUE(seen);
  for (size_t j = 0; j < kJointCount; ++j) {
    const double along = scene.input.proposed.position_m[j].norm() / (kWall_m + 0.05);
    EXPECT_NEAR(seen->behind_mm[j][kCentre], -50.0 * along, 2.0) << j;
  }
  // Straight ahead the coarser grid reaches as far up as it should: the ray is level there.
  EXPECT_NEAR((seen->frame_from_camera * Eigen::Vector3d::UnitY()).y(), 1.0, 0.1);
}

TEST(CloseLook, TellsWhatIsBesideAndWhatIsHidden) {
  Scene scene;
  const auto centre = [&] {
    return LookDescription::Of(scene.input)->behind_mm[Index(Joint::kHead)][kCentre];
  };
  std::fill(scene.is_person.begin(), scene.is_person.end(), uint8_t{0});
  const auto all = [&](double depth_m) {
    std::fill(scene.frame.depth_mm.begin(), scene.frame.depth_mm.end(),
              static_cast<uint16_t>(1000 * depth_m));
  };
  EXPECT_EQ(centre(), LookDescription::kHidden);  // a wall just before the head, not the person's
  all(kWall_m + 1.0);
  EXPECT_EQ(centre(), LookDescription::kBeside);
  all(0.0);  // no reading
  EXPECT_EQ(centre(), LookDescription::kBeside);
  all(kWall_m - 1.0);
  EXPECT_EQ(centre(), LookDescription::kHidden);
  scene.input.proposed[Joint::kHead].x() = 50.0;  // outside the image
  all(kWall_m + 1.0);
  EXPECT_EQ(centre(), LookDescription::kHidden);
}

TEST(CloseLook, OfTheMirrorImageIsTheMirrorImage) {
  Scene scene;
  scene.frame.camera.cx = (kWidth - 1) / 2.0;
  scene.input.proposed[Joint::kHandLeft] += Eigen::Vector3d(0.1, 0.3, -0.2);
  scene.input.confidence[Index(Joint::kKneeRight)] = 0.1;
  scene.input.seen[Index(Joint::kFootLeft)] = false;
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      const auto i = static_cast<size_t>(v * kWidth + u);
      scene.frame.depth_mm[i] = static_cast<uint16_t>(1900 + u + 2 * v);
      scene.is_person[i] = u < 100 ? 1 : 0;
    }
  }
  Scene mirror;
  mirror.frame.camera = scene.frame.camera;
  for (size_t j = 0; j < kJointCount; ++j) {
    const auto other = static_cast<size_t>(kMirroredJoint[j]);
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
  const LookDescription expected = *LookDescription::Of(mirror.input);
  const LookDescription got = LookDescription::Of(scene.input)->Mirrored();
  EXPECT_TRUE(got.middle_m.isApprox(expected.middle_m));
  EXPECT_TRUE(got.frame_from_camera.isApprox(expected.frame_from_camera));
  int different = 0;
  for (size_t j = 0; j < kJointCount; ++j) {
    EXPECT_LT((got.place.position_m[j] - expected.place.position_m[j]).norm(), 1e-9) << j;
    EXPECT_EQ(got.confidence[j], expected.confidence[j]) << j;
    EXPECT_EQ(got.seen[j], expected.seen[j]) << j;
    for (size_t s = 0; s < kLookSamples; ++s) {
      different += std::abs(got.behind_mm[j][s] - expected.behind_mm[j][s]) > 1 ? 1 : 0;
    }
  }
  // Only where a sample falls between two pixels may the other one be read.
  EXPECT_LT(different, kJointCount * kLookSamples / 100);
  EXPECT_TRUE(NumbersOf(got, Joint::kHead).allFinite());
}

TEST(CloseLook, MovesEachJointByItsNetworkAndTheOtherSideInTheMirror) {
  Scene scene;
  CloseLook look = Silent();
  look.glances[0][NetworkOf(Joint::kHead)].layers[1].bias = Eigen::Vector3f(0.0F, 0.5F, 0.0F);
  look.glances[0][NetworkOf(Joint::kKneeLeft)].layers[1].bias = Eigen::Vector3f(0.4F, 0.0F, 0.0F);
  const auto joints_m = JointsOf(Looker(look).Look(scene.input));
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

TEST(CloseLook, EachGlanceBeginsWhereTheOneBeforeItEnded) {
  Scene scene;
  CloseLook look = Silent();
  look.glances[0][NetworkOf(Joint::kHead)].layers[1].bias = Eigen::Vector3f(0.0F, 0.5F, 0.0F);
  const auto once_m = JointsOf(Looker(look).Look(scene.input));
  ASSERT_TRUE(once_m);
  // The second says that the head is back where it was proposed, which it knows as it moved.
  look.glances.push_back(Silent().glances[0]);
  RectifiedNetwork& head = look.glances[1][NetworkOf(Joint::kHead)];
  constexpr int kMoved = 3 * kLookSamples + 3 * kJointCount;  // of the inputs: moves so far
  head.layers = {{Eigen::MatrixXf::Zero(3, kLookInputs), Eigen::VectorXf::Zero(3)}};
  for (int axis = 0; axis < 3; ++axis) {
    head.layers[0].weight(axis, kMoved + 3 * Index(Joint::kHead) + axis) =
        -1.0F / static_cast<float>(CloseLook::kStep_m);
  }
  const auto twice_m = JointsOf(Looker(look).Look(scene.input));
  ASSERT_TRUE(twice_m);
  EXPECT_GT(((*once_m)[Joint::kHead] - scene.input.proposed[Joint::kHead]).norm(), 0.04);
  // Its weights are bytes: a part in five hundred.
  EXPECT_NEAR(((*twice_m)[Joint::kHead] - scene.input.proposed[Joint::kHead]).norm(), 0.0, 1e-4);

  const LookInput moved = scene.input.MovedTo(*once_m);
  const auto first = LookDescription::Of(scene.input), second = LookDescription::Of(moved);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->moved[Joint::kHead].norm(), 0.0);
  EXPECT_GT(second->moved[Joint::kHead].y(), 0.04);
  EXPECT_GT(second->place[Joint::kHead].y(), first->place[Joint::kHead].y() + 0.03);
  EXPECT_EQ(second->Mirrored().moved[Joint::kHead].x(), -second->moved[Joint::kHead].x());
}

// The second glance moves the head by a little or by more, and of the knees the one on the side to
// which the head is put; the third would move all three by 5 cm.
TEST(CloseLook, JointsThatTheSecondGlanceLeavesAreNotLookedAtAgain) {
  Scene scene;
  const auto moved_m = [&](float by_m, Joint joint) {
    CloseLook look = Silent();
    look.glances.resize(3, look.glances[0]);
    constexpr auto kStep = static_cast<float>(CloseLook::kStep_m);
    const size_t head = NetworkOf(Joint::kHead), knee = NetworkOf(Joint::kKneeLeft);
    look.glances[1][head].layers[1].bias[1] = by_m / kStep;
    RectifiedNetwork& knees = look.glances[1][knee];
    knees.layers = {{Eigen::MatrixXf::Zero(1, kLookInputs), Eigen::VectorXf::Zero(1)},
                    {Eigen::MatrixXf::Zero(3, 1), Eigen::VectorXf::Zero(3)}};
    knees.layers[0].weight(0, 3 * kLookSamples + 3 * Index(Joint::kHead)) = 1.0F;  // from the knee
    knees.layers[1].weight(1, 0) = 1.0F;
    for (const size_t k : {head, knee}) look.glances[2][k].layers[1].bias[1] = 0.05F / kStep;
    const auto joints_m = JointsOf(Looker(look).Look(scene.input));
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

TEST(CloseLook, MovesNoJointFarAway) {
  Scene scene;
  CloseLook look = Silent();
  look.glances[0][NetworkOf(Joint::kSpine)].layers[1].bias = Eigen::Vector3f(300.0F, 0.0F, -400.0F);
  const auto joints_m = JointsOf(Looker(look).Look(scene.input));
  ASSERT_TRUE(joints_m);
  EXPECT_NEAR(((*joints_m)[Joint::kSpine] - scene.input.proposed[Joint::kSpine]).norm(),
              CloseLook::kFarthest_m, 1e-6);
}

TEST(CloseLook, HasNothingToSayOfWhatCannotBeLookedAt) {
  const CloseLook look = Silent();
  const auto spoiled = [&](void (*spoil)(Scene&)) {
    Scene scene;
    EXPECT_TRUE(Looker(look).Look(scene.input));
    spoil(scene);
    return !Looker(look).Look(scene.input);
  };
  EXPECT_TRUE(spoiled([](Scene& s) { s.input.depth = nullptr; }));
  EXPECT_TRUE(spoiled([](Scene& s) { s.input.is_person = s.input.is_person.first(5); }));
  EXPECT_TRUE(spoiled([](Scene& s) { s.frame.depth_mm.pop_back(); }));
  EXPECT_TRUE(spoiled([](Scene& s) { s.input.proposed[Joint::kHead].x() = std::nan(""); }));
  EXPECT_TRUE(spoiled([](Scene& s) { s.input.proposed[Joint::kHead].y() = 1e300; }));
  EXPECT_TRUE(spoiled([](Scene& s) { s.input.confidence[3] = std::nan(""); }));
  EXPECT_TRUE(spoiled([](Scene& s) {
    for (auto& p_m : s.input.proposed.position_m) p_m.z() = -2.0;
  }));
}

TEST(BoneMeasure, ReadsThePersonAndSaysLogarithmsOverTheStandardBones) {
  Scene scene;
  scene.input.proposed[Joint::kFootRight] = scene.input.proposed[Joint::kAnkleRight];  // no length
  const auto person = ProposedPerson::Of(scene.input);
  ASSERT_TRUE(person);
  EXPECT_TRUE(BoneNumbersOf(*person).allFinite());
  BoneLengths lengths_m = StandardBoneLengths();
  EXPECT_LT(BoneOutputsOf(lengths_m).norm(), 1e-6F);
  const auto shin = static_cast<size_t>(Index(Joint::kAnkleLeft));
  lengths_m[shin] *= 1.2;  // of the left one only: half of it for the pair
  const Eigen::VectorXf outputs = BoneOutputsOf(lengths_m);
  EXPECT_NEAR(outputs.cwiseAbs().maxCoeff(), std::log(1.1) / kBoneStep, 1e-4);
  EXPECT_NEAR(outputs.cwiseAbs().sum(), std::log(1.1) / kBoneStep, 1e-4);
}

// A network that adds up where the left hand and the right one are, sideways: nothing in the mean
// of a person and the mirror image, but for what the bias says.
TEST(BoneMeasure, IsTheMeanOfThePersonAndTheMirrorImage) {
  Scene scene;
  scene.input.proposed[Joint::kHandLeft].x() += 0.4;
  CloseLook look = Silent();
  EXPECT_FALSE(Looker(look).Look(scene.input)->bones_m);
  constexpr auto kBones = static_cast<Eigen::Index>(kMeasuredBones.size());
  look.bones.input_mean = Eigen::VectorXf::Zero(kBoneInputs);
  look.bones.input_scale = Eigen::VectorXf::Ones(kBoneInputs);
  look.bones.layers = {{Eigen::MatrixXf::Zero(kBones, kBoneInputs), Eigen::VectorXf::Zero(kBones)}};
  look.bones.layers[0].bias[0] = 1.0F;
  look.bones.layers[0].bias[1] = 1000.0F;
  for (const Joint hand : {Joint::kHandLeft, Joint::kHandRight}) {
    look.bones.layers[0].weight.col(3 * Index(hand)).setConstant(1.0F);
  }
  const auto looked = Looker(look).Look(scene.input);
  ASSERT_TRUE(looked && looked->bones_m);
  const auto over = [&](Joint joint) {
    const auto j = static_cast<size_t>(Index(joint));
    return (*looked->bones_m)[j] / StandardBoneLengths()[j];
  };
  EXPECT_NEAR(over(Joint::kSpine), std::exp(kBoneStep), 1e-4);
  EXPECT_NEAR(over(Joint::kShoulderCenter), std::exp(1.0), 1e-4);  // no giants
  EXPECT_NEAR(over(Joint::kKneeLeft), 1.0, 1e-4);
  EXPECT_EQ(over(Joint::kKneeLeft), over(Joint::kKneeRight));
}

// A look that says nothing but of the bones, all standard, and then once more, told of them.
CloseLook SilentAndTold() {
  CloseLook look = Silent();
  constexpr auto kBones = static_cast<Eigen::Index>(kMeasuredBones.size());
  look.bones.input_mean = Eigen::VectorXf::Zero(kBoneInputs);
  look.bones.input_scale = Eigen::VectorXf::Ones(kBoneInputs);
  look.bones.layers = {{Eigen::MatrixXf::Zero(kBones, kBoneInputs), Eigen::VectorXf::Zero(kBones)}};
  look.measured = 3;
  for (RectifiedNetwork& network : look.told.emplace_back()) {
    network.input_mean = Eigen::VectorXf::Zero(kToldInputs);
    network.input_scale = Eigen::VectorXf::Ones(kToldInputs);
    network.layers = {{Eigen::MatrixXf::Zero(3, kToldInputs), Eigen::VectorXf::Zero(3)}};
  }
  return look;
}

// The head rises by a step for each step of the first bone, the spine; every glance before, and
// what is said of the bones, is of joints where the others put them.
TEST(CloseLook, GlancesAfterTheBonesAreToldOfThem) {
  Scene scene;
  CloseLook look = SilentAndTold();
  look.told[0][NetworkOf(Joint::kHead)].layers[0].weight(1, kLookInputs) = 1.0F;
  const auto rise_m = [&](const std::optional<BoneLengths>& bones_m) {
    scene.input.bones_m = bones_m;
    const auto looked = Looker(look).Look(scene.input);
    EXPECT_TRUE(looked && looked->bones_m);
    EXPECT_NEAR((*looked->bones_m)[Index(Joint::kFootLeft)],
                StandardBoneLengths()[Index(Joint::kFootLeft)], 1e-6);
    return (looked->joints_m[Joint::kHead] - scene.input.proposed[Joint::kHead]).norm();
  };
  BoneLengths tall_m = StandardBoneLengths();
  tall_m[Index(Joint::kSpine)] *= std::exp(2.0 * kBoneStep);
  EXPECT_NEAR(rise_m(tall_m), 2.0 * CloseLook::kStep_m, 1e-4);
  EXPECT_NEAR(rise_m(std::nullopt), 0.0, 1e-6);  // what is judged of this frame
  look.bones.layers[0].bias[0] = 1.0F;
  EXPECT_NEAR(rise_m(std::nullopt), CloseLook::kStep_m, 1e-4);
  for (const double odd_m : {0.0, -1.0, std::nan(""), 1e300}) {
    tall_m[Index(Joint::kHandRight)] = odd_m;
    EXPECT_NEAR(rise_m(tall_m), CloseLook::kStep_m, 1e-4) << odd_m;
  }
}

TEST(BoneMeasure, IsTheMeanOfAllFrames) {
  JudgedBones bones;
  BoneLengths lengths_m = StandardBoneLengths();
  bones.Add(lengths_m);
  EXPECT_EQ(bones.mean_m[1], lengths_m[1]);
  for (double& length_m : lengths_m) length_m *= 4.0;
  bones.Add(lengths_m);
  bones.Add(lengths_m);
  EXPECT_EQ(bones.frames, 3);
  EXPECT_NEAR(bones.mean_m[1], 3.0 * StandardBoneLengths()[1], 1e-12);
}

TEST(CloseLook, IsKeptInAFile) {
  const test::TemporaryFolder folder;
  CloseLook look = Silent();
  look.glances[0][2].layers[0].weight(1, 5) = 0.5F;
  look.Save(folder / "a.ossalook");
  EXPECT_TRUE(CloseLook::IsOne(folder / "a.ossalook"));
  const CloseLook read = CloseLook::Load(folder / "a.ossalook");
  EXPECT_EQ(read.people, 7U);
  EXPECT_NEAR(read.glances[0][2].layers[0].weight(1, 5), 0.5F, 0.5F / 500.0F);
  read.Save(folder / "b.ossalook");
  const auto bytes = [&](const char* name) {
    std::ifstream in(folder / name, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  EXPECT_EQ(bytes("a.ossalook"), bytes("b.ossalook"));
  std::ofstream(folder / "short.ossalook", std::ios::binary) << bytes("a.ossalook").substr(0, 1000);
  EXPECT_THROW(CloseLook::Load(folder / "short.ossalook"), InputError);

  EXPECT_TRUE(read.bones.empty());
  look.bones = RandomNetwork(2, 6, kBoneInputs, kMeasuredBones.size());
  look.measured = 9;
  look.Save(folder / "bones.ossalook");
  const CloseLook bones = CloseLook::Load(folder / "bones.ossalook");
  EXPECT_EQ(bones.measured, 9U);
  const Eigen::VectorXf some = Eigen::VectorXf::Random(kBoneInputs);
  EXPECT_LT((bones.bones.Run(some) - look.bones.Run(some)).norm(), 0.1F);

  look = SilentAndTold();
  look.told[0][4].layers[0].weight(2, kToldInputs - 1) = 1.0F;
  look.Save(folder / "told.ossalook");
  const CloseLook told = CloseLook::Load(folder / "told.ossalook");
  ASSERT_EQ(told.told.size(), 1U);
  EXPECT_NEAR(told.told[0][4].layers[0].weight(2, kToldInputs - 1), 1.0F, 1.0F / 500.0F);
}

TEST(CloseLook, OfTheVersionBeforeIsReadAndOlderOnesAreRefused) {
  const test::TemporaryFolder folder;
  CloseLook look = SilentAndTold();
  look.told.clear();
  look.Save(folder / "now.ossalook");
  SealedFormat format = {{'O', 'S', 'S', 'A', 'L', 'K', '0', '0'}, CloseLook::kVersion, "look"};
  std::vector<std::byte> payload = ReadSealedFile(folder / "now.ossalook", format);
  payload.resize(payload.size() - sizeof(uint32_t));  // how many glances are told
  format.version = CloseLook::kOldestVersion;
  WriteSealedFile(folder / "before.ossalook", format, payload);
  const CloseLook before = CloseLook::Load(folder / "before.ossalook");
  EXPECT_EQ(before.measured, 3U);
  EXPECT_TRUE(before.told.empty());
  before.Save(folder / "again.ossalook");
  EXPECT_NO_THROW(CloseLook::Load(folder / "again.ossalook"));
  format.version = CloseLook::kOldestVersion - 1;
  WriteSealedFile(folder / "older.ossalook", format, payload);
  EXPECT_THROW(CloseLook::Load(folder / "older.ossalook"), InputError);
}

TEST(CloseLook, WithOddNumbersIsRefused) {
  const test::TemporaryFolder folder;
  const auto refused_look = [&](const CloseLook& look, const char* field) {
    look.Save(folder / "odd.ossalook");
    try {
      CloseLook::Load(folder / "odd.ossalook");
      ADD_FAILURE() << field;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(field), std::string::npos) << error.what();
    }
  };
  const auto refused = [&](void (*spoil)(RectifiedNetwork&), const char* field) {
    CloseLook look = Silent();
    spoil(look.glances[0][4]);
    refused_look(look, field);
  };
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  refused([](RectifiedNetwork& n) { n.input_mean[5] = std::nanf(""); }, "input means");
  refused([](RectifiedNetwork& n) { n.input_scale.conservativeResize(3); }, "input scales");
  refused([](RectifiedNetwork& n) { n.layers[0].weight(0, 5) = kInfinity; }, "unit weights");
  refused([](RectifiedNetwork& n) { n.layers[0].bias.setZero(1 << 15); }, "units");
  refused([](RectifiedNetwork& n) { n.layers[1].weight.setZero(4, 2); }, "output weights");
  refused([](RectifiedNetwork& n) { n.layers.resize(9, n.layers[1]); }, "layers");
  CloseLook look = Silent();
  look.measured = 1;
  look.bones = RandomNetwork(1, 4, kBoneInputs, 3);
  refused_look(look, "output weights");
  look.bones = RandomNetwork(1, 4, kBoneInputs - 1, kMeasuredBones.size());
  refused_look(look, "input means");

  for (const size_t glances : {size_t{0}, CloseLook::kMostGlances + 1}) {
    look = Silent();
    look.glances.resize(glances, Silent().glances[0]);
    refused_look(look, "glances");
  }
  look = SilentAndTold();
  look.told.resize(CloseLook::kMostGlances + 1, look.told[0]);
  refused_look(look, "told glances");
  look = SilentAndTold();
  look.told[0][1].input_mean = Eigen::VectorXf::Zero(kLookInputs);
  refused_look(look, "input means");
}

TEST(NetworkRunner, SaysWhatTheNetworkSays) {
  std::srand(7);  // Eigen draws from it
  for (const int hidden : {0, 1, 2}) {
    const RectifiedNetwork network = RandomNetwork(hidden, hidden == 1 ? 7 : 103, 11);
    Eigen::MatrixXf some = 4.0F * Eigen::MatrixXf::Random(11, 3);
    some.col(0).head(6).setZero();
    some.col(1).setZero();
    const Eigen::MatrixXf said = NetworkRunner(network).Run(some);
    ASSERT_EQ(said.cols(), 3);
    for (Eigen::Index c = 0; c < 3; ++c) {
      EXPECT_LT((said.col(c) - network.Run(some.col(c))).norm(), 1e-3F) << hidden;
    }
  }
}

// 103 and 130 units: more than a line of the cache holds, and than two.
TEST(NetworkRunner, NetworksWhoseWeightsLieTogetherSayWhatEachSaysAlone) {
  std::srand(8);
  const std::vector<RectifiedNetwork> networks = {RandomNetwork(2, 103, 40), RandomNetwork(0, 1, 5),
                                                  RandomNetwork(1, 130, 40)};
  const auto runners = NetworkRunner::Of({&networks[0], &networks[1], &networks[2]});
  ASSERT_EQ(runners.size(), networks.size());
  for (size_t n = 0; n < networks.size(); ++n) {
    const Eigen::VectorXf some = Eigen::VectorXf::Random(networks[n].input_mean.size());
    const Eigen::VectorXf said = runners[n].Run(some);
    EXPECT_LT((said - networks[n].Run(some)).norm(), 1e-3F) << n;
    EXPECT_EQ(said, NetworkRunner(networks[n]).Run(some).col(0)) << n;
  }
}

TEST(WeightBytes, AreTheSameOfWeightsThatWereBytesOnce) {
  std::srand(3);
  Eigen::MatrixXf weight = Eigen::MatrixXf::Random(40, 30);
  weight.col(4) *= 1e-3F;
  weight.col(5).setZero();
  const WeightBytes once = BytesOf(weight), twice = BytesOf(once.Weights());
  EXPECT_EQ(once.of, twice.of);
  EXPECT_EQ(once.step, twice.step);
  EXPECT_EQ(once.of.col(4).cwiseAbs().maxCoeff(), 127);
  for (Eigen::Index i = 0; i < weight.cols(); ++i) {
    const float error = (once.Weights().col(i) - weight.col(i)).cwiseAbs().maxCoeff();
    EXPECT_LE(error, 0.51F * once.step[i]) << i;
  }
}

TEST(RectifiedNetwork, RectifiesEveryLayerButTheLast) {
  RectifiedNetwork network;
  network.input_mean = Eigen::VectorXf::Constant(1, 1.0F);
  network.input_scale = Eigen::VectorXf::Constant(1, 2.0F);
  Eigen::MatrixXf both(2, 1), sum(1, 2), minus(1, 1);
  both << 1.0F, -1.0F;
  sum << 1.0F, -3.0F;
  minus << -1.0F;
  network.layers = {{both, Eigen::VectorXf::Zero(2)},
                    {sum, Eigen::VectorXf::Constant(1, 0.5F)},
                    {minus, Eigen::VectorXf::Zero(1)}};
  const auto said = [&](float x) { return network.Run(Eigen::VectorXf::Constant(1, x))[0]; };
  EXPECT_FLOAT_EQ(said(2.0F), -2.5F);  // 2 -> (2, 0) -> 2.5 -> -2.5
  EXPECT_FLOAT_EQ(said(0.0F), 0.0F);   // -2 -> (0, 2) -> rectified
  EXPECT_FLOAT_EQ(said(1e6F), -5.5F);  // no more than five standard deviations are believed
}

}  // namespace
}  // namespace ossa::recon
