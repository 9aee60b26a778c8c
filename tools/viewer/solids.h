#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "physics/world.h"
#include "recon/posture.h"
#include "tools/tracker/tracker.h"

namespace ossa::viewer {

/// A solid of a mechanical world: of a character, or a thing. Camera space, metres.
struct Solid {
  physics::Shape shape = physics::Shape::kBox;
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();      // as physics::ObjectOptions::size_m
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  // of its middle
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  int person = 0;  // body id of whose character it is; 0: a thing
};

/// The capsules of a character that stands so (physics/anthropometry.h), one a bone.
std::vector<Solid> CapsulesOf(const recon::Posture& posture, int person);

/// Those of all who are tracked.
std::vector<Solid> CapsulesOf(const tracker::BodyFrame& bodies);

/// The shapes that the objects of a scene are made of.
std::vector<Solid> SolidsOf(const std::vector<tracker::SceneObjectState>& objects);

/// What is in the world of a frame: its objects, and with `characters` those of all who are
/// tracked.
std::vector<Solid> SolidsOf(const tracker::BodyFrame& frame, bool characters);

/// [{"shape":"box","size":[...],"at":[...],"turn":[x,y,z,w],"person":0},...], metres to the tenth
/// of a millimetre.
std::string SolidsJson(const std::vector<Solid>& solids);

}  // namespace ossa::viewer
