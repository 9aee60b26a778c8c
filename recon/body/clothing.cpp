#include "recon/body/clothing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "depth/base/random.h"
#include "recon/body/parts.h"
#include "recon/body/standard_body.h"

namespace ossa::recon {
namespace {

// Label of the left part (parts.h); the right one is one more.
bool IsPart(uint8_t part, int left_label) { return part == left_label || part == left_label + 1; }

float ShareAlong(const Eigen::Vector3f& p, const Eigen::Vector3d& from_m,
                 const Eigen::Vector3d& to_m) {
  const Eigen::Vector3d way = to_m - from_m;
  return static_cast<float>((p.cast<double>() - from_m).dot(way) / way.squaredNorm());
}

// 0 at the first joint, 1 at the second, 2 at the third.
float AlongLimb(const Eigen::Vector3f& p, size_t first_bone) {
  const auto& head = StandardRigRest().head_m;
  const float lower = ShareAlong(p, head[first_bone + 1], head[first_bone + 2]);
  return lower > 0 ? 1.0f + lower : ShareAlong(p, head[first_bone], head[first_bone + 1]);
}

/// Smooth waves over the body, in [-1, 1]: folds of cloth, locks of hair.
class Waves {
 public:
  explicit Waves(uint64_t seed) {
    Random random(seed);
    const auto uniform = [&random] {
      return static_cast<float>(random.Bits() >> 40) * (1.0f / 16777216.0f);
    };
    for (auto& wave : waves_) {
      Eigen::Vector3f direction(uniform() - 0.5f, uniform() - 0.5f, uniform() - 0.5f);
      const float length_m = 0.08f + 0.17f * uniform();
      wave.vector = direction.normalized() * (2.0f * std::numbers::pi_v<float> / length_m);
      wave.phase = 2.0f * std::numbers::pi_v<float> * uniform();
    }
  }
  float At(const Eigen::Vector3f& p) const {
    float sum = 0;
    for (const auto& wave : waves_) sum += std::sin(wave.vector.dot(p) + wave.phase);
    return sum / static_cast<float>(waves_.size());
  }

 private:
  struct Wave {
    Eigen::Vector3f vector;
    float phase = 0;
  };
  std::array<Wave, 4> waves_;
};

// Constants: heights of the MPFB body, measured on its mesh; numbers of bones are the rig's.

// The neutral body's heights, metres over the soles.
constexpr float kSkullFrom_m = 1.50f;  // hair grows above, on the back of the head
constexpr float kFringe_m = 1.60f, kEars_m = 0.06f;
constexpr float kForehead_m = 1.60f;  // and above this also in front
constexpr float kWaist_m = 1.00f, kCrotch_m = 0.80f;
constexpr float kKnee_m = 0.475f;
constexpr uint8_t kNeckPart = 5;
constexpr float kCuff = 1.8f;          // where gloves begin, 2 the wrist
constexpr float kHiddenScale = 0.01f;  // scale of layers that are not worn; factor; by hand

constexpr float kNeutralHeight_m = 1.66f;
constexpr float kChest_m = 1.28f;  // cloth hangs freely below chest and shoulder blades

/// Azimuth around the body, radians. Double precision, because all processors round it alike.
float Around(const Eigen::Vector3f& p) {
  return static_cast<float>(std::atan2(static_cast<double>(p.x()), static_cast<double>(p.z())));
}

/// Folds run vertically and are deepest at the hem (`down` = 1).
Eigen::Vector3f ComputeFold(const Clothing& clothing, const Eigen::Vector3f& p, float down) {
  constexpr uint64_t kFewest = 5, kKinds = 9;  // number of folds around the body; by hand
  const auto count = static_cast<float>(kFewest + clothing.pattern % kKinds);
  const float phase = static_cast<float>(clothing.pattern >> 8 & 0xFFU) * 0.0245f;  // 0 to 2 pi
  const float wave = std::sin(count * Around(p) + phase + 3.0f * p.y());
  const Eigen::Vector3f out = Eigen::Vector3f(p.x(), 0, p.z()).normalized();
  return static_cast<float>(clothing.fold_m) * down * wave * out;
}

// `scale`: size relative to the neutral body.
void DrapeSkirt(const Clothing& clothing, const Waves& waves, float scale, Eigen::Vector3f* p) {
  const float hem_m =
      scale * (kCrotch_m - (kCrotch_m - kKnee_m) * static_cast<float>(clothing.skirt_end));
  p->y() = std::max(p->y(), hem_m);
  const float down = std::max(0.0f, scale * kWaist_m - p->y()) / (scale * 0.5f);
  const float widen =
      1.0f + static_cast<float>(clothing.skirt_flare) * down * (1.0f + 0.3f * waves.At(*p));
  p->x() *= widen;
  p->z() *= widen;
  if (clothing.fold_m > 0) *p += ComputeFold(clothing, *p, down);
}

// Strands in front of the face are cut to a fringe.
void CutHair(const Clothing& clothing, bool before_face, float scale, Eigen::Vector3f* p) {
  const float end_m = scale * (1.50f - 0.45f * static_cast<float>(clothing.long_hair_end));
  p->y() = std::max(p->y(), before_face ? scale * kFringe_m : end_m);
}

/// Radius of hanging cloth by height and direction: the radius of what it touches above, minus what
/// it falls back towards the body on the way down.
class Curtain {
 public:
  Curtain(float scale, float hang) : step_m_(scale * kTop_m / kRows), hang_(hang) {}

