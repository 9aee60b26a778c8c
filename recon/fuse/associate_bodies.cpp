#include <algorithm>
#include <limits>
#include <optional>

#include "recon/fuse/associate_bodies_internal.h"

namespace ossa::recon {
namespace {

double DistanceToPerson_m(const BodySighting& sighting, const SightedPerson& person) {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const BodySighting* other : person.sightings) {
    nearest_m = std::min(nearest_m, MeanDistance_m(sighting.body, other->body));
  }
  return nearest_m;
}

bool IsSeenBy(const SightedPerson& person, size_t camera) {
  return std::any_of(person.sightings.begin(), person.sightings.end(),
                     [camera](const BodySighting* seen) { return seen->camera == camera; });
}

bool ShareCamera(const SightedPerson& a, const SightedPerson& b) {
  return std::any_of(a.sightings.begin(), a.sightings.end(),
                     [&b](const BodySighting* seen) { return IsSeenBy(b, seen->camera); });
}

double PersonDistance_m(const SightedPerson& a, const SightedPerson& b) {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const BodySighting* seen : a.sightings) {
    nearest_m = std::min(nearest_m, DistanceToPerson_m(*seen, b));
  }
  return nearest_m;
}

void SortByCamera(SightedPerson& person) {
  std::stable_sort(
      person.sightings.begin(), person.sightings.end(),
      [](const BodySighting* a, const BodySighting* b) { return a->camera < b->camera; });
}

}  // namespace

std::vector<SightedPerson> BodyAssociation::Update(std::span<const BodySighting> sightings) {
  Persons persons;
  std::vector<const BodySighting*> unknown;
  KeepKnown(sightings, persons, unknown);
  AssignUnknown(std::move(unknown), persons);
  MergePersons(persons);
  std::vector<SightedPerson> seen;
  for (auto& [id, person] : persons) {
    ++age_[id];
    SortByCamera(person);
    seen.push_back(std::move(person));
  }
  return seen;
}

void BodyAssociation::KeepKnown(std::span<const BodySighting> sightings, Persons& persons,
                                std::vector<const BodySighting*>& unknown) {
  for (const BodySighting& sighting : sightings) {
    const BodyKey key{sighting.camera, sighting.body.id};
    const auto known = person_of_.find(key);
    if (known == person_of_.end()) {
      unknown.push_back(&sighting);
      continue;
    }
    SightedPerson& person = persons[known->second];
    person.id = known->second;
    if (IsSeenBy(person, sighting.camera)) {  // by a body that got a new id since
      person_of_.erase(known);
      unknown.push_back(&sighting);
      continue;
    }
    const bool near =
        person.sightings.empty() || DistanceToPerson_m(sighting, person) <= options_.other_m;
    int& apart = frames_apart_[key];
    apart = near ? 0 : apart + 1;
    if (near) person.sightings.push_back(&sighting);
    if (apart < options_.frames_to_part) continue;
    apart = 0;
    person_of_.erase(known);
    unknown.push_back(&sighting);
  }
}

/// Assigns the nearest bodies first. A body that is near no person becomes a new one, which later
/// bodies may join.
void BodyAssociation::AssignUnknown(std::vector<const BodySighting*> unknown, Persons& persons) {
  while (!unknown.empty()) {
    double nearest_m = options_.same_m;
    size_t which = 0;
    SightedPerson* whom = nullptr;
    for (size_t u = 0; u < unknown.size(); ++u) {
      for (auto& [id, person] : persons) {
        if (IsSeenBy(person, unknown[u]->camera)) continue;
        const double distance_m = DistanceToPerson_m(*unknown[u], person);
        if (!(distance_m < nearest_m)) continue;
        nearest_m = distance_m;
        which = u;
        whom = &person;
      }
    }
    const BodySighting* sighting = unknown[which];
    unknown.erase(unknown.begin() + static_cast<ptrdiff_t>(which));
    const int id = whom != nullptr ? whom->id : NewId(*sighting);
    persons[id].id = id;
    persons[id].sightings.push_back(sighting);
    person_of_[{sighting->camera, sighting->body.id}] = id;
  }
}

bool BodyAssociation::HaveBeenTogether(const SightedPerson& a, const SightedPerson& b) {
  const bool together = !ShareCamera(a, b) && PersonDistance_m(a, b) < options_.same_m;
  int& frames = frames_together_[{std::min(a.id, b.id), std::max(a.id, b.id)}];
  frames = together ? frames + 1 : 0;
  return frames >= options_.frames_to_part;
}

void BodyAssociation::MergePersons(Persons& persons) {
  for (auto a = persons.begin(); a != persons.end(); ++a) {
    for (auto b = std::next(a); b != persons.end();) {
      if (!HaveBeenTogether(a->second, b->second)) {
        ++b;
        continue;
      }
      if (age_[a->second.id] < age_[b->second.id]) std::swap(a->second.id, b->second.id);
      Rename(b->second.id, a->second.id);
      for (const BodySighting* seen : b->second.sightings) a->second.sightings.push_back(seen);
      b = persons.erase(b);
    }
  }
  Persons renamed;  // by current ids
  for (auto& [id, person] : persons) renamed[person.id] = std::move(person);
  persons = std::move(renamed);
}

void BodyAssociation::Rename(int from, int to) {
  for (auto& [key, id] : person_of_) {
    if (id == from) id = to;
  }
  frames_together_.erase({std::min(from, to), std::max(from, to)});
}

int BodyAssociation::NewId(const BodySighting& sighting) {
  const int own = sighting.body.id;
  const bool takes_own = sighting.camera == 0 && own > 0 && !age_.contains(own);
  while (age_.contains(lowest_free_id_)) ++lowest_free_id_;
  const int id = takes_own ? own : lowest_free_id_;
  age_[id] = 0;
  return id;
}

}  // namespace ossa::recon
