#pragma once
#include "forest/network.h"
#include "recon/models/rectified_network.h"

namespace ossa::tools {

/// Learns a network of examples whose inputs are as they come; they are normalised in place.
recon::RectifiedNetwork LearnRectifiedNetwork(forest::NetworkExamples* examples,
                                              const forest::LossGradient& gradient,
                                              const forest::NetworkOptions& options);

/// Of outputs that are points of three numbers each: the gradient of their errors' mean length,
/// smooth below `soft`. Points that are not finite are not known.
forest::LossGradient GradientOfLengths(float soft);

/// Of outputs that are numbers: the gradient of their errors' mean absolute value, smooth below
/// `soft`.
forest::LossGradient GradientOfNumbers(float soft);

}  // namespace ossa::tools