  void Touch(const Eigen::Vector3f& p) {
    float& reach_m = reach_m_[Row(p)][Column(p)];
    reach_m = std::max(reach_m, Radius(p));
  }
  void Fall() {
    constexpr float kFallsBack = 0.12f;  // share of the drop; by hand
    for (size_t row = kRows - 1; row-- > 0;) {
      for (size_t column = 0; column < kColumns; ++column) {
        // Cloth is stiff between neighbouring directions: mean of three.
        const auto& above = reach_m_[row + 1];
        const float mean_m = (above[(column + kColumns - 1) % kColumns] + above[column] +
                              above[(column + 1) % kColumns]) /
                             3.0f;
        const float hung_m = hang_ * (mean_m - kFallsBack * step_m_);
        reach_m_[row][column] = std::max(reach_m_[row][column], hung_m);
      }
    }
  }
  /// The point moved outwards onto the hanging cloth.
  Eigen::Vector3f Outside(const Eigen::Vector3f& p) const {
    const float radius_m = Radius(p);
    const float out = radius_m > 0 ? std::max(1.0f, reach_m_[Row(p)][Column(p)] / radius_m) : 1.0f;
    return {p.x() * out, p.y(), p.z() * out};
  }

 private:
  static constexpr float kTop_m = 1.5f;  // of the neutral body; by hand
  static constexpr size_t kRows = 60, kColumns = 40;

  static float Radius(const Eigen::Vector3f& p) { return std::hypot(p.x(), p.z()); }
  size_t Row(const Eigen::Vector3f& p) const {
    return static_cast<size_t>(std::clamp(p.y() / step_m_, 0.0f, kRows - 1.0f));
  }
  static size_t Column(const Eigen::Vector3f& p) {
    const float turns = Around(p) / (2.0f * std::numbers::pi_v<float>)+0.5f;
    return static_cast<size_t>(turns * kColumns) % kColumns;
  }

