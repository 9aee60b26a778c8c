#include "recon/files/point_bodies_internal.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>

#include "depth/base/error.h"
#include "depth/base/lower_case.h"
#include "recon/files/joint_names_internal.h"
#include "recon/files/marker_centres_internal.h"
#include "recon/files/skeleton_formats_internal.h"
#include "recon/motion/text_scanner_internal.h"
#include "recon/motion/up_axis_internal.h"
#include "recon/smallest_turn.h"

namespace ossa::recon {
namespace {

/// The labels of one subject.
struct Subject {
  std::string name;
  std::vector<size_t> points;
  std::vector<std::string> labels;  // without the subject prefix
};

std::vector<Subject> GroupBySubject(const std::vector<std::string>& labels) {
  std::vector<Subject> subjects;
  for (size_t p = 0; p < labels.size(); ++p) {
    const size_t colon = labels[p].rfind(':');
    const std::string name = colon == std::string::npos ? "" : labels[p].substr(0, colon);
    auto subject = std::find_if(subjects.begin(), subjects.end(),
                                [&](const Subject& s) { return s.name == name; });
    if (subject == subjects.end()) {
      subjects.push_back({name, {}, {}});
      subject = std::prev(subjects.end());
    }
    subject->points.push_back(p);
    subject->labels.emplace_back(
        Trimmed(std::string_view(labels[p]).substr(colon == std::string::npos ? 0 : colon + 1)));
  }
  return subjects;
}

/// The points named by a mapping line: "LKNE + LKNEM" is the middle of two. Empty if the subject
/// lacks one of them.
std::vector<size_t> FindNamed(const Subject& subject, std::string_view names) {
  constexpr std::string_view kAnd = " + ";
  std::vector<size_t> points;
  while (!names.empty()) {
    const size_t end = names.find(kAnd);
    const std::string_view name = Trimmed(names.substr(0, end));
    const auto own = std::find_if(subject.labels.begin(), subject.labels.end(), [&](const auto& l) {
      return l == name || subject.name + ":" + l == name;
    });
    if (own == subject.labels.end()) return {};
    points.push_back(subject.points[static_cast<size_t>(own - subject.labels.begin())]);
    names.remove_prefix(end == std::string_view::npos ? names.size() : end + kAnd.size());
  }
  return points;
}

bool HasJoints(const PointBody& body) {
  return !body.markers.empty() || std::any_of(body.points.begin(), body.points.end(),
                                              [](const auto& points) { return !points.empty(); });
}

PointBody FindMapped(const Subject& subject, const BoneMapping& mapping, const LabelPlace& place) {
  PointBody body;
  const MappingLine* missing = nullptr;
  for (const MappingLine& line : mapping.lines) {
    const std::vector<size_t> points = FindNamed(subject, line.joint);
    if (points.empty() && missing == nullptr) missing = &line;
    // Bones that start at none of our joints, such as collars, are used for mocap only.
    const auto joint = FindJointOfBone(line.bone);
    if (joint) body.points[Index(*joint)] = points;
  }
  if (HasJoints(body) && missing != nullptr) {
    FailInMapping(mapping, *missing, "a point of " + place.file);
  }
  return body;
}

// Whether the label is a marker on the skin (LSHO, LELB, ...); joint centres are computed from all
// of them.
bool IsSkinMarker(const std::string& label) {
  return label.size() == 4 && (label.ends_with("SHO") || label.ends_with("ELB") ||
                               label.ends_with("KNE") || label.ends_with("ANK"));
}

// SDK 2 lists Neck, which is above SpineShoulder, before it. Its neck is our ShoulderCenter only if
// no other point is at the base of the neck.
bool IsNeckAboveItsBase(const Subject& subject, const std::string& label) {
  if (LowerCase(label) != "neck") return false;
  return std::any_of(subject.labels.begin(), subject.labels.end(), [](const std::string& other) {
    return LowerCase(other) != "neck" && FindJointByName(other) == Joint::kShoulderCenter;
  });
}

// Takes the first of several points of one joint; the labels of the others go to `others`.
PointBody FindJointsByName(const Subject& subject, bool skin, std::vector<std::string>& others) {
  PointBody body;
  for (size_t p = 0; p < subject.points.size(); ++p) {
    const auto joint = FindJointByName(subject.labels[p]);
    if (!joint || IsSkinMarker(subject.labels[p]) != skin) continue;
    if (IsNeckAboveItsBase(subject, subject.labels[p])) continue;
    auto& points = body.points[Index(*joint)];
    if (points.empty()) {
      points.push_back(subject.points[p]);
    } else {
      others.push_back(subject.labels[p]);
    }
  }
  return body;
}

PointBody FindMarkers(const Subject& subject) {
  PointBody body;
  const bool trunk = std::any_of(subject.labels.begin(), subject.labels.end(), IsTrunkMarker);
  for (size_t p = 0; trunk && p < subject.points.size(); ++p) {
    body.markers.emplace_back(subject.points[p], subject.labels[p]);
  }
  return body;
}

// JOINT_LEFT_ELBOW of NiTE and Nuitrack, K4ABT_JOINT_NECK, JointType_Head: without what all labels
// begin with.
Subject WithoutCommonBeginning(Subject subject) {
  std::string_view common = subject.labels.front();
  for (const std::string& label : subject.labels) {
    const auto differ = std::mismatch(common.begin(), common.end(), label.begin(), label.end());
    common = common.substr(0, static_cast<size_t>(differ.first - common.begin()));
  }
  const size_t end = common.find_last_of("_.- ");
  const size_t length = end == common.npos ? 0 : end + 1;
  for (std::string& label : subject.labels) label.erase(0, length);
  return subject;
}

PointBody FindBody(const Subject& subject, const BoneMapping* mapping, const LabelPlace& place,
                   std::vector<std::string>& others) {
  if (mapping != nullptr) {
    const PointBody mapped = FindMapped(subject, *mapping, place);
    if (HasJoints(mapped)) return mapped;
  }
  PointBody body = FindJointsByName(subject, false, others);
  if (!HasJoints(body)) body = FindMarkers(subject);
  if (!HasJoints(body)) body = FindJointsByName(subject, true, others);
  return HasJoints(body) ? body : FindJointsByName(WithoutCommonBeginning(subject), false, others);
}

std::string ListLabels(const std::vector<std::string>& labels) {
  constexpr size_t kMostListed = 60;  // by hand: what fits a line
  std::string list;
  size_t named = 0;
  for (const std::string& label : labels) {
    if (label.empty() || ++named > kMostListed) continue;
    list.append(named == 1 ? "" : ", ").append(Quoted(label));
  }
  if (named > kMostListed) list += fmt::format(" and {} more", named - kMostListed);
  return named == 0 ? "none" : list;
}

// Warns if only a few joints are known among many markers: users may believe that all were read.
void WarnOfUnknown(const std::vector<PointBody>& bodies, const std::vector<std::string>& labels,
                   const LabelPlace& place, std::vector<std::string>& warnings) {
  constexpr size_t kFew = 6;  // by hand: a limb or two
  size_t known = 0;
  for (const PointBody& body : bodies) {
    if (!body.markers.empty()) return;
    for (const auto& points : body.points) known += points.size();
  }
  if (known >= kFew || known == labels.size()) return;
  warnings.push_back(
      fmt::format("{}: {}: only {} of the points are known as joints: {}; --mapping FILE names "
                  "others, in lines such as ElbowLeft = {}",
                  place.file, place.place, known, ListLabels(labels), labels.back()));
}

// Warns of duplicate points of a joint: nothing else shows which one was read.
void WarnOfOthers(const std::vector<std::string>& others, const LabelPlace& place,
                  std::vector<std::string>& warnings) {
  if (others.empty()) return;
  warnings.push_back(
      fmt::format("{}: {}: not read: {}, for points before are of the same joints; --mapping FILE "
                  "names others",
                  place.file, place.place, ListLabels(others)));
}

BodyRecord MakeBody(const PointBody& body, const std::vector<SeenPoint>& points) {
  if (!body.markers.empty()) {
    Markers markers;
    for (const auto& [point, name] : body.markers) {
      if (points[point]) markers[name] = *points[point];
    }
    return JointCentres(markers);
  }
  BodyRecord made;
  for (size_t j = 0; j < kJointCount; ++j) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    const auto seen = [&](size_t point) { return points[point].has_value(); };
    if (body.points[j].empty() ||
        !std::all_of(body.points[j].begin(), body.points[j].end(), seen)) {
      continue;
    }
    for (const size_t point : body.points[j]) sum += *points[point];
    PutJoint(made, static_cast<Joint>(j), sum / static_cast<double>(body.points[j].size()));
  }
  return made;
}

/// The first of `joints` that was seen, else the middle of `left` and `right`.
SeenPoint FindAnyOf(const BodyRecord& body, std::initializer_list<Joint> joints, Joint left,
                    Joint right) {
  for (const Joint joint : joints) {
    if (body.joints[Index(joint)]) return body.joints[Index(joint)]->position_m;
  }
  const auto &one = body.joints[Index(left)], &other = body.joints[Index(right)];
  if (!one || !other) return std::nullopt;
  return Eigen::Vector3d((one->position_m + other->position_m) / 2);
}

/// Mean trunk direction of all people in all frames: length 1 if all agree; 0 if no trunk is seen.
Eigen::Vector3d ComputeMeanTrunk(const SkeletonSequence& sequence) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  size_t seen = 0;
  for (const SkeletonFrame& frame : sequence.frames) {
    for (const BodyRecord& body : frame.bodies) {
      const SeenPoint low = FindAnyOf(body, {Joint::kHipCenter}, Joint::kHipLeft, Joint::kHipRight);
      const SeenPoint high = FindAnyOf(body, {Joint::kShoulderCenter, Joint::kHead},
                                       Joint::kShoulderLeft, Joint::kShoulderRight);
      if (!low || !high || (*high - *low).norm() < 1e-6) continue;
      sum += (*high - *low).normalized();
      ++seen;
    }
  }
  return sum / static_cast<double>(std::max<size_t>(seen, 1));
}

