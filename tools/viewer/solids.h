#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "physics/world.h"
#include "recon/posture.h"
#include "tools/tracker/tracker.h"

namespace ossa::viewer {

/// A solid of the physical world: a part of a character, or an object. Camera space, metres.
struct Solid {
  physics::Shape shape = physics::Shape::kBox;
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();      // as physics::ObjectOptions::size_m
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  // of its middle
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  int person = 0;  // body id of the person of the character; 0: an object
};

/// The capsules of a character in this posture (physics/anthropometry.h), one per bone.
std::vector<Solid> CapsulesOf(const recon::Posture& posture, int person);

/// Those of all tracked people.
std::vector<Solid> CapsulesOf(const tracker::BodyFrame& bodies);

/// The shapes of the objects of a scene.
std::vector<Solid> SolidsOf(const std::vector<tracker::SceneObjectState>& objects);

/// The content of the world of a frame: its objects, and with `characters` the capsules of all
/// tracked people.
std::vector<Solid> SolidsOf(const tracker::BodyFrame& frame, bool characters);

/// [{"shape":"box","size":[...],"at":[...],"turn":[x,y,z,w],"person":0},...], metres to the tenth
/// of a millimetre.
std::string SolidsJson(const std::vector<Solid>& solids);

}  // namespace ossa::viewer
