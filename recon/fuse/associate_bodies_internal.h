#pragma once
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "recon/fuse/sighting_internal.h"

namespace ossa::recon {

/// When bodies of different cameras are one person.
struct AssociationOptions {
  double same_m = 0.35;    // mean joint distance below which they become one; metres; by hand
  double other_m = 0.6;    // ... and above which they are no longer; metres; by hand
  int frames_to_part = 9;  // in a row above the latter, or below the former: 0.3 s; by hand
};

/// One person at one time, as seen by several cameras.
struct SightedPerson {
  int id = 0;
  std::vector<const BodySighting*> sightings;  // in order of cameras
};

/// Associates the bodies of several cameras with persons, over time. A camera's body stays with its
/// person until it has been far from the other cameras' views of that person for a while. A new
/// body joins the nearest person that its camera does not see otherwise, or becomes a new person.
/// If two persons are never seen by one camera at once and have been at one place for a while, the
/// younger is merged into the older. A person's id is the one that camera 0 assigned, if camera 0
/// saw the person first and the id is free; else the lowest unused one.
class BodyAssociation {
 public:
  explicit BodyAssociation(const AssociationOptions& options = {}) : options_(options) {}

  /// `sightings` in order of cameras; they must outlive the result. A body that is far from its
  /// person but not yet reassigned is left out of this result. In order of ids.
  std::vector<SightedPerson> Update(std::span<const BodySighting> sightings);

 private:
  using BodyKey = std::pair<size_t, int>;  // camera, its id
  using Persons = std::map<int, SightedPerson>;

  void KeepKnown(std::span<const BodySighting> sightings, Persons& persons,
                 std::vector<const BodySighting*>& unknown);
  void AssignUnknown(std::vector<const BodySighting*> unknown, Persons& persons);
  bool HaveBeenTogether(const SightedPerson& a, const SightedPerson& b);
  void MergePersons(Persons& persons);
  void Rename(int from, int to);
  int NewId(const BodySighting& sighting);

  AssociationOptions options_;
  std::map<BodyKey, int> person_of_;
  std::map<BodyKey, int> frames_apart_;
  std::map<std::pair<int, int>, int> frames_together_;  // per pair of persons
  std::map<int, int> age_;                              // per person, in frames
  int lowest_free_id_ = 1;
};

}  // namespace ossa::recon