template <typename Sequence, typename Use>
void ForEachPlace(Sequence& sequence, Use use) {
  for (auto& frame : sequence.frames) {
    for (auto& body : frame.bodies) {
      for (auto& joint : body.joints) {
        if (joint) use(joint->position_m);
      }
    }
  }
}

/// Whether the lowest joint is at standing height over a floor at 0.
bool HasFloorAt0(const SkeletonSequence& sequence, const Eigen::Vector3d& up) {
  constexpr double kThrough_m = -0.05, kHigh_m = 0.25;  // by hand: standing ankles are at 0.1 m
  double lowest_m = std::numeric_limits<double>::infinity();
  ForEachPlace(sequence,
               [&](const Eigen::Vector3d& p) { lowest_m = std::min(lowest_m, p.dot(up)); });
  return lowest_m > kThrough_m && lowest_m < kHigh_m;
}

void TurnAll(SkeletonSequence& sequence, const Eigen::Quaterniond& turn) {
  ForEachPlace(sequence, [&](Eigen::Vector3d& p) { p = turn * p; });
}

}  // namespace

std::vector<PointBody> FindPointBodies(const std::vector<std::string>& labels,
                                       const BoneMapping* mapping, const LabelPlace& place,
                                       std::vector<std::string>& warnings) {
  std::vector<PointBody> bodies;
  std::vector<std::string> others;
  for (const Subject& subject : GroupBySubject(labels)) {
    PointBody body = FindBody(subject, mapping, place, others);
    if (HasJoints(body)) bodies.push_back(std::move(body));
  }
  if (bodies.empty()) {
    throw InputError(fmt::format(
        "{}: {}: expected points named as joints (such as ElbowLeft, LElbow, LEJC) or Plug-in "
        "Gait's markers, found {}: say in a file for --mapping which they are, in lines such as "
        "ElbowLeft = {}",
        place.file, place.place, ListLabels(labels), labels.empty() ? "name" : labels.front()));
  }
  WarnOfUnknown(bodies, labels, place, warnings);
  WarnOfOthers(others, place, warnings);
  return bodies;
}

