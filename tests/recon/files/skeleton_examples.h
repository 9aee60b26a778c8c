#pragma once
#include <cmath>
#include <sstream>
#include <string>

#include "depth/base/error.h"
#include "recon/files/skeleton_io.h"

namespace ossa::recon {

/// A made-up walk of one or more people: smooth, every joint in another place, some joints with
/// states and confidences, one joint missing.
inline SkeletonSequence ExampleSequence(int frames, int bodies = 1) {
  SkeletonSequence sequence{"example", {}};
  for (int f = 0; f < frames; ++f) {
    SkeletonFrame frame;
    frame.frame = f;
    frame.time_s = f / 30.0;
    frame.floor = Eigen::Vector4d(0, 1, 0, 0.9);
    for (int b = 0; b < bodies; ++b) {
      BodyRecord body;
      body.id = b + 1;
      for (size_t j = 0; j < kJointCount; ++j) {
        if (j == 7) continue;
        JointRecord joint;
        const auto n = static_cast<double>(j);
        joint.position_m = {0.05 * n + b, 0.1 * std::sin(0.2 * f + n), 2.0 + 0.01 * f};
        joint.state = static_cast<TrackingState>(j % 3);
        joint.confidence = 0.5;
        // Placed unseen: of others that are not tracked a place says nothing (HasPlace).
        if (joint.state == TrackingState::kNotTracked) joint.reliability = 0.25;
        body.joints[j] = joint;
      }
      frame.bodies.push_back(body);
    }
    sequence.frames.push_back(frame);
  }
  return sequence;
}

/// What reading this text says; "" when it is read without complaint.
inline std::string ComplaintAbout(const std::string& text, const SkeletonReadOptions& options = {},
                                  const std::string& name = "file") {
  try {
    std::istringstream stream(text);
    ReadSkeletonStream(stream, name, options);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

/// Position of a joint of the first body of a frame.
inline Eigen::Vector3d At(const SkeletonSequence& sequence, size_t frame, Joint joint) {
  return sequence.frames.at(frame).bodies.at(0).joints[joint].value().position_m;
}

}  // namespace ossa::recon
