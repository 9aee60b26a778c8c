#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "recon/body/body_model.h"

namespace ossa::recon {

/// What a person wears, as layers over the skin. Lengths are thicknesses along the normal, metres.
struct Clothing {
  double shirt_m = 0.006;      // over the torso
  double sleeve_m = 0.006;     // over the arms, as far as the sleeves reach
  double sleeve_end = 0.5;     // 0 shoulder, 1 elbow, 2 wrist
  double trouser_m = 0.006;    // over hips and legs
  double trouser_end = 1.9;    // 0 hip, 1 knee, 2 ankle
  double shoe_m = 0.008;       // over the feet
  double wrinkle = 0.4;        // of a layer's thickness, waves 8-25 cm long
  double hair_m = 0.01;        // over the skull
  double long_hair_end = 0.0;  // length of hanging hair: 0 none, 1 to the middle of the back
  double skirt_end = 0.0;      // 0 none, 1 to the knee, 1.5 at most
  double skirt_flare = 0.0;    // widening of the hem, share of its width
  double hang = 0.0;           // 0: the shirt fits; 1: it hangs straight down from chest and back
  double fold_m = 0.0;         // depth of the folds of hanging cloth, at its hem
  double hood_m = 0.0;         // a hood's distance from skull, hair and neck; 0: none
  double glove_m = 0.0;        // over hands and wrists; 0: none
  uint64_t pattern = 1;        // seed of the wrinkles
};

/// Dresses bodies of one model. The location of each vertex on the body is computed once.
class Wardrobe {
 public:
  explicit Wardrobe(const BodyModel& model);

  /// The body's rest vertices displaced outwards by clothing. Same triangles as the model.
  std::vector<Eigen::Vector3f> Dress(const ShapedBody& body, const Clothing& clothing) const;

  /// Shrinks layers that are not worn (skirt, long hair) to a point. Call it after skinning, with a
  /// point inside the posed body.
  void HideUnworn(const Clothing& clothing, const Eigen::Vector3f& inside_m,
                  std::span<Eigen::Vector3f> posed_m) const;

 private:
  enum class Region : uint8_t {
    kNone,
    kTorso,
    kArm,
    kLeg,
    kFoot,
    kHand,
    kSkull,
    kNeck,
    kSkirt,
    kLongHair
  };
  struct Place {
    Region region = Region::kNone;
    float along = 0;           // arms, legs: 0, 1, 2 at the three joints; torso: 1 at hip height
    bool before_face = false;  // long hair in front of the face
  };
  /// Thickness of the clothing at a place on the skin; 0: none.
  static double ThicknessAt_m(const Place& place, const Clothing& clothing);
  void LetHang(const ShapedBody& body, const Clothing& clothing,
               std::vector<Eigen::Vector3f>* dressed_m) const;

  std::vector<Place> place_;
};

}  // namespace ossa::recon
