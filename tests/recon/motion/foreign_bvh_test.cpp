// BVH of any studio as skeletons: with their own size and positions, for arbitrary names and axes.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "recon/files/skeleton_io.h"
#include "tests/recon/motion/figure.h"
#include "tests/support/refused.h"
#include "tests/support/temporary_folder.h"

namespace ossa::recon {
namespace {

using test::FigureBvh;
using test::FigureNames;
using test::FigureStyle;

SkeletonSequence Read(const std::string& text, const SkeletonReadOptions& options = {}) {
  std::istringstream stream(text);
  return ReadSkeletonStream(stream, "x.bvh", options);
}

/// Joints are at the figure's positions. Six decimals of a unit and of a degree over 2 m.
void ExpectFigure(const SkeletonSequence& read, size_t body = 0, double size = 1.0) {
  constexpr double kPrinted_m = 2e-6;
  for (const size_t f : {size_t{0}, read.frames.size() / 2, read.frames.size() - 1}) {
    const auto places = test::FigurePlaces(f);
    for (const auto& [joint, number] : test::kFigureSdkJoints) {
      const auto& record = read.frames[f].bodies.at(body).joints[static_cast<size_t>(joint)];
      ASSERT_TRUE(record.has_value()) << kJointNames[static_cast<size_t>(joint)];
      EXPECT_LT((record->position_m - 0.01 * size * places[number]).norm(), kPrinted_m)
          << kJointNames[static_cast<size_t>(joint)] << " of frame " << f;
    }
  }
}

struct Studio {
  const char* name;
  FigureNames names;
};

void PrintTo(const Studio& studio, std::ostream* out) { *out << studio.name; }

const Studio kStudios[] = {
    {"MixamoColon", {"mixamorig:Hips",          "mixamorig:Spine",       "mixamorig:Spine1",
                     "mixamorig:Neck",          "mixamorig:Head",        "mixamorig:LeftShoulder",
                     "mixamorig:LeftArm",       "mixamorig:LeftForeArm", "mixamorig:LeftHand",
                     "mixamorig:RightShoulder", "mixamorig:RightArm",    "mixamorig:RightForeArm",
                     "mixamorig:RightHand",     "mixamorig:LeftUpLeg",   "mixamorig:LeftLeg",
                     "mixamorig:LeftFoot",      "mixamorig:LeftToeBase", "mixamorig:RightUpLeg",
                     "mixamorig:RightLeg",      "mixamorig:RightFoot",   "mixamorig:RightToeBase"}},
    {"MixamoUnderscoreNumbered",
     {"mixamorig1_Hips",          "mixamorig1_Spine",       "mixamorig1_Spine1",
      "mixamorig1_Neck",          "mixamorig1_Head",        "mixamorig1_LeftShoulder",
      "mixamorig1_LeftArm",       "mixamorig1_LeftForeArm", "mixamorig1_LeftHand",
      "mixamorig1_RightShoulder", "mixamorig1_RightArm",    "mixamorig1_RightForeArm",
      "mixamorig1_RightHand",     "mixamorig1_LeftUpLeg",   "mixamorig1_LeftLeg",
      "mixamorig1_LeftFoot",      "mixamorig1_LeftToeBase", "mixamorig1_RightUpLeg",
      "mixamorig1_RightLeg",      "mixamorig1_RightFoot",   "mixamorig1_RightToeBase"}},
    {"Biped", {"Bip01",        "Bip01 Spine",      "Bip01 Spine1",     "Bip01 Neck",
               "Bip01 Head",   "Bip01 L Clavicle", "Bip01 L UpperArm", "Bip01 L Forearm",
               "Bip01 L Hand", "Bip01 R Clavicle", "Bip01 R UpperArm", "Bip01 R Forearm",
               "Bip01 R Hand", "Bip01 L Thigh",    "Bip01 L Calf",     "Bip01 L Foot",
               "Bip01 L Toe0", "Bip01 R Thigh",    "Bip01 R Calf",     "Bip01 R Foot",
               "Bip01 R Toe0"}},
    {"Biped001", {"Bip001_Pelvis", "Bip001_Spine",      "Bip001_Spine1",     "Bip001_Neck",
                  "Bip001_Head",   "Bip001_L_Clavicle", "Bip001_L_UpperArm", "Bip001_L_Forearm",
                  "Bip001_L_Hand", "Bip001_R_Clavicle", "Bip001_R_UpperArm", "Bip001_R_Forearm",
                  "Bip001_R_Hand", "Bip001_L_Thigh",    "Bip001_L_Calf",     "Bip001_L_Foot",
                  "Bip001_L_Toe0", "Bip001_R_Thigh",    "Bip001_R_Calf",     "Bip001_R_Foot",
                  "Bip001_R_Toe0"}},
    {"Rigify",
     {"DEF-spine",       "DEF-spine.001",   "DEF-spine.003", "DEF-spine.004", "DEF-spine.006",
      "DEF-shoulder.L",  "DEF-upper_arm.L", "DEF-forearm.L", "DEF-hand.L",    "DEF-shoulder.R",
      "DEF-upper_arm.R", "DEF-forearm.R",   "DEF-hand.R",    "DEF-thigh.L",   "DEF-shin.L",
      "DEF-foot.L",      "DEF-toe.L",       "DEF-thigh.R",   "DEF-shin.R",    "DEF-foot.R",
      "DEF-toe.R"}},
    {"RigifyMetarig",
     {"spine",       "spine.001", "spine.003", "spine.004",  "spine.006",   "shoulder.L",
      "upper_arm.L", "forearm.L", "hand.L",    "shoulder.R", "upper_arm.R", "forearm.R",
      "hand.R",      "thigh.L",   "shin.L",    "foot.L",     "toe.L",       "thigh.R",
      "shin.R",      "foot.R",    "toe.R"}},
    {"BlenderOrg",
     {"ORG-hips",        "ORG-spine",       "ORG-chest",     "ORG-neck",    "ORG-head",
      "ORG-shoulder.L",  "ORG-upper_arm.L", "ORG-forearm.L", "ORG-hand.L",  "ORG-shoulder.R",
      "ORG-upper_arm.R", "ORG-forearm.R",   "ORG-hand.R",    "ORG-thigh.L", "ORG-shin.L",
      "ORG-foot.L",      "ORG-toe.L",       "ORG-thigh.R",   "ORG-shin.R",  "ORG-foot.R",
      "ORG-toe.R"}},
    {"Unity", {"Hips",          "Spine",         "Chest",         "Neck",          "Head",
               "LeftShoulder",  "LeftUpperArm",  "LeftLowerArm",  "LeftHand",      "RightShoulder",
               "RightUpperArm", "RightLowerArm", "RightHand",     "LeftUpperLeg",  "LeftLowerLeg",
               "LeftFoot",      "LeftToes",      "RightUpperLeg", "RightLowerLeg", "RightFoot",
               "RightToes"}},
    {"Vrm", {"J_Bip_C_Hips",    "J_Bip_C_Spine",    "J_Bip_C_Chest",    "J_Bip_C_Neck",
             "J_Bip_C_Head",    "J_Bip_L_Shoulder", "J_Bip_L_UpperArm", "J_Bip_L_LowerArm",
             "J_Bip_L_Hand",    "J_Bip_R_Shoulder", "J_Bip_R_UpperArm", "J_Bip_R_LowerArm",
             "J_Bip_R_Hand",    "J_Bip_L_UpperLeg", "J_Bip_L_LowerLeg", "J_Bip_L_Foot",
             "J_Bip_L_ToeBase", "J_Bip_R_UpperLeg", "J_Bip_R_LowerLeg", "J_Bip_R_Foot",
             "J_Bip_R_ToeBase"}},
    {"Rokoko", {"Hips",      "Spine1",      "Spine4",   "Neck",          "Head",     "LeftShoulder",
                "LeftArm",   "LeftForeArm", "LeftHand", "RightShoulder", "RightArm", "RightForeArm",
                "RightHand", "LeftThigh",   "LeftShin", "LeftFoot",      "LeftToe",  "RightThigh",
                "RightShin", "RightFoot",   "RightToe"}},
    {"BandaiNamco",
     {"Hips",       "Spine",  "Chest",      "Neck",       "Head",       "Shoulder_L", "UpperArm_L",
      "LowerArm_L", "Hand_L", "Shoulder_R", "UpperArm_R", "LowerArm_R", "Hand_R",     "UpperLeg_L",
      "LowerLeg_L", "Foot_L", "Toes_L",     "UpperLeg_R", "LowerLeg_R", "Foot_R",     "Toes_R"}},
    {"XsensSegments", {"Pelvis",
                       "L5",
                       "T8",
                       "Neck",
                       "Head",
                       "LeftShoulder",
                       "LeftUpperArm",
                       "LeftForeArm",
                       "LeftHand",
                       "RightShoulder",
                       "RightUpperArm",
                       "RightForeArm",
                       "RightHand",
                       "LeftUpperLeg",
                       "LeftLowerLeg",
                       "LeftFoot",
                       "LeftToe",
                       "RightUpperLeg",
                       "RightLowerLeg",
                       "RightFoot",
                       "RightToe"}},
    {"XsensMvn",
     {"Hips",         "Chest",      "Chest4",    "Neck",        "Head",          "LeftCollar",
      "LeftShoulder", "LeftElbow",  "LeftWrist", "RightCollar", "RightShoulder", "RightElbow",
      "RightWrist",   "LeftHip",    "LeftKnee",  "LeftAnkle",   "LeftToe",       "RightHip",
      "RightKnee",    "RightAnkle", "RightToe"}},
    {"PerceptionNeuron",
     {"Robot_Hips",      "Robot_Spine",         "Robot_Spine2",   "Robot_Neck",
      "Robot_Head",      "Robot_LeftShoulder",  "Robot_LeftArm",  "Robot_LeftForeArm",
      "Robot_LeftHand",  "Robot_RightShoulder", "Robot_RightArm", "Robot_RightForeArm",
      "Robot_RightHand", "Robot_LeftUpLeg",     "Robot_LeftLeg",  "Robot_LeftFoot",
      "Robot_LeftToe",   "Robot_RightUpLeg",    "Robot_RightLeg", "Robot_RightFoot",
      "Robot_RightToe"}},
    {"OptiTrack", {"Skeleton_Hip",   "Skeleton_Ab",        "Skeleton_Chest", "Skeleton_Neck",
                   "Skeleton_Head",  "Skeleton_LShoulder", "Skeleton_LUArm", "Skeleton_LFArm",
                   "Skeleton_LHand", "Skeleton_RShoulder", "Skeleton_RUArm", "Skeleton_RFArm",
                   "Skeleton_RHand", "Skeleton_LThigh",    "Skeleton_LShin", "Skeleton_LFoot",
                   "Skeleton_LToe",  "Skeleton_RThigh",    "Skeleton_RShin", "Skeleton_RFoot",
                   "Skeleton_RToe"}},
    {"Unreal", {"pelvis",     "spine_01",   "spine_03", "neck_01",    "head",       "clavicle_l",
                "upperarm_l", "lowerarm_l", "hand_l",   "clavicle_r", "upperarm_r", "lowerarm_r",
                "hand_r",     "thigh_l",    "calf_l",   "foot_l",     "ball_l",     "thigh_r",
                "calf_r",     "foot_r",     "ball_r"}},
    {"MakeHuman",
     {"root",         "spine05",      "spine01",      "neck01",     "head",         "clavicle.L",
      "upperarm01.L", "lowerarm01.L", "wrist.L",      "clavicle.R", "upperarm01.R", "lowerarm01.R",
      "wrist.R",      "upperleg01.L", "lowerleg01.L", "foot.L",     "toe1-1.L",     "upperleg01.R",
      "lowerleg01.R", "foot.R",       "toe1-1.R"}},
    {"DazGenesis",
     {"hip",        "abdomenLower", "chestUpper", "neckLower", "head",       "lCollar",
      "lShldrBend", "lForearmBend", "lHand",      "rCollar",   "rShldrBend", "rForearmBend",
      "rHand",      "lThighBend",   "lShin",      "lFoot",     "lToe",       "rThighBend",
      "rShin",      "rFoot",        "rToe"}},
    {"Smpl",
     {"pelvis",        "spine1",      "spine3",     "neck",         "head",           "left_collar",
      "left_shoulder", "left_elbow",  "left_wrist", "right_collar", "right_shoulder", "right_elbow",
      "right_wrist",   "left_hip",    "left_knee",  "left_ankle",   "left_foot",      "right_hip",
      "right_knee",    "right_ankle", "right_foot"}},
    {"SecondFigure",
     {"Hips_1",         "Spine_1",        "Spine1_1",      "Neck_1",      "Head_1",
      "LeftShoulder_1", "LeftArm_1",      "LeftForeArm_1", "LeftHand_1",  "RightShoulder_1",
      "RightArm_1",     "RightForeArm_1", "RightHand_1",   "LeftUpLeg_1", "LeftLeg_1",
      "LeftFoot_1",     "LeftToeBase_1",  "RightUpLeg_1",  "RightLeg_1",  "RightFoot_1",
      "RightToeBase_1"}}};

class NamesOfStudios : public testing::TestWithParam<Studio> {};

TEST_P(NamesOfStudios, AreKnown) {
  FigureStyle style;
  style.names = GetParam().names;
  const auto read = Read(FigureBvh(style));
  ASSERT_EQ(read.frames.size(), style.frames);
  ExpectFigure(read);
  EXPECT_TRUE(read.warnings.empty()) << read.warnings.front();
}

INSTANTIATE_TEST_SUITE_P(Of, NamesOfStudios, testing::ValuesIn(kStudios),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(ForeignBvh, ChildKeepsItsSize) {
  FigureStyle style;
  style.units_per_cm = 0.62;
  const auto read = Read(FigureBvh(style));
  ExpectFigure(read, 0, 0.62);
  EXPECT_TRUE(read.warnings.empty());
}

struct Unit {
  const char* word;
  double units_per_cm;
};

TEST(ForeignBvh, OtherUnitsAreConvertedWithAWarning) {
  for (const auto& [word, units_per_cm] :
       {Unit{"metres", 0.01}, Unit{"millimetres", 10.0}, Unit{"inches", 1 / 2.54},
        Unit{"the CMU's", 0.45 / 2.54}}) {
    FigureStyle style;
    style.units_per_cm = units_per_cm;
    const auto read = Read(FigureBvh(style));
    const double leg_m = (read.frames[0].bodies[0].joints[12]->position_m -
                          read.frames[0].bodies[0].joints[13]->position_m)
                             .norm();
    EXPECT_NEAR(leg_m, 0.43, 1e-4) << word;
    ASSERT_EQ(read.warnings.size(), 1u) << word;
    EXPECT_NE(read.warnings[0].find(word), std::string::npos) << read.warnings[0];
  }
}

TEST(ForeignBvh, ZeroAnglesWithoutAPoseKeepTheJointPositions) {
  FigureStyle style;
  style.bones_along_x = true;
  ExpectFigure(Read(FigureBvh(style)));
}

// The floor is where z is 0 and the figure stands along it.
TEST(ForeignBvh, ZUpIsConvertedWithAWarning) {
  FigureStyle style;
  style.file_from_world =
      Eigen::Quaterniond(Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitX()));
  const auto read = Read(FigureBvh(style));
  ExpectFigure(read);
  ASSERT_EQ(read.warnings.size(), 1u);
  EXPECT_NE(read.warnings[0].find("z is taken as up"), std::string::npos) << read.warnings[0];
}

TEST(ForeignBvh, HandsAndSpineMatchTheStandardBody) {
  const auto read = Read(FigureBvh());
  const auto& joints = read.frames[0].bodies[0].joints;
  const auto at = [&](Joint j) { return joints[Index(j)]->position_m; };
  const Eigen::Vector3d fore_arm = at(Joint::kWristLeft) - at(Joint::kElbowLeft);
  const Eigen::Vector3d hand = at(Joint::kHandLeft) - at(Joint::kWristLeft);
  EXPECT_LT(hand.normalized().cross(fore_arm.normalized()).norm(), 1e-5) << "straight on";
  EXPECT_GT(hand.norm(), 0.05);
  EXPECT_LT(hand.norm(), 0.12);
  EXPECT_GT(at(Joint::kSpine).y(), at(Joint::kHipCenter).y() + 0.1);
  EXPECT_LT(at(Joint::kSpine).y(), at(Joint::kShoulderCenter).y() - 0.2);
}

TEST(ForeignBvh, TwoRootsAreTwoBodies) {
  FigureStyle other;
  other.names = kStudios[19].names;
  std::string text = "HIERARCHY\n" + test::FigureHierarchy() + test::FigureHierarchy(other) +
                     "MOTION\nFrames: 2\nFrame Time: 0.1\n";
  for (size_t f = 0; f < 2; ++f) text += test::FigureRow(f) + " " + test::FigureRow(f) + "\n";
  const auto read = Read(text);
  ASSERT_EQ(read.frames.size(), 2u);
  ASSERT_EQ(read.frames[0].bodies.size(), 2u);
  EXPECT_EQ(read.frames[0].bodies[1].id, 2);
  ExpectFigure(read, 0);
  ExpectFigure(read, 1);
}

TEST(ForeignBvh, PropsAreIgnoredWithAWarning) {
  const std::string text = "HIERARCHY\nROOT sword {\nOFFSET 0 0 0\nCHANNELS 1 Xposition\n}\n" +
                           test::FigureHierarchy() + "MOTION\nFrames: 1\nFrame Time: 0.1\n7 " +
                           test::FigureRow(0) + "\n";
  const auto read = Read(text);
  ASSERT_EQ(read.frames[0].bodies.size(), 1u);
  ExpectFigure(read);
  ASSERT_EQ(read.warnings.size(), 1u);
  EXPECT_NE(read.warnings[0].find("'sword' is ignored"), std::string::npos);
}

TEST(ForeignBvh, UnknownNamesAreListed) {
  FigureStyle style;
  style.names[7] = "Ellbogen links";
  const std::string text = FigureBvh(style);
  ossa::test::ExpectRefused([&] { Read(text); }, "'Ellbogen links'");
  ossa::test::ExpectRefused([&] { Read(text); }, "no joint for LeftForeArm");
}

class MappedBvh : public testing::Test {
 protected:
  SkeletonSequence ReadWith(const std::string& mapping) {
    std::ofstream(folder_ / "names.txt") << mapping;
    FigureStyle style;
    style.names[7] = "Ellbogen links";
    SkeletonReadOptions options;
    options.mapping_file = folder_ / "names.txt";
    return Read(FigureBvh(style), options);
  }
  /// By the rig's bones and by the SDK's joints.
  const std::string rig_ =
      "Hips=Hips\nSpine = Spine\nNeck = Neck\nHead = Head\nLeftArm = LeftArm\n"
      "LeftForeArm = Ellbogen links\nLeftHand = LeftHand\nRightArm = RightArm\n"
      "RightForeArm = RightForeArm\nRightHand = RightHand\nLeftUpLeg = LeftUpLeg\n"
      "LeftLeg = LeftLeg\nLeftFoot = LeftFoot\nLeftToeBase = LeftToeBase\n"
      "RightUpLeg = RightUpLeg\nRightLeg = RightLeg\nRightFoot = RightFoot\n"
      "RightToeBase = RightToeBase\n";
  const std::string sdk_ =
      "HipCenter = Hips\nSpine = Spine\nShoulderCenter = Neck\nHead = Head\n"
      "ShoulderLeft = LeftArm\nElbowLeft = Ellbogen links\nWristLeft = LeftHand\n"
      "ShoulderRight = RightArm\nElbowRight = RightForeArm\nWristRight = RightHand\n"
      "HipLeft = LeftUpLeg\nKneeLeft = LeftLeg\nAnkleLeft = LeftFoot\nFootLeft = LeftToeBase\n"
      "HipRight = RightUpLeg\nKneeRight = RightLeg\nAnkleRight = RightFoot\n"
      "FootRight = RightToeBase # and no more\n";
  ossa::test::TemporaryFolder folder_;
};

TEST_F(MappedBvh, MapsBonesOrJoints) {
  ExpectFigure(ReadWith(rig_));
  ExpectFigure(ReadWith(sdk_));
}

TEST_F(MappedBvh, UnknownJointIsRefusedWithTheMappingsLine) {
  ossa::test::ExpectRefused([&] { ReadWith(rig_ + "LeftShoulder = Schulter\n"); },
                            "names.txt: line 19: expected a joint of x.bvh, found 'Schulter'");
  ossa::test::ExpectRefused([&] { ReadWith("Hips = Hips\nLeftElbow = x\n"); }, "names.txt: line 2");
  ossa::test::ExpectRefused([&] { ReadWith("Hips = Hips\nHips = Spine\n"); }, "each bone once");
  ossa::test::ExpectRefused([&] { ReadWith("Hips = Hips\n"); },
                            "names.txt: expected a line for Spine of x.bvh");
}

TEST_F(MappedBvh, UsesItsOwnNamesIfTheMappingHasNoneOfThem) {
  std::ofstream(folder_ / "names.txt") << "Hips = Huefte\n";
  SkeletonReadOptions options;
  options.mapping_file = folder_ / "names.txt";
  ExpectFigure(Read(FigureBvh(), options));
}

}  // namespace
}  // namespace ossa::recon
