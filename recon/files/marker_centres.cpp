#include <Eigen/Geometry>
#include <cmath>
#include <optional>

#include "recon/files/marker_centres_internal.h"
#include "recon/files/skeleton_formats_internal.h"

namespace ossa::recon {
namespace {

// Constants: distances from a marker to its joint centre, by hand.

using Point = std::optional<Eigen::Vector3d>;

Point Marker(const Markers& markers, const std::string& name) {
  const auto found = markers.find(name);
  return found == markers.end() ? std::nullopt : Point(found->second);
}

Point Between(const Point& a, const Point& b) {
  if (!a || !b) return std::nullopt;
  return Eigen::Vector3d((*a + *b) / 2);
}

// Plug-in Gait's chord function: the centre is `width` away from the marker, perpendicular to the
// line to the proximal centre, in the plane of proximal centre, marker and a third point on the
// outer side.
Point Chord(const Point& proximal, const Point& marker, const Point& outer, double width_m) {
  if (!proximal || !marker || !outer) return std::nullopt;
  const Eigen::Vector3d line = *marker - *proximal;
  const double length_m = line.norm();
  if (length_m <= width_m) return std::nullopt;
  const Eigen::Vector3d axis = line / length_m;
  Eigen::Vector3d out = *outer - *proximal;
  out -= out.dot(axis) * axis;
  if (out.norm() < 1e-6) return std::nullopt;
  // The angle at the centre is a right one; its distances to the two ends are sqrt(l^2 - w^2) and
  // w.
  const double along_m = (length_m * length_m - width_m * width_m) / length_m;
  const double aside_m = width_m * std::sqrt(length_m * length_m - width_m * width_m) / length_m;
  return Eigen::Vector3d(*proximal + along_m * axis - aside_m * out.normalized());
}

struct Hips {
  Point left;
  Point right;
};

// Bell et al. 1990, as shares of the distance between the ASIS: 36 % inwards from the middle (14 %
// from each ASIS), 19 % back and 30 % down.
Hips HipCentres(const Markers& markers) {
  const Point left = Marker(markers, "LASI");
  const Point right = Marker(markers, "RASI");
  const Point back = Between(Marker(markers, "LPSI"), Marker(markers, "RPSI"));
  if (!left || !right || !back) return {};
  const Eigen::Vector3d across = *left - *right;
  const double width_m = across.norm();
  const Eigen::Vector3d middle = (*left + *right) / 2;
  const Eigen::Vector3d leftwards = across / width_m;
  Eigen::Vector3d backwards = *back - middle;
  backwards -= backwards.dot(leftwards) * leftwards;
  if (width_m < 1e-6 || backwards.norm() < 1e-6) return {};
  backwards.normalize();
  const Eigen::Vector3d down = backwards.cross(leftwards);  // the axes are right-handed
  const Eigen::Vector3d base = middle + width_m * (0.19 * backwards + 0.30 * down);
  return {Eigen::Vector3d(base + 0.36 * width_m * leftwards),
          Eigen::Vector3d(base - 0.36 * width_m * leftwards)};
}

void Put(BodyRecord& body, Joint joint, const Point& point) {
  if (point && point->allFinite()) PutJoint(body, joint, *point);
}

struct Side {
  const char* letter;
  Joint shoulder, elbow, wrist, hand, hip, knee, ankle, foot;
};

constexpr Side kSides[] = {
    {"L", Joint::kShoulderLeft, Joint::kElbowLeft, Joint::kWristLeft, Joint::kHandLeft,
     Joint::kHipLeft, Joint::kKneeLeft, Joint::kAnkleLeft, Joint::kFootLeft},
    {"R", Joint::kShoulderRight, Joint::kElbowRight, Joint::kWristRight, Joint::kHandRight,
     Joint::kHipRight, Joint::kKneeRight, Joint::kAnkleRight, Joint::kFootRight}};

void PutSide(BodyRecord& body, const Markers& markers, const Side& side, const Point& hip,
             const Point& trunk_down) {
  // By hand: typical laboratory values for adults, half the joint width plus half a marker.
  constexpr double kShoulder_m = 0.050;
  constexpr double kElbow_m = 0.047;
  constexpr double kKnee_m = 0.057;
  constexpr double kAnkle_m = 0.042;
  const auto marker = [&](const char* name) {
    return Marker(markers, side.letter + std::string(name));
  };
  Point shoulder = marker("SHO");
  if (shoulder && trunk_down) *shoulder += kShoulder_m * *trunk_down;
  const Point wrist = Between(marker("WRA"), marker("WRB"));
  // The outer side of the elbow is assumed to be away from the middle of the body: no third marker
  // determines it.
  const Point middle = Between(Marker(markers, "CLAV"), Marker(markers, "C7"));
  Point outer = marker("ELB");
  if (outer && shoulder && middle) *outer += *shoulder - *middle;
  const Point elbow = Chord(shoulder, marker("ELB"), outer, kElbow_m);
  const Point knee = Chord(hip, marker("KNE"), marker("THI"), kKnee_m);
  Put(body, side.shoulder, shoulder);
  Put(body, side.elbow, elbow);
  Put(body, side.wrist, wrist);
  Put(body, side.hand, marker("FIN"));
  Put(body, side.hip, hip);
  Put(body, side.knee, knee);
  Put(body, side.ankle, Chord(knee, marker("ANK"), marker("TIB"), kAnkle_m));
  Put(body, side.foot, marker("TOE"));
}

}  // namespace

bool IsTrunkMarker(const std::string& name) {
  for (const char* marker : {"LFHD", "RFHD", "LBHD", "RBHD", "C7", "T10", "CLAV", "STRN", "LASI",
                             "RASI", "LPSI", "RPSI"}) {
    if (name == marker) return true;
  }
  return false;
}

BodyRecord JointCentres(const Markers& markers) {
  BodyRecord body;
  const Hips hips = HipCentres(markers);
  const Point neck = Between(Marker(markers, "C7"), Marker(markers, "CLAV"));
  const Point pelvis = Between(hips.left, hips.right);
  Point trunk_down;
  if (neck && pelvis && (*pelvis - *neck).norm() > 1e-6) {
    trunk_down = (*pelvis - *neck).normalized();
  }
  Put(body, Joint::kHipCenter, pelvis);
  Put(body, Joint::kSpine, Between(Marker(markers, "T10"), Marker(markers, "STRN")));
  Put(body, Joint::kShoulderCenter, neck);
  Put(body, Joint::kHead,
      Between(Between(Marker(markers, "LFHD"), Marker(markers, "RFHD")),
              Between(Marker(markers, "LBHD"), Marker(markers, "RBHD"))));
  PutSide(body, markers, kSides[0], hips.left, trunk_down);
  PutSide(body, markers, kSides[1], hips.right, trunk_down);
  return body;
}

}  // namespace ossa::recon
