#include "recon/motion/humanoid.h"

namespace ossa::recon {

const std::array<HumanBoneInfo, kHumanBoneCount> kHumanBones = {{
    {"Hips", "hips", "Hips", -1, Joint::kHipCenter, Joint::kHipCenter},
    {"Spine", "spine", "Spine", 0, Joint::kHipCenter, Joint::kSpine},
    {"Chest", "chest", "Spine1", 1, Joint::kSpine, Joint::kShoulderCenter},
    {"Neck", "neck", "Neck", 2, Joint::kShoulderCenter, Joint::kHead},
    {"Head", "head", "Head", 3, Joint::kHead, Joint::kHead},
    {"LeftShoulder", "leftShoulder", "LeftShoulder", 2, Joint::kShoulderCenter,
     Joint::kShoulderLeft},
    {"LeftUpperArm", "leftUpperArm", "LeftArm", 5, Joint::kShoulderLeft, Joint::kElbowLeft},
    {"LeftLowerArm", "leftLowerArm", "LeftForeArm", 6, Joint::kElbowLeft, Joint::kWristLeft},
    {"LeftHand", "leftHand", "LeftHand", 7, Joint::kWristLeft, Joint::kHandLeft},
    {"RightShoulder", "rightShoulder", "RightShoulder", 2, Joint::kShoulderCenter,
     Joint::kShoulderRight},
    {"RightUpperArm", "rightUpperArm", "RightArm", 9, Joint::kShoulderRight, Joint::kElbowRight},
    {"RightLowerArm", "rightLowerArm", "RightForeArm", 10, Joint::kElbowRight, Joint::kWristRight},
    {"RightHand", "rightHand", "RightHand", 11, Joint::kWristRight, Joint::kHandRight},
    {"LeftUpperLeg", "leftUpperLeg", "LeftUpLeg", 0, Joint::kHipLeft, Joint::kKneeLeft},
    {"LeftLowerLeg", "leftLowerLeg", "LeftLeg", 13, Joint::kKneeLeft, Joint::kAnkleLeft},
    {"LeftFoot", "leftFoot", "LeftFoot", 14, Joint::kAnkleLeft, Joint::kFootLeft},
    {"LeftToes", "leftToes", "LeftToeBase", 15, Joint::kFootLeft, Joint::kFootLeft},
    {"RightUpperLeg", "rightUpperLeg", "RightUpLeg", 0, Joint::kHipRight, Joint::kKneeRight},
    {"RightLowerLeg", "rightLowerLeg", "RightLeg", 17, Joint::kKneeRight, Joint::kAnkleRight},
    {"RightFoot", "rightFoot", "RightFoot", 18, Joint::kAnkleRight, Joint::kFootRight},
    {"RightToes", "rightToes", "RightToeBase", 19, Joint::kFootRight, Joint::kFootRight},
}};

}  // namespace ossa::recon
