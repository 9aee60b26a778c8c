#pragma once
#include "depth/image/depth_frame.h"
#include "depth/scene/measure_scene.h"
#include "depth/scene/regions.h"

/// The geometry types of depth/ under their own names.
namespace ossa::people {

using depth::DepthFrame;
using depth::FlatPlane;
using depth::FloorPlane;
using depth::PointGrid;
using depth::Region;
using depth::RoomShape;
using depth::Scene;

}  // namespace ossa::people
