#include <algorithm>
#include <array>

#include "physics/world_internal.h"

namespace ossa::physics {

using Eigen::Vector3d;

namespace {

// Constants: chosen by hand unless stated otherwise.

// Contacts are implicit springs, stable at any stiffness: a leg pressed down with the largest
// control force (2 kg x 250 m/s^2) sinks in by 0.1 mm. Damping removes half of an overlap per
// substep.
constexpr double kStiffness_n_m = 4e6;
constexpr double kDamping_ns_m = 12000.0;
/// Depth of the soft skin between a character's own limbs, within which the target prevails: bodies
/// are softer and slimmer than capsules, and sensors place folded arms slightly inside the chest.
/// This is the maximum penetration.
constexpr double kSkin_m = 0.03;
constexpr double kSelfStiffness_n_m = 3e3;
constexpr double kSelfDamping_ns_m = 60.0;
/// Gaps below this count as contacts: control can close them within a substep (250 m/s^2 x h^2).
constexpr double kSlop_m = 0.003;
constexpr double kTouching_m = 0.0005;
/// What approaches more slowly comes to rest.
constexpr double kLeastBounce_m_s = 0.2;

Vector3d VelocityAt(dBodyID body, const dReal* point) {
  if (body == nullptr) return Vector3d::Zero();
  dVector3 v;
  dBodyGetPointVel(body, point[0], point[1], point[2], v);
  return ToEigen(v);
}

/// Approach speed, m/s; 0 if they separate. ODE's normal points into `a`.
double Approach(dGeomID a, dGeomID b, const dContact& c) {
  const Vector3d relative =
      VelocityAt(dGeomGetBody(a), c.geom.pos) - VelocityAt(dGeomGetBody(b), c.geom.pos);
  return std::max(0.0, -relative.dot(ToEigen(c.geom.normal)));
}

}  // namespace

const std::vector<std::array<size_t, 2>>& SelfCollisionPairs() {
  static const std::vector<std::array<size_t, 2>> pairs = [] {
    std::vector<std::array<size_t, 2>> list;
    const auto add_all = [&list](std::initializer_list<size_t> some,
                                 std::initializer_list<size_t> others) {
      for (const size_t a : some) {
        for (const size_t b : others) list.push_back({a, b});
      }
    };
    add_all({6, 7, 10, 11}, {1, 2, 3});                 // forearms, hands; trunk, head
    add_all({6, 7}, {9, 10, 11});                       // the other arm
    add_all({10, 11}, {5});                             // and vice versa
    add_all({13, 14, 15}, {17, 18, 19});                // leg and leg
    add_all({6, 7, 10, 11}, {13, 14, 15, 17, 18, 19});  // forearms, hands; legs
    return list;
  }();
  return pairs;
}

/// ODE finds one point between a capsule and a box, about which the box rotates freely. Gripping
/// hands and carrying forearms are in contact along the box: the ends of the capsule are contacts,
/// too.
int World::Impl::CapsuleEndsOnBox(dGeomID a, dGeomID b, dContact* contact) {
  const bool first = dGeomGetClass(a) == dCapsuleClass;
  const dGeomID capsule = first ? a : b, box = first ? b : a;
  if (dGeomGetClass(capsule) != dCapsuleClass || dGeomGetClass(box) != dBoxClass) return 0;
  dReal radius = 0.0, length = 0.0;
  dGeomCapsuleGetParams(capsule, &radius, &length);
  dGeomSphereSetRadius(probe, radius);
  const dReal* rotation = dGeomGetRotation(capsule);
  const Vector3d axis(rotation[2], rotation[6], rotation[10]);
  int found = 0;
  for (const double end : {-0.5, 0.5}) {
    const Vector3d at = ToEigen(dGeomGetPosition(capsule)) + end * length * axis;
    dGeomSetPosition(probe, at.x(), at.y(), at.z());
    found += dCollide(first ? probe : box, first ? box : probe, 1, &contact[found].geom,
                      sizeof(dContact));
  }
  return found;
}

World::Impl::Surface World::Impl::SurfaceOf(int ta, int tb) const {
  Surface surface;
  surface.self = ta == tb && ta > 0;
  surface.margin_m = ((ta > 0 ? 1 : 0) + (tb > 0 ? 1 : 0)) * kContactMargin_m;
  if (std::min(ta, tb) == 0) surface.margin_m += kFloorLook_m;
  surface.soft = SpringDamper(kStiffness_n_m, kDamping_ns_m, step_s);
  surface.friction = surface.self ? 0.0 : options.floor_friction;
  for (const int tag : {ta, tb}) {
    if (tag >= 0) continue;
    const ObjectOptions& info = things.at(-tag - 1).info;
    surface.friction = info.friction;
    surface.bounce = std::max(surface.bounce, info.bounce);
  }
  return surface;
}

void World::Impl::CollidePair(dGeomID a, dGeomID b) {
  constexpr int kMaxContacts = 6;
  std::array<dContact, kMaxContacts> contact{};
  int count = dCollide(a, b, kMaxContacts, &contact[0].geom, sizeof(dContact));
  if (count == 0) return;
  if (count == 1) count += CapsuleEndsOnBox(a, b, &contact[1]);
  const Surface surface = SurfaceOf(TagOf(a), TagOf(b));
  for (int i = 0; i < count; ++i) {
    dContact& c = contact[static_cast<size_t>(i)];
    const double depth = c.geom.depth - surface.margin_m;
    if (!surface.self) {
      Touch(a, b, c, surface, depth);
      continue;
    }
    if (depth > 0.0) Press(a, b, c, depth);
    Touch(a, b, c, surface, depth - kSkin_m);
  }
}

/// Limb geoms include a margin. Within it a contact limits the approach to the remaining gap per
/// substep, so that a fast ball is stopped before it is inside the limb. What bounces in this
/// substep leaves with its speed of restitution: the contact is hard then, for a soft one takes a
/// part of it that grows with the mass.
void World::Impl::Touch(dGeomID a, dGeomID b, dContact c, const Surface& surface, double depth_m) {
  const double speed_m_s = Approach(a, b, c), closing = speed_m_s * step_s;
  if (depth_m < 0.0 && depth_m + closing + kSlop_m < 0.0) return;
  if (depth_m + closing > -kTouching_m && !surface.self) Note(a, b, std::max(depth_m, 0.0));
  c.geom.depth = std::max(depth_m, 0.0);
  c.surface.mode = dContactApprox1 | dContactSoftERP;
  c.surface.mu = surface.friction;
  c.surface.soft_erp = surface.soft.erp;
  if (surface.bounce > 0.0 && speed_m_s > kLeastBounce_m_s && depth_m + closing >= 0.0) {
    c.surface.mode |= dContactBounce;
    c.surface.bounce = surface.bounce;
    c.surface.bounce_vel = kLeastBounce_m_s;
  } else {
    c.surface.mode |= dContactSoftCFM | dContactMotionN;
    c.surface.soft_cfm = surface.soft.cfm;
    c.surface.motionN = std::min(depth_m, 0.0) / step_s;
  }
  Join(a, b, c, depth_m);
}

/// Contact between a character's own limbs, with soft skin.
void World::Impl::Press(dGeomID a, dGeomID b, dContact c, double depth_m) {
  const SoftConstraint soft = SpringDamper(kSelfStiffness_n_m, kSelfDamping_ns_m, step_s);
  Note(a, b, depth_m);
  c.geom.depth = depth_m;
  c.surface.mode = dContactApprox1 | dContactSoftERP | dContactSoftCFM;
  c.surface.mu = 0.0;
  c.surface.soft_erp = soft.erp;
  c.surface.soft_cfm = soft.cfm;
  Join(a, b, c, depth_m);
}

void World::Impl::Join(dGeomID a, dGeomID b, const dContact& contact, double depth_m) {
  const dJointID joint = dJointCreateContact(ode.world, ode.contacts, &contact);
  dJointAttach(joint, dGeomGetBody(a), dGeomGetBody(b));
  pressing.push_back({PartyOf(a),
                      PartyOf(b),
                      ToEigen(contact.geom.pos),
                      ToEigen(contact.geom.normal),
                      depth_m,
                      {}});
  dJointSetFeedback(joint, &pressing.back().feedback);
}

bool World::Impl::MayMeet(dGeomID a, dGeomID b) const {
  const Party side[] = {PartyOf(a), PartyOf(b)};
  // A character's own pairs are listed explicitly; parts of an object do not collide.
  if (side[0].kind == side[1].kind && side[0].id == side[1].id) return false;
  uint32_t groups[2], meets[2];
  bool moved = false;
  for (size_t k = 0; k < 2; ++k) {
    const bool is_object = side[k].kind == Party::Kind::kObject;
    const Thing* const thing = is_object ? &things.at(side[k].id) : nullptr;
    moved |= !is_object || thing->IsMoved();
    groups[k] = is_object ? thing->info.groups : actors.at(side[k].id)->options.groups;
    meets[k] = is_object ? thing->info.collides_with : actors.at(side[k].id)->options.collides_with;
    // An object does not collide with the bone that holds it or with that bone's parent.
    const dBodyID other = dGeomGetBody(k == 0 ? b : a);
    if (is_object && std::any_of(thing->grips.begin(), thing->grips.end(),
                                 [other](const Grip& grip) { return grip.beside == other; })) {
      return false;
    }
  }
  if (!moved || (groups[0] & meets[1]) == 0 || (groups[1] & meets[0]) == 0) return false;
  if (dAreConnectedExcluding(dGeomGetBody(a), dGeomGetBody(b), dJointTypeContact) != 0)
    return false;
  return !callbacks.may_meet || callbacks.may_meet(side[0], side[1]);
}

/// Collides the pairs found by the space, in a deterministic order: the space's own depends on its
/// history.
void World::Impl::CollideNear() {
  near.clear();
  dSpaceCollide(ode.space, this, [](void* self, dGeomID a, dGeomID b) {
    static_cast<World::Impl*>(self)->near.emplace_back(a, b);
  });
  const auto key = [this](dGeomID geom) {
    const Party party = PartyOf(geom);
    size_t part = party.bone;
    if (party.kind == Party::Kind::kObject) {
      const auto& geoms = things.at(party.id).geoms;
      part = static_cast<size_t>(std::find(geoms.begin(), geoms.end(), geom) - geoms.begin());
    }
    return std::pair(TagOf(geom), part);
  };
  for (auto& [a, b] : near) {
    if (key(b) < key(a)) std::swap(a, b);
  }
  std::sort(near.begin(), near.end(), [&key](const auto& x, const auto& y) {
    return std::pair(key(x.first), key(x.second)) < std::pair(key(y.first), key(y.second));
  });
  for (const auto& [a, b] : near) {
    if (MayMeet(a, b)) CollidePair(a, b);
  }
}

void World::Impl::CollideFloor() {
  if (!floor) return;
  for (const auto& [id, actor] : actors) {
    for (size_t bone = 1; bone < recon::kJointCount; ++bone) {
      const Segment& segment = actor->character.segments()[bone];
      const double height =
          HeightAbove(*floor, ToEigen(dBodyGetPosition(actor->character.body(bone))));
      const double reach = 0.6 * segment.length_m + segment.radius_m + kContactMargin_m;
      if (height < reach + kFloorLook_m) {
        CollidePair(actor->character.geom(bone), limb_floor_geom);
      }
    }
  }
  for (const auto& [id, thing] : things) {
    if (!thing.IsMoved()) continue;
    for (const dGeomID geom : thing.geoms) CollidePair(geom, floor_geom);
  }
}

void World::Impl::Collide(double h_s) {
  step_s = h_s;
  pressing.clear();
  CollideFloor();
  for (const auto& [id, actor] : actors) {
    if (!actor->options.self_collision) continue;
    for (const auto& [a, b] : SelfCollisionPairs()) {
      CollidePair(actor->character.geom(a), actor->character.geom(b));
    }
  }
  if (actors.size() > 1 || !things.empty()) CollideNear();
}

}  // namespace ossa::physics