SkeletonFrame MakeFrame(const std::vector<PointBody>& bodies, const std::vector<SeenPoint>& points,
                        size_t index, double time_s) {
  SkeletonFrame frame;
  frame.frame = static_cast<int64_t>(index);
  frame.time_s = time_s;
  for (const PointBody& body : bodies) {
    BodyRecord& record = frame.bodies.emplace_back(MakeBody(body, points));
    record.id = static_cast<int>(frame.bodies.size());
  }
  return frame;
}

void RotateUpright(SkeletonSequence& sequence, const AlternativeUpAxis& other) {
  const Eigen::Vector3d y = Eigen::Vector3d::UnitY(), trunk = ComputeMeanTrunk(sequence);
  if (IsUpright(trunk, y)) return;
  const bool shows = IsUpright(trunk, other.axis) && HasFloorAt0(sequence, other.axis) &&
                     !HasFloorAt0(sequence, y);
  if (!other.is_in_file && !shows) {
    const std::string doubt = DescribeUpDoubt(sequence.source, trunk, y);
    if (!doubt.empty()) sequence.warnings.push_back(doubt);
    return;
  }
  TurnAll(sequence, SmallestTurn(other.axis, y));
  if (!other.is_in_file) {
    sequence.warnings.push_back(fmt::format("{}: the body stands along {}: {} is taken as up",
                                            sequence.source, other.name, other.name));
  }
}

void TurnFromImageAxes(SkeletonSequence& sequence) {
  if (!IsUpright(ComputeMeanTrunk(sequence), -Eigen::Vector3d::UnitY())) return;
  TurnAll(sequence, Eigen::Quaterniond(0.0, 0.0, 0.0, 1.0));  // half a turn about z
  sequence.warnings.push_back(sequence.source +
                              ": the body stands along -y: the axes are taken as an image's, x to "
                              "the right and y down");
}

std::optional<double> MetresPerUnit(std::string_view unit) {
  static const std::map<std::string, double, std::less<>> kUnits = {
      {"mm", 1e-3},          {"millimeters", 1e-3},
      {"millimetres", 1e-3}, {"millimeter", 1e-3},
      {"cm", 1e-2},          {"centimeters", 1e-2},
      {"centimetres", 1e-2}, {"centimeter", 1e-2},
      {"dm", 1e-1},          {"m", 1.0},
      {"meters", 1.0},       {"metres", 1.0},
      {"meter", 1.0},        {"metre", 1.0},
      {"in", 0.0254},        {"inch", 0.0254},
      {"inches", 0.0254}};
  const auto found = kUnits.find(LowerCase(unit));
  if (found == kUnits.end()) return std::nullopt;
  return found->second;
}

}  // namespace ossa::recon
