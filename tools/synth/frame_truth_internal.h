#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "depth/render/renderer.h"
#include "depth/render/structured_light.h"
#include "tools/synth/dataset.h"
#include "tools/synth/frame_maker.h"
#include "tools/synth/props.h"
#include "tools/synth/view_sampler.h"

namespace ossa::tools {

/// Labels the pixels that show props, after LabelPeople() has labelled the people's; `prop_mesh[i]`
/// is the renderer's mesh of props[i]. Without a background, other pixels read no depth.
void LabelProps(const depth::RenderedImage& seen, std::span<const Prop> props,
                std::span<const int> prop_mesh, Background background, depth::SensorImage* sensed,
                LabelledFrame* frame);

/// Adds the rest of the ground truth: skeletons with the visibility of their joints, floor and
/// time.
void AddTruth(std::vector<TruthBody> bodies, const ViewSample& view, int64_t index,
              LabelledFrame* frame);

/// True if enough of the first person is visible for the frame to be used.
bool ShowsEnough(const LabelledFrame& frame, const FrameOptions& options);

}  // namespace ossa::tools
