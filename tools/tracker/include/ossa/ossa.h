#pragma once
/// What an application needs of ossa: depth images in, skeletons out.
///
///   ossa::tracker::Tracker tracker;
///   const auto source = ossa::depth::OpenSource("openni:");
///   tracker.Run(*source, [](const ossa::tracker::BodyFrame& frame) {
///     for (const auto& body : frame.bodies)
///       Use(body.joints[ossa::recon::Joint::kHead].position_m);
///     return true;
///   });
///
/// ossa::depth    images, cameras, sensors and recordings
/// ossa::recon    skeletons, their files, and methods that complete them
/// ossa::tracker  the tracker
/// Rarer needs have headers of their own: forest/ (train and run body part forests), physics/ (the
/// mechanical character), recon/.
#include "depth/base/error.h"           // InputError: what is wrong with a file, in one line
#include "depth/image/camera_io.h"      // cameras by name, from files
#include "depth/image/depth_frame.h"    // DepthFrame and its Camera
#include "depth/image/turn.h"           // Unmirrored: images as a mirror shows them
#include "depth/sensor/frame_source.h"  // OpenSource
#include "recon/files/skeleton_io.h"    // skeleton files in many formats
#include "recon/methods/reconstruct_sequence.h"  // methods over recorded skeletons
#include "recon/skeleton_sequence.h"             // a recording of skeletons
#include "tools/tracker/model_set.h"             // ModelSet: everything learned
#include "tools/tracker/scene.h"                 // Scene: people and objects in one world
#include "tools/tracker/skeleton_record.h"       // from BodyFrame to skeleton files
#include "tools/tracker/tracker.h"               // Tracker, Version
