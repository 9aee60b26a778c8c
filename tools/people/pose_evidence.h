#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "depth/image/depth_frame.h"
#include "recon/refine/pose_network.h"

namespace ossa::people {

/// The joints that a candidate would have as a person, and how far off the network expects them to
/// be; nothing where too little is seen. `pixels`: v * width + u.
std::optional<recon::NetworkPose> ReadPose(const recon::PoseNetwork& network,
                                           const depth::DepthFrame& frame,
                                           std::span<const int32_t> pixels);

/// How sure the network is of the five joints that it is surest of, for others may be hidden or
/// outside the image: minus the mean logarithm of the errors that it expects, in metres. People
/// have about 2.5 to 4, other things 1 to 2.3.
double MeasureCertainty(const recon::NetworkPose& pose);

/// Terms of the regression below: a constant, the forest's log-odds, the certainty.
std::array<double, 3> PoseTerms(double forest_score, double certainty);

/// Probability that a candidate is a person, by the forest's word ([0, 1]) and the network's
/// certainty, which was learned from people alone and by other means. A logistic regression of both
/// (`ossa experiment person-classifier`).
double ComputeScoreWithPose(double forest_score, double certainty);

/// Mean distance of the joints, metres. Two pieces of one person have about the same.
double MeasureDistance_m(const recon::NetworkPose& a, const recon::NetworkPose& b);

}  // namespace ossa::people
