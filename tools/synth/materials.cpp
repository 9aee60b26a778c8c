#include "tools/synth/materials.h"

#include <algorithm>
#include <array>

#include "depth/base/random.h"

namespace ossa::tools {
namespace {

// Constants: reflectances in infrared light, fractions, chosen by hand.

constexpr uint64_t kObjects = 1000;  // first random stream of objects, after those of people

/// Materials of a person.
enum Garment : size_t { kHair, kSkin, kShirt, kTrousers, kShoes, kGarmentCount };
using Materials = std::array<float, kGarmentCount>;

float Cloth(Random& random) {
  const bool dark = random.Chance(0.15);
  return static_cast<float>(dark ? random.Uniform(0.03, 0.1) : random.Uniform(0.2, 0.95));
}

Materials DrawMaterials(Random& random) {
  Materials materials{};
  materials[kHair] = static_cast<float>(random.Uniform(0.05, 0.5));
  materials[kSkin] = static_cast<float>(random.Uniform(0.5, 0.8));
  materials[kShirt] = Cloth(random);
  materials[kTrousers] = Cloth(random);
  materials[kShoes] = Cloth(random);
  return materials;
}

/// By part label (parts.h): heads, neck, trunk and arms, hands, legs, feet.
Garment GarmentOf(uint8_t part) {
  if (part <= 2) return kHair;
  if (part <= 5 || part == 16 || part == 17) return kSkin;
  if (part >= 30) return kShoes;
  if (part >= 20) return kTrousers;
  return kShirt;
}

}  // namespace

depth::Image<float> DrawReflectance(const depth::RenderedImage& seen, const recon::BodyModel& model,
                                    std::span<const int> meshes, uint64_t seed) {
  std::vector<Materials> people;
  for (size_t i = 0; i < meshes.size(); ++i) {
    Random random(seed, i);
    people.push_back(DrawMaterials(random));
  }
  depth::Image<float> reflectance(seen.mesh.width, seen.mesh.height);
  std::vector<float> objects;  // by mesh number
  for (size_t i = 0; i < seen.mesh.data.size(); ++i) {
    const int mesh = seen.mesh.data[i];
    if (mesh < 0) continue;
    const auto person = std::find(meshes.begin(), meshes.end(), mesh);
    if (person != meshes.end()) {
      const uint8_t part = model.triangle_part()[static_cast<size_t>(seen.triangle.data[i])];
      reflectance.data[i] = people[static_cast<size_t>(person - meshes.begin())][GarmentOf(part)];
      continue;
    }
    while (objects.size() <= static_cast<size_t>(mesh)) {
      Random random(seed, kObjects + objects.size());
      objects.push_back(Cloth(random));
    }
    reflectance.data[i] = objects[static_cast<size_t>(mesh)];
  }
  return reflectance;
}

}  // namespace ossa::tools
