#pragma once
#include <array>

#include "recon/posture.h"

namespace ossa::physics {

/// Mechanical properties of one segment of the character: the bone that ends in a joint.
struct Segment {
  double length_m = 0.0;
  double mass_kg = 0.0;
  double radius_m = 0.0;                 // of its capsule
  double transverse_inertia_kgm2 = 0.0;  // about any axis across the bone, through its middle
  double axial_inertia_kgm2 = 0.0;       // about the bone
  double capsule_from = 0.0;             // start and end of the capsule's axis along the bone,
  double capsule_to = 1.0;               // as fractions of the length from the parent joint
};

/// Entry i is the bone that ends in joint i; entry 0 is unused.
using Segments = recon::JointArray<Segment>;

/// Stature from bone lengths: legs, trunk and head bones plus what lies beyond them (the foot's
/// height 0.039 H and half the head 0.065 H, Drillis & Contini 1966 as printed in Winter 2009).
double EstimateStature(const recon::BoneLengths& lengths);

/// Masses and radii of gyration of P. de Leva, "Adjustments to Zatsiorsky-Seluyanov's segment
/// inertia parameters", J. Biomechanics 29(9), 1996, table 4 (mean of men and women), applied to
/// the character's own bone lengths. Radii of arms, legs and feet are the table's within 2 %. Limb
/// radii follow from mass, length and tissue density; those of trunk, head, hands and feet from
/// breadths as fractions of stature (Winter 2009, fig. 4.1).
///
/// Departure: de Leva has three trunk segments, the Kinect skeleton five trunk bones. The lower
/// trunk is divided between the two hip bones, the middle trunk is the spine bone's, the upper
/// trunk is divided between the bone to the shoulder centre and the two shoulder bones.
/// Departure: centres of mass are in the middle of the bones (de Leva: 40-58 % along), because then
/// a bone's weight is distributed equally to its two joints, which gravity compensation and the
/// derivation of the control use.
///
/// `stature_m` and `mass_kg` of 0 are estimated: EstimateStature, and a body mass index of 22.
Segments ComputeSegments(const recon::BoneLengths& lengths, double stature_m = 0.0,
                         double mass_kg = 0.0);

/// Mass at each joint if every bone's mass is divided equally between its ends. Sums to the body
/// mass.
recon::JointArray<double> LumpedMasses(const Segments& segments);

}  // namespace ossa::physics
