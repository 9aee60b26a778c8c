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

/// Adds what is true of a frame beside its labels: skeletons, which of their joints are seen, floor
/// and time.
void AddTruth(std::vector<TruthBody> bodies, const ViewSample& view, int64_t index,
              LabelledFrame* frame);

/// Whether enough of the first person is seen for the frame to be worth anything.
bool ShowsEnough(const LabelledFrame& frame, const FrameOptions& options);

}  // namespace ossa::tools
