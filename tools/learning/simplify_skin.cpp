#include "tools/learning/simplify_skin.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <map>

namespace ossa::tools {

SimplifiedSkin SimplifySkin(const recon::BodyModel& model, size_t triangles) {
  constexpr float kMostError =
      0.05F;  // share of the body's extent, by hand: the number ends it before
  std::vector<unsigned> corners;
  const auto is_skin = [&](uint32_t vertex) {
    return model.vertex_layer()[vertex] == recon::BodyLayer::kSkin;
  };
  for (const auto& triangle : model.triangles()) {
    if (!std::all_of(triangle.begin(), triangle.end(), is_skin)) continue;
    corners.insert(corners.end(), triangle.begin(), triangle.end());
  }
  const auto body = model.Shape({});
  std::vector<unsigned> few(corners.size());
  few.resize(meshopt_simplify(few.data(), corners.data(), corners.size(), body.rest_m[0].data(),
                              body.rest_m.size(), sizeof(Eigen::Vector3f), 3 * triangles,
                              kMostError));
  SimplifiedSkin skin;
  std::map<unsigned, uint32_t> number;
  for (const unsigned corner : few) {
    const auto [known, is_new] =
        number.emplace(corner, static_cast<uint32_t>(skin.vertices.size()));
    if (is_new) skin.vertices.push_back(corner);
  }
  for (size_t i = 0; i + 2 < few.size(); i += 3) {
    skin.triangles.push_back({number[few[i]], number[few[i + 1]], number[few[i + 2]]});
  }
  return skin;
}

}  // namespace ossa::tools
