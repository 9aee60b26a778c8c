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

/// One person at one moment, by the cameras that see them.
struct SightedPerson {
  int id = 0;
  std::vector<const BodySighting*> sightings;  // in order of their cameras
};

/// Which bodies of which cameras are the same person, from moment to moment. Each camera's body
/// stays with its person until it has been far from what the other cameras see of them for a while;
/// a new one joins the nearest person that its camera does not see otherwise, or is a new person.
/// Of two persons whom no camera sees at once and who have been at one place for a while, the
/// younger becomes the older. A person's id is that which camera 0 gave them, if it was the first
/// and the id is free, else the lowest that no person had.
class BodyAssociation {
 public:
  explicit BodyAssociation(const AssociationOptions& options = {}) : options_(options) {}

  /// `sightings` in order of their cameras; they must outlive what is returned. A body that is far
  /// from its person, and not yet another's, is nobody's this time. In order of ids.
  std::vector<SightedPerson> Update(std::span<const BodySighting> sightings);

 private:
  using BodyKey = std::pair<size_t, int>;  // camera, its id
  using Persons = std::map<int, SightedPerson>;

  void KeepKnown(std::span<const BodySighting> sightings, Persons& persons,
                 std::vector<const BodySighting*>& unknown);
  void PlaceUnknown(std::vector<const BodySighting*> unknown, Persons& persons);
  bool HaveBeenTogether(const SightedPerson& a, const SightedPerson& b);
  void MergePersons(Persons& persons);
  void Rename(int from, int to);
  int NewId(const BodySighting& sighting);

  AssociationOptions options_;
  std::map<BodyKey, int> person_of_;
  std::map<BodyKey, int> frames_apart_;
  std::map<std::pair<int, int>, int> frames_together_;  // of two persons
  std::map<int, int> age_;                              // of a person, in frames
  int lowest_free_id_ = 1;
};

}  // namespace ossa::recon
