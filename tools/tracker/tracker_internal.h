#pragma once
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "forest/forest.h"
#include "tools/people/detect_people.h"
#include "tools/tracker/lagged_bodies_internal.h"
#include "tools/tracker/mount_finder_internal.h"
#include "tools/tracker/person_internal.h"
#include "tools/tracker/tracker.h"
#include "tools/tracker/upright.h"

namespace ossa::tracker {

/// Throws InputError for an invalid camera, time or image size.
void CheckFrame(const depth::DepthFrame& frame);

/// A tracker for one mount, level or under the ceiling: options, models and state.
struct Tracker::Impl {
  TrackerOptions options;
  ModelSet models;
  const forest::ForestModel& model;  // of `models`
  people::JointTargets targets;
  SkeletonOptions skeleton;
  people::PeopleOptions people_options;
  people::PeopleState people_state;
  std::map<int, Person> persons;  // by id
  std::optional<std::vector<int>> chosen_ids;
  UprightFinder upright;
  MountFinder mount_finder;
  // Loaded when a ceiling view is suspected.
  std::shared_ptr<const forest::ForestModel> ceiling_forest;
  LaggedBodies lagged;
  std::optional<Scene> scene;

  explicit Impl(const TrackerOptions& o);

  LaggedBodies NothingLagged() const;
  BodyFrame Track(const depth::DepthFrame& frame);
  bool IsUnderCeiling() const;
  // Settings that the application changed since construction.
  void CopySettings(const Impl& other);
  bool ShowsCeilingView(const depth::DepthFrame& frame, const BodyFrame& tracked);
  // `frame`: upright, because the check reads what the lower image border cuts off.
  bool ConfirmCeilingView(const depth::DepthFrame& frame, const BodyFrame& tracked);
  BodyFrame TrackTurned(const depth::DepthFrame& frame);
  BodyFrame Play(BodyFrame frame);
  int QuarterTurns() const {
    return options.turn == Turn::kAuto ? upright.quarters() : static_cast<int>(options.turn);
  }
  bool KeepsParts() const { return options.keep_parts || options.keep_probabilities; }
  void FindUpright(const depth::DepthFrame& frame);
  void DeleteTracks();
  Body MakeBody(const depth::DepthFrame& frame, const people::Person& person) const;
  void WithdrawUnlikeBodies(const std::vector<people::Person>& seen, BodyFrame& result);
  std::vector<Person*> RememberPersons(const std::vector<Body>& bodies, double time_s);
  void InitializePerson(int id, Person& person) const;
};

}  // namespace ossa::tracker
