#include <algorithm>
#include <array>

#include "physics/world_internal.h"

namespace ossa::physics {
namespace {

// Contacts are implicit springs, stable at any stiffness. Between a body and the floor: a leg
// pressed down with the largest control force (2 kg x 250 m/s^2) sinks 2.5 mm. Damping is critical
// for 2 kg.
constexpr double kFloorStiffness_n_m = 1e6;
constexpr double kFloorDamping_ns_m = 3000.0;
// With and among things, for about one kilogram.
constexpr double kContactStiffness_n_m = 4e4;
constexpr double kContactDamping_ns_m = 400.0;
/// Own limbs are softer: the target rules, the capsules only keep it from the absurd.
constexpr double kSelfStiffness_n_m = 3e3;
constexpr double kSelfDamping_ns_m = 60.0;

}  // namespace

void World::Impl::Note(dGeomID a, dGeomID b, double depth_m) {
  const int ta = TagOf(a), tb = TagOf(b);
  if (ta > 0 && tb > 0) return;
  if (ta <= 0 && tb <= 0) {
    contacts.object_depth_m = std::max(contacts.object_depth_m, depth_m);
    return;
  }
  const int character = std::max(ta, tb);
  if (std::min(ta, tb) == 0) {
    contacts.floor_depth_m = std::max(contacts.floor_depth_m, depth_m);
    return;
  }
  contacts.character_object_depth_m = std::max(contacts.character_object_depth_m, depth_m);
  ++contacts.character_object_contacts;
  const dGeomID limb = ta > 0 ? a : b;
  const Actor& actor = *actors[static_cast<size_t>(character - 1)];
  for (size_t bone = 1; bone < recon::kJointCount; ++bone) {
    if (actor.character.geom(bone) == limb) contacts.struck.emplace_back(character - 1, bone);
  }
}

void World::Impl::CollidePair(dGeomID a, dGeomID b) {
  constexpr int kMaxContacts = 6;
  std::array<dContact, kMaxContacts> contact{};
  const int count = dCollide(a, b, kMaxContacts, &contact[0].geom, sizeof(dContact));
  if (count == 0) return;
  const int ta = TagOf(a), tb = TagOf(b);
  const bool self = ta == tb && ta > 0;
  const bool on_floor = (ta == 0 && tb > 0) || (tb == 0 && ta > 0);
  const auto soft = self       ? SpringDamper(kSelfStiffness_n_m, kSelfDamping_ns_m, step_s)
                    : on_floor ? SpringDamper(kFloorStiffness_n_m, kFloorDamping_ns_m, step_s)
                               : SpringDamper(kContactStiffness_n_m, kContactDamping_ns_m, step_s);
  const auto info = [&](int tag) -> const ObjectOptions* {
    return tag < 0 ? &things[static_cast<size_t>(-tag - 1)].info : nullptr;
  };
  double friction = options.floor_friction, bounce = 0.0;
  for (const int tag : {ta, tb}) {
    if (info(tag) == nullptr) continue;
    friction = info(tag)->friction;
    bounce = std::max(bounce, info(tag)->bounce);
  }
  for (int i = 0; i < count; ++i) {
    dContact& c = contact[static_cast<size_t>(i)];
    Note(a, b, c.geom.depth);
    c.surface.mode = dContactApprox1 | dContactSoftERP | dContactSoftCFM;
    c.surface.mu = self ? 0.0 : friction;
    c.surface.soft_erp = soft.erp;
    c.surface.soft_cfm = soft.cfm;
    if (bounce > 0.0) {
      c.surface.mode |= dContactBounce;
      c.surface.bounce = bounce;
      c.surface.bounce_vel = 0.2;
    }
    dJointAttach(dJointCreateContact(ode.world, ode.contacts, &c), dGeomGetBody(a),
                 dGeomGetBody(b));
  }
}

void World::Impl::OnNearPair(void* self, dGeomID a, dGeomID b) {
  const int ta = TagOf(a), tb = TagOf(b);
  if (ta == tb) return;  // a character's own pairs are listed, not found
  const dBodyID body_a = dGeomGetBody(a), body_b = dGeomGetBody(b);
  if (dAreConnectedExcluding(body_a, body_b, dJointTypeContact) != 0) return;
  static_cast<World::Impl*>(self)->CollidePair(a, b);
}

void World::Impl::CollideFloor() {
  if (floor_geom == nullptr) return;
  for (const auto& actor : actors) {
    for (size_t bone = 1; bone < recon::kJointCount; ++bone) {
      const Segment& segment = actor->character.segments()[bone];
      const double height =
          HeightAbove(*floor, ToEigen(dBodyGetPosition(actor->character.body(bone))));
      if (height < segment.length_m + segment.radius_m) {
        CollidePair(actor->character.geom(bone), floor_geom);
      }
    }
  }
  for (const Thing& thing : things) CollidePair(thing.geom, floor_geom);
}

void World::Impl::Collide(double h_s) {
  step_s = h_s;
  contacts.character_object_depth_m = contacts.object_depth_m = contacts.floor_depth_m = 0.0;
  contacts.character_object_contacts = 0;
  CollideFloor();
  for (const auto& actor : actors) {
    if (!actor->options.self_collision) continue;
    for (const auto& [a, b] : SelfCollisionPairs()) {
      CollidePair(actor->character.geom(a), actor->character.geom(b));
    }
  }
  if (actors.size() > 1 || !things.empty()) dSpaceCollide(ode.space, this, &OnNearPair);
}

}  // namespace ossa::physics
