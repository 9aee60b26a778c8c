#pragma once
#include <Eigen/Core>
#include <vector>

#include "depth/base/random.h"
#include "recon/body/body_model.h"
#include "recon/body/clothing.h"
#include "tools/synth/view_sampler.h"

namespace ossa::tools {

/// Shapes as they are among people: men and women, one in six a child, thin and stout, 1.2-2.0 m.
/// Train and test shapes come from disjoint cells of muscle, weight and height.
recon::BodyShape SampleShape(Split split, Random& random);
/// One in three is from the ends of the range: very small or tall, very thin or stout.
recon::BodyShape SampleAnyShape(Split split, Random& random);

recon::Clothing SampleClothing(Random& random);

/// In half of the draws also what hangs and falls in folds: T-shirts, coats, skirts, hoods, long
/// hair.
recon::Clothing SampleHangingClothing(Random& random);

/// How thick somebody's gloves are; 0: none, as of most.
double SampleGloves_m(Random& random);

}  // namespace ossa::tools