  float step_m_, hang_;
  std::array<std::array<float, kColumns>, kRows> reach_m_{};
};

}  // namespace

Wardrobe::Wardrobe(const BodyModel& model) {
  constexpr float kBaseFloor_m = -0.8168f;  // of base.obj
  constexpr size_t kLeftArm = 18, kRightArm = 25, kLeftUpLeg = 2, kRightUpLeg = 7;
  for (size_t i = 0; i < model.vertex_count(); ++i) {
    const Eigen::Vector3f p = model.base_m()[i] - Eigen::Vector3f(0, kBaseFloor_m, 0);
    const uint8_t part = model.vertex_part()[i];
    const bool left = p.x() >= 0;
    Place place;
    if (model.vertex_layer()[i] != BodyLayer::kSkin) {
      place.region =
          model.vertex_layer()[i] == BodyLayer::kSkirt ? Region::kSkirt : Region::kLongHair;
      place.before_face = p.z() > kEars_m;
    } else if (part <= 4) {
      const bool skull = p.y() > kForehead_m || (p.y() > kSkullFrom_m && p.z() < 0.05f);
      place.region = skull ? Region::kSkull : Region::kNone;
      place.along = std::min(1.0f, (p.y() - kSkullFrom_m) / 0.05f);  // thins out at the edge
    } else if (part == kNeckPart) {
      place.region = Region::kNeck;
    } else if (IsPart(part, 18) || IsPart(part, 20)) {
      place.region = Region::kTorso;
      place.along = (kWaist_m - p.y()) / (kWaist_m - kCrotch_m);
    } else if (IsPart(part, 6) || IsPart(part, 8) || IsPart(part, 10) || IsPart(part, 12) ||
               IsPart(part, 14)) {
      place.region = Region::kArm;
      place.along = AlongLimb(p, left ? kLeftArm : kRightArm);
    } else if (IsPart(part, 22) || IsPart(part, 24) || IsPart(part, 26) || IsPart(part, 28)) {
      place.region = Region::kLeg;
      place.along = AlongLimb(p, left ? kLeftUpLeg : kRightUpLeg);
    } else if (IsPart(part, 30)) {
      place.region = Region::kFoot;
    } else if (IsPart(part, 16)) {
      place.region = Region::kHand;
    }
    place_.push_back(place);
  }
}

double Wardrobe::ThicknessAt_m(const Place& place, const Clothing& clothing) {
  switch (place.region) {
    case Region::kTorso:
      // Shirt above the waist, trousers below, the thicker of both in between.
      return place.along < 0   ? clothing.shirt_m
             : place.along > 1 ? clothing.trouser_m
                               : std::max(clothing.shirt_m, clothing.trouser_m);
    case Region::kArm: {
      double thickness_m = place.along < clothing.sleeve_end ? clothing.sleeve_m : 0.0;
      if (place.along < 0.25f) thickness_m = std::max(thickness_m, clothing.shirt_m);
      if (place.along > kCuff) thickness_m = std::max(thickness_m, clothing.glove_m);
      return thickness_m;
    }
    case Region::kHand:
      return clothing.glove_m;
    case Region::kLeg:
      return place.along < clothing.trouser_end ? clothing.trouser_m : 0.0;
    case Region::kFoot:
      return clothing.shoe_m;
    case Region::kSkull:
      return std::max(clothing.hair_m * std::max(0.0f, place.along), clothing.hood_m);
    case Region::kNeck:
      return clothing.hood_m;
    case Region::kSkirt:
    case Region::kLongHair:
    case Region::kNone:
      break;
  }
  return 0.0;
}

std::vector<Eigen::Vector3f> Wardrobe::Dress(const ShapedBody& body,
                                             const Clothing& clothing) const {
  const Waves waves(clothing.pattern);
  const auto wrinkle = static_cast<float>(clothing.wrinkle);
  // Lengths of skirt and hair are measured on the neutral body and scale with this one.
  const auto scale = static_cast<float>(body.height_m / 1.66);  // double: data sets depend on it
  std::vector<Eigen::Vector3f> dressed = body.rest_m;
  for (size_t i = 0; i < dressed.size(); ++i) {
    const Place& place = place_[i];
    if (place.region == Region::kSkirt) {
      if (clothing.skirt_end > 0) DrapeSkirt(clothing, waves, scale, &dressed[i]);
      continue;
    }
    if (place.region == Region::kLongHair) {
      if (clothing.long_hair_end <= 0) continue;
      CutHair(clothing, place.before_face, scale, &dressed[i]);
      dressed[i] += 0.012f * waves.At(dressed[i]) * body.normals[i];
      continue;
    }
    const double thickness_m = ThicknessAt_m(place, clothing);
    if (thickness_m <= 0) continue;
    const float share = std::max(0.2f, 1.0f + wrinkle * waves.At(body.rest_m[i]));
    dressed[i] += static_cast<float>(thickness_m) * share * body.normals[i];
  }
  if (clothing.hang > 0) LetHang(body, clothing, &dressed);
  return dressed;
}

void Wardrobe::LetHang(const ShapedBody& body, const Clothing& clothing,
                       std::vector<Eigen::Vector3f>* dressed_m) const {
  const auto scale = static_cast<float>(body.height_m / kNeutralHeight_m);
  Curtain curtain(scale, static_cast<float>(clothing.hang));
  for (size_t i = 0; i < place_.size(); ++i) {
    if (place_[i].region == Region::kTorso) curtain.Touch((*dressed_m)[i]);
  }
  curtain.Fall();
  for (size_t i = 0; i < place_.size(); ++i) {
    if (place_[i].region != Region::kTorso || place_[i].along > 1) continue;
    Eigen::Vector3f& p = (*dressed_m)[i];
    const float down =
        std::clamp((scale * kChest_m - p.y()) / (scale * (kChest_m - kCrotch_m)), 0.0f, 1.0f);
    p = curtain.Outside(p) + ComputeFold(clothing, p, down);
  }
}

void Wardrobe::HideUnworn(const Clothing& clothing, const Eigen::Vector3f& inside_m,
                          std::span<Eigen::Vector3f> posed_m) const {
  for (size_t i = 0; i < posed_m.size(); ++i) {
    const Region region = place_[i].region;
    if ((region == Region::kSkirt && clothing.skirt_end <= 0) ||
        (region == Region::kLongHair && clothing.long_hair_end <= 0)) {
      // Not exactly one point: a mesh without extent aborts Embree's two-level builder.
      posed_m[i] = inside_m + kHiddenScale * (posed_m[i] - inside_m);
    }
  }
}

}  // namespace ossa::recon
