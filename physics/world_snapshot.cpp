// Save and Restore. A snapshot describes a world; Restore builds a new one from it, creating
// everything in the original order, because the solver's rows depend on it.
#include <algorithm>
#include <functional>
#include <stdexcept>

#include "physics/world_internal.h"

namespace ossa::physics {
namespace {

struct SavedPin {
  size_t joint = 0;
  uint64_t made = 0;
  Anchor anchor;  // body determined by its object
};

struct SavedActor {
  int id = 0;
  uint64_t made = 0;
  recon::BoneLengths lengths;
  CharacterOptions options;
  ActorMemory memory;
  recon::Posture first, placed;
  recon::JointOrientations placed_orientation;
  recon::JointArray<BodyMemory> body;
  std::array<FootPinMemory, 2> foot;
  std::array<std::optional<SavedPin>, 2> foot_pin;
  std::vector<SavedPin> soft, hard;
};

struct SavedThing {
  int id = 0;
  uint64_t made = 0;
  ObjectOptions info;
  BodyMemory body;
  std::vector<Load> loads;
  std::optional<Eigen::Isometry3d> goal;
  std::vector<Grip> grips;  // without their joints
};

Grip Description(const Grip& grip) {
  Grip copy;
  copy.made = grip.made;
  copy.character = grip.character;
  copy.bone = grip.bone;
  copy.rigid = grip.rigid;
  copy.strength_n = grip.strength_n;
  copy.torque_nm = grip.torque_nm;
  copy.point_m = grip.point_m;
  copy.on_thing_m = grip.on_thing_m;
  copy.taken_off_m = grip.taken_off_m;
  copy.hand_then = grip.hand_then;
  copy.thing_then = grip.thing_then;
  copy.in_hand = grip.in_hand;
  return copy;
}

SavedActor Saved(int id, const Actor& actor) {
  SavedActor saved;
  saved.id = id;
  saved.made = actor.made;
  saved.lengths = actor.lengths;
  saved.options = actor.options;
  saved.memory = actor;
  saved.first = actor.first;
  saved.placed = actor.character.placed();
  saved.placed_orientation = actor.character.placed_orientation();
  for (size_t bone = 1; bone < recon::kJointCount; ++bone) {
    saved.body[bone] = Remember(actor.character.body(bone));
  }
  for (size_t k = 0; k < 2; ++k) {
    const FootPin& foot = actor.foot_pin[k];
    saved.foot[k] = foot.memory;
    if (foot.pin() == nullptr) continue;
    saved.foot_pin[k] = {foot.joint(), foot.pin()->made(), foot.pin()->anchor()};
  }
  for (const auto& [joint, anchor] : actor.soft_constraint) {
    saved.soft.push_back({joint, 0, anchor});
  }
  for (const auto& [joint, pin] : actor.hard_constraint) {
    saved.hard.push_back({joint, pin->made(), pin->anchor()});
  }
  return saved;
}

}  // namespace

struct WorldSnapshot::Data {
  WorldOptions options;
  std::optional<Eigen::Vector4d> floor;
  std::vector<SavedActor> actors;
  std::vector<SavedThing> things;
  int next_actor = 0, next_thing = 0;
  ContactSummary contacts;
  uint64_t steps = 0, made = 0;
};

WorldSnapshot World::Save() const {
  const Impl& w = *impl_;
  auto data = std::make_shared<WorldSnapshot::Data>();
  data->options = w.options;
  data->floor = w.floor;
  for (const auto& [id, actor] : w.actors) data->actors.push_back(Saved(id, *actor));
  for (const auto& [id, thing] : w.things) {
    SavedThing saved{id, thing.made, thing.info, Remember(thing.body), thing.loads, thing.goal, {}};
    for (const Grip& grip : thing.grips) saved.grips.push_back(Description(grip));
    data->things.push_back(std::move(saved));
  }
  data->next_actor = w.next_actor;
  data->next_thing = w.next_thing;
  data->contacts = w.contacts;
  data->steps = w.steps;
  data->made = w.ode.made;
  WorldSnapshot snapshot;
  snapshot.data_ = std::move(data);
  return snapshot;
}

/// Creates the content of a snapshot in an empty world.
class World::Impl::Restorer {
 public:
  Restorer(Impl& world, const WorldSnapshot::Data& data) : w_(world), data_(data) {}

