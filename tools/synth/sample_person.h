#pragma once
#include <Eigen/Core>
#include <vector>

#include "depth/base/random.h"
#include "recon/body/body_model.h"
#include "recon/body/clothing.h"
#include "tools/synth/view_sampler.h"

namespace ossa::tools {

/// A random body shape: men and women, one in six a child, thin to stout, 1.2-2.0 m tall. Train and
/// test shapes come from disjoint cells of muscle, weight and height.
recon::BodyShape SampleShape(Split split, Random& random);
/// As SampleShape(), but one in three is extreme: very small or tall, very thin or stout.
recon::BodyShape SampleAnyShape(Split split, Random& random);

recon::Clothing SampleClothing(Random& random);

/// In half of the draws also loose clothes and hair: T-shirts, coats, skirts, hoods, long hair.
recon::Clothing SampleHangingClothing(Random& random);

/// Thickness of gloves, metres; usually 0: none.
double SampleGloves_m(Random& random);

}  // namespace ossa::tools
