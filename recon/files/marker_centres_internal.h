#pragma once
#include <Eigen/Core>
#include <map>
#include <string>

#include "recon/skeleton_sequence.h"

namespace ossa::recon {

/// Marker positions of one frame by Plug-in Gait name (LSHO, RASI, ...); unseen markers are absent.
/// Metres, any right-handed axes.
using Markers = std::map<std::string, Eigen::Vector3d>;

/// Joint centres from Plug-in Gait markers, as far as their markers were seen. No subject
/// measurements are used, so constant offsets of 2-4 cm remain. Head: mean of the head markers;
/// shoulder: 50 mm below SHO along the trunk; elbow, knee, ankle: the chord function with half
/// joint widths of 47, 57 and 42 mm; wrist: middle of WRA and WRB; hip: Bell's regression on the
/// distance between the ASIS; HipCenter: middle of the hips; ShoulderCenter: middle of C7 and CLAV;
/// Spine: middle of T10 and STRN; hand: FIN; foot: TOE.
BodyRecord JointCentres(const Markers& markers);

/// Whether the name is that of one of these markers on head or trunk.
bool IsTrunkMarker(const std::string& name);

}  // namespace ossa::recon