  void Run() {
    for (const SavedActor& saved : data_.actors) Schedule(saved);
    for (const SavedThing& saved : data_.things) Schedule(saved);
    std::sort(makings_.begin(), makings_.end(),
              [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& [made, make] : makings_) {
      w_.ode.made = made;
      make();
    }
    MoveAll();
    w_.next_actor = data_.next_actor;
    w_.next_thing = data_.next_thing;
    w_.contacts = data_.contacts;
    w_.steps = data_.steps;
    w_.ode.made = data_.made;
  }

 private:
  Anchor WithBody(Anchor anchor) const {
    if (anchor.object >= 0) anchor.body = w_.things.at(anchor.object).body;
    return anchor;
  }

  void Schedule(const SavedActor& saved) {
    makings_.emplace_back(saved.made, [this, &saved] {
      Actor& actor = w_.MakeActor(saved.id, saved.lengths, saved.options);
      static_cast<ActorMemory&>(actor) = saved.memory;
      actor.first = saved.first;
      actor.character.Place(saved.placed, saved.placed_orientation);
      for (size_t k = 0; k < 2; ++k) actor.foot_pin[k].memory = saved.foot[k];
    });
    for (size_t k = 0; k < 2; ++k) {
      const std::optional<SavedPin>& pin = saved.foot_pin[k];
      if (!pin) continue;
      makings_.emplace_back(pin->made, [this, &saved, &pin, k] {
        Actor& actor = w_.ActorOf(saved.id);
        actor.foot_pin[k].Restore(w_.ode, actor.character, pin->anchor.point_m);
      });
    }
    for (const SavedPin& pin : saved.hard) {
      makings_.emplace_back(pin.made, [this, &saved, &pin] {
        w_.Constrain(w_.ActorOf(saved.id), pin.joint, WithBody(pin.anchor), true);
      });
    }
  }

  void Schedule(const SavedThing& saved) {
    makings_.emplace_back(saved.made, [this, &saved] {
      Thing& thing = w_.MakeThing(saved.id, saved.info);
      thing.loads = saved.loads;
      thing.goal = saved.goal;
    });
    for (const Grip& grip : saved.grips) {
      makings_.emplace_back(grip.made, [this, &saved, &grip] {
        // A grip keeps the relative pose at which it closed.
        Thing& thing = w_.things.at(saved.id);
        if (grip.character >= 0) {
          Recall(w_.ActorOf(grip.character).character.body(grip.bone), grip.hand_then);
        }
        Recall(thing.body, grip.thing_then);
        w_.Take(thing, Description(grip));
      });
    }
  }

  void MoveAll() {
    for (const SavedActor& saved : data_.actors) {
      Actor& actor = w_.ActorOf(saved.id);
      for (const SavedPin& soft : saved.soft) {
        actor.soft_constraint[soft.joint] = WithBody(soft.anchor);
      }
      for (size_t bone = 1; bone < recon::kJointCount; ++bone) {
        Recall(actor.character.body(bone), saved.body[bone]);
      }
    }
    for (const SavedThing& saved : data_.things) Recall(w_.things.at(saved.id).body, saved.body);
  }

  Impl& w_;
  const WorldSnapshot::Data& data_;
  std::vector<std::pair<uint64_t, std::function<void()>>> makings_;  // with their creation order
};

void World::Restore(const WorldSnapshot& snapshot) {
  const std::shared_ptr<const WorldSnapshot::Data> data = snapshot.data_;
  if (!data) throw std::invalid_argument("Restore: expected a snapshot that was saved");
  auto world = std::make_unique<Impl>(data->options);
  world->callbacks = std::move(impl_->callbacks);
  impl_ = std::move(world);
  SetFloor(data->floor);
  Impl::Restorer(*impl_, *data).Run();
}

}  // namespace ossa::physics
