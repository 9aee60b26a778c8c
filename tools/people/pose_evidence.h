#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "depth/image/depth_frame.h"
#include "recon/refine/pose_network.h"

namespace ossa::people {

/// The joints that the pose network estimates for a candidate, with expected errors; nothing where
/// too little is visible. `pixels`: v * width + u.
std::optional<recon::NetworkPose> ReadPose(const recon::PoseNetwork& network,
                                           const depth::DepthFrame& frame,
                                           std::span<const int32_t> pixels);

/// The confidence of the network in its five most certain joints, because others may be occluded or
/// outside the image: the negative mean logarithm of their expected errors in metres. People have
/// about 2.5 to 4, other objects 1 to 2.3.
double MeasureCertainty(const recon::NetworkPose& pose);

/// Terms of the regression of ComputeScoreWithPose: a constant, the forest's log-odds, the
/// certainty.
std::array<double, 3> PoseTerms(double forest_score, double certainty);

/// Probability that a candidate is a person, by a logistic regression of the forest's score, [0,
/// 1], and the network's certainty (`ossa experiment person-classifier`). The network was trained
/// on people only, so that its errors are not those of the forest.
double ComputeScoreWithPose(double forest_score, double certainty);

/// Mean distance of the joints, metres: small for two parts of one person.
double MeasureDistance_m(const recon::NetworkPose& a, const recon::NetworkPose& b);

}  // namespace ossa::people
