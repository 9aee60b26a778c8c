#include "tools/synth/sample_person.h"

#include <algorithm>
#include <cmath>

namespace ossa::tools {
namespace {

bool IsTestShape(const recon::BodyShape& shape) {
  const auto cell = [](double value, double size) {
    return static_cast<uint64_t>(std::floor(value / size));
  };
  const uint64_t key =
      (cell(shape.muscle, 0.1) * 64 + cell(shape.weight, 0.1)) * 64 + cell(shape.height, 0.04);
  return Random(key, 0).Index(5) == 0;
}

recon::BodyShape DrawShape(Random& random) {
  const auto within = [&](double mean, double sigma, double low, double high) {
    return std::clamp(random.Normal(mean, sigma), low, high);
  };
  recon::BodyShape shape;
  shape.male = std::clamp(random.Chance(0.5) ? random.Normal(0.9, 0.15) : random.Normal(0.1, 0.15),
                          0.0, 1.0);
  const double kind = random.Uniform(0, 1);
  shape.age = kind < 1.0 / 6   ? random.Uniform(0.1875, 0.42)
              : kind < 5.0 / 6 ? random.Uniform(0.42, 0.65)
                               : random.Uniform(0.65, 1.0);
  shape.muscle = within(0.5, 0.2, 0.05, 0.95);
  shape.weight = within(0.5, 0.22, 0.05, 1.0);
  shape.height = within(0.5, 0.07, 0.33, 0.67);
  shape.proportions = random.Uniform(0.25, 1.0);
  const double a = -std::log(1.0 - random.Uniform(0, 1));  // three shares, uniformly distributed
  const double b = -std::log(1.0 - random.Uniform(0, 1));
  const double c = -std::log(1.0 - random.Uniform(0, 1));
  shape.african = a / (a + b + c);
  shape.asian = b / (a + b + c);
  shape.caucasian = 1.0 - shape.african - shape.asian;
  return shape;
}

recon::BodyShape DrawAnyShape(Random& random) {
  recon::BodyShape shape = DrawShape(random);
  if (!random.Chance(1.0 / 3)) return shape;
  shape.weight = random.Chance(0.5) ? random.Uniform(0.0, 0.15) : random.Uniform(0.85, 1.0);
  shape.height = random.Chance(0.5) ? random.Uniform(0.2, 0.38) : random.Uniform(0.6, 0.8);
  shape.muscle = random.Unit();
  return shape;
}

}  // namespace

recon::BodyShape SampleShape(Split split, Random& random) {
  recon::BodyShape shape = DrawShape(random);
  while (IsTestShape(shape) != (split == Split::kTest)) shape = DrawShape(random);
  return shape;
}

recon::BodyShape SampleAnyShape(Split split, Random& random) {
  recon::BodyShape shape = DrawAnyShape(random);
  while (IsTestShape(shape) != (split == Split::kTest)) shape = DrawAnyShape(random);
  return shape;
}

recon::Clothing SampleClothing(Random& random) {
  recon::Clothing wear;
  // Tight, ordinary or loose: the distance from the skin has the largest effect on depth.
  const auto thickness_m = [&] {
    const double kind = random.Uniform(0, 1);
    return kind < 0.3   ? random.Uniform(0.001, 0.005)
           : kind < 0.8 ? random.Uniform(0.005, 0.016)
                        : random.Uniform(0.016, 0.035);
  };
  wear.shirt_m = thickness_m();
  wear.sleeve_m = std::min(random.Uniform(0.6, 1.3) * wear.shirt_m, 0.03);
  const double sleeves = random.Uniform(0, 1);
  wear.sleeve_end = sleeves < 0.15  ? 0.0
                    : sleeves < 0.5 ? random.Uniform(0.4, 0.9)
                    : sleeves < 0.6 ? random.Uniform(0.9, 1.6)
                                    : random.Uniform(1.75, 2.0);
  wear.trouser_m = thickness_m();
  wear.trouser_end = random.Chance(0.3) ? random.Uniform(0.4, 1.2) : random.Uniform(1.7, 2.0);
  wear.shoe_m = random.Chance(0.15) ? 0.0 : random.Uniform(0.004, 0.014);
  wear.wrinkle = random.Uniform(0.1, 0.8);
  wear.hair_m = random.Chance(0.15)  ? 0.0
                : random.Chance(0.8) ? random.Uniform(0.004, 0.03)
                                     : random.Uniform(0.03, 0.06);
  if (random.Chance(0.18)) wear.long_hair_end = random.Uniform(0.15, 1.0);
  if (random.Chance(0.1)) {
    wear.skirt_end = random.Uniform(0.4, 1.4);
    wear.skirt_flare = random.Uniform(0.0, 0.35);
  }
  wear.pattern = random.Bits();
  return wear;
}

recon::Clothing SampleHangingClothing(Random& random) {
  recon::Clothing wear = SampleClothing(random);
  if (random.Chance(0.5)) return wear;
  wear.hang = random.Uniform(0.85, 1.0);
  wear.fold_m = random.Uniform(0.003, 0.03);
  const double kind = random.Unit();
  if (kind < 0.5) {  // a T-shirt or a loose pullover
    wear.sleeve_end = random.Chance(0.6) ? random.Uniform(0.35, 0.8) : random.Uniform(1.7, 2.0);
    wear.sleeve_m = random.Uniform(0.008, 0.03);
  } else if (kind < 0.8) {  // a coat; below the hips it uses the skirt layer
    wear.shirt_m = random.Uniform(0.015, 0.04);
    wear.sleeve_m = random.Uniform(0.012, 0.03);
    wear.sleeve_end = random.Uniform(1.8, 2.0);
    wear.skirt_end = random.Uniform(0.4, 1.5);
    wear.skirt_flare = random.Uniform(0.0, 0.25);
  } else {  // a skirt
    wear.skirt_end = random.Uniform(0.5, 1.5);
    wear.skirt_flare = random.Uniform(0.1, 0.5);
  }
  if (random.Chance(0.2)) wear.hood_m = random.Uniform(0.015, 0.05);
  if (random.Chance(0.25)) wear.long_hair_end = random.Uniform(0.3, 1.0);
  return wear;
}

double SampleGloves_m(Random& random) {
  constexpr double kShare = 0.12;                        // share of people who wear any; by hand
  constexpr double kThin_m = 0.002, kMittens_m = 0.013;  // thickness of gloves on sale; by hand
  return random.Chance(kShare) ? random.Uniform(kThin_m, kMittens_m) : 0.0;
}

}  // namespace ossa::tools
