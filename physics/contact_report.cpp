// Contact reports of a world.
#include <algorithm>
#include <utility>

#include "physics/world_internal.h"

namespace ossa::physics {

using Eigen::Vector3d;

Party PartyOf(dGeomID geom) {
  const int tag = TagOf(geom);
  if (tag == 0) return {};
  if (tag < 0) return {Party::Kind::kObject, -tag - 1, 0};
  const void* const bone = dBodyGetData(dGeomGetBody(geom));
  return {Party::Kind::kCharacter, tag - 1, static_cast<size_t>(reinterpret_cast<intptr_t>(bone))};
}

void World::Impl::Note(dGeomID a, dGeomID b, double depth_m) {
  const auto deepen = [depth_m](double& deepest_m) { deepest_m = std::max(deepest_m, depth_m); };
  Party first = PartyOf(a), second = PartyOf(b);
  if (second.kind == Party::Kind::kCharacter) std::swap(first, second);
  if (first.kind != Party::Kind::kCharacter) {
    deepen(contacts.object_depth_m);
  } else if (second.kind == Party::Kind::kCharacter) {
    deepen(first.id == second.id ? contacts.self_depth_m : contacts.character_depth_m);
  } else if (second.kind == Party::Kind::kFloor) {
    deepen(contacts.floor_depth_m);
  } else {
    deepen(contacts.character_object_depth_m);
    ++contacts.character_object_contacts;
    contacts.struck.push_back({first.id, first.bone, second.id});
  }
}

/// Collects the impulse of each contact joint of this substep.
void World::Impl::GatherImpulses(double h_s) {
  const auto key_of = [](const Party& party) {
    const int kind = static_cast<int>(party.kind);
    return std::pair(kind == 0 ? 0 : (kind == 1 ? party.id + 1 : -party.id - 1),
                     static_cast<int>(party.bone));
  };
  std::map<std::array<int, 4>, bool> renewed;
  for (const Pressing& pressed : pressing) {
    const Vector3d impulse_ns = h_s * ToEigen(pressed.feedback.f1);
    if (!(impulse_ns.squaredNorm() > 0.0) || !impulse_ns.allFinite()) continue;
    const auto [tag_a, bone_a] = key_of(pressed.a);
    const auto [tag_b, bone_b] = key_of(pressed.b);
    const std::array<int, 4> key = {tag_a, bone_a, tag_b, bone_b};
    Contact& contact = touching[key];
    contact.a = pressed.a;
    contact.b = pressed.b;
    if (!std::exchange(renewed[key], true)) contact.points.clear();
    contact.points.push_back({pressed.position_m, pressed.normal, pressed.depth_m, impulse_ns});
    contact.impulse_ns += impulse_ns;
  }
}

}  // namespace ossa::physics
