#pragma once
#include <Eigen/Core>
#include <map>
#include <string>

#include "recon/skeleton_sequence.h"

namespace ossa::recon {

/// Marker positions of one frame by Plug-in Gait name (LSHO, RASI, ...); markers not seen are not
/// there. Metres, any right-handed axes.
using Markers = std::map<std::string, Eigen::Vector3d>;

/// Joint centres from Plug-in Gait markers, as far as the markers are there. Generic: no subject
/// measurements, so expect constant offsets of 2-4 cm. Head: mean of the head markers; shoulder:
/// 50 mm below SHO along the trunk; elbow, knee, ankle: the chord construction with half joint
/// widths 47, 57 and 42 mm; wrist: between WRA and WRB; hip: Bell's regression on the width between
/// the ASIS; HipCenter: between the hips; ShoulderCenter: between C7 and CLAV; Spine: between T10
/// and STRN; hand: FIN; foot: TOE.
BodyRecord JointCentres(const Markers& markers);

/// Whether the name is that of one of these markers on head or trunk.
bool IsTrunkMarker(const std::string& name);

}  // namespace ossa::recon
