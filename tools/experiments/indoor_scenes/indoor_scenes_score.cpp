// Counts people found, split bodies, false bodies and identity switches.
#include <algorithm>

#include "tools/experiments/indoor_scenes/indoor_scenes_internal.h"
#include "tools/tracker/skeleton_record.h"

namespace ossa::tools {
namespace {

// Constants: by hand; do not change them, so that results stay comparable.

// If less of a person is visible, neither finding nor missing them counts.
constexpr double kInView_m2 = 0.10;
constexpr int kInViewJoints = 6;
constexpr double kLeastIou = 0.25;  // of a body and its person; a ratio of areas

struct Overlaps {
  std::vector<std::vector<double>> common;  // pixels of each body on each person
  std::vector<double> body, person;         // pixels of each
  std::vector<double> person_m2;
  double Iou(size_t b, size_t p) const {
    const double both = common[b][p];
    return both <= 0 ? 0.0 : both / (body[b] + person[p] - both);
  }
};

Overlaps CountOverlaps(const LabelledFrame& truth, const tracker::BodyFrame& answer) {
  const size_t bodies = answer.bodies.size(), people = truth.bodies.size();
  Overlaps o;
  o.common.assign(bodies, std::vector<double>(people, 0));
  o.body.assign(bodies, 0);
  o.person.assign(people, 0);
  o.person_m2.assign(people, 0);
  std::array<int, 256> body_of{};
  for (size_t b = 0; b < bodies; ++b)
    body_of[static_cast<size_t>(answer.bodies[b].id)] = static_cast<int>(b) + 1;
  const depth::Camera& camera = truth.depth.camera;
  for (size_t i = 0; i < truth.users.data.size(); ++i) {
    const auto b = static_cast<size_t>(body_of[answer.users.data[i]]);
    const size_t p = truth.users.data[i];
    if (b > 0) o.body[b - 1] += 1;
    if (b > 0 && p > 0) o.common[b - 1][p - 1] += 1;
    if (p == 0 || truth.depth.depth_mm[i] == 0) continue;
    const double z_m = depth::MetresFromMillimetres(truth.depth.depth_mm[i]);
    o.person[p - 1] += 1;
    o.person_m2[p - 1] += z_m * z_m / (camera.fx * camera.fy);
  }
  return o;
}

// Assigns a body to each person, best overlap first; -1: none.
std::vector<int> Match(const Overlaps& o) {
  std::vector<int> body_of(o.person.size(), -1);
  std::vector<uint8_t> taken(o.body.size(), 0);
  while (true) {
    double best = kLeastIou;
    size_t best_b = 0, best_p = 0;
    for (size_t b = 0; b < o.body.size(); ++b) {
      for (size_t p = 0; p < o.person.size(); ++p) {
        if (taken[b] || body_of[p] >= 0 || o.Iou(b, p) <= best) continue;
        best = o.Iou(b, p), best_b = b, best_p = p;
      }
    }
    if (best <= kLeastIou) return body_of;
    taken[best_b] = 1;
    body_of[best_p] = static_cast<int>(best_b);
  }
}

SparsePosture TrueJoints(const TruthBody& truth) {
  SparsePosture posture;
  posture.position_m = truth.joints_m.position_m;
  posture.present.fill(true);
  return posture;
}

SparsePosture VisibleJoints(const TruthBody& truth) {
  SparsePosture posture = TrueJoints(truth);
  std::copy(truth.visible.begin(), truth.visible.end(), posture.present.begin());
  return posture;
}

void Append(PairedTracks& to, const PairedTracks& more) {
  to.time_s.insert(to.time_s.end(), more.time_s.begin(), more.time_s.end());
  to.truth.insert(to.truth.end(), more.truth.begin(), more.truth.end());
  to.result.insert(to.result.end(), more.result.begin(), more.result.end());
}

}  // namespace

void IndoorScore::Add(const IndoorScore& other) {
  frames += other.frames;
  in_view += other.in_view;
  found += other.found;
  cut += other.cut;
  invented += other.invented;
  switches += other.switches;
  iou += other.iou;
  Append(raw, other.raw);
  Append(final, other.final);
  Append(raw_seen, other.raw_seen);
}

void IndoorEvaluator::AddPerson(const TruthBody& truth, const tracker::BodyFrame& answer, int body,
                                double time_s) {
  const auto joints = [&](tracker::PostureKind kind) {
    const auto record = tracker::ToRecord(answer, kind);
    return body < 0 ? SparsePosture{} : ToSparsePosture(record.bodies[static_cast<size_t>(body)]);
  };
  for (const auto& [track, kind] : {std::pair(&score.raw, tracker::PostureKind::kRaw),
                                    {&score.final, tracker::PostureKind::kFinal}}) {
    track->time_s.push_back(time_s);
    track->truth.push_back(TrueJoints(truth));
    track->result.push_back(joints(kind));
  }
  score.raw_seen.time_s.push_back(time_s);
  score.raw_seen.truth.push_back(VisibleJoints(truth));
  score.raw_seen.result.push_back(score.raw.result.back());
  if (body < 0) return;
  const int id = answer.bodies[static_cast<size_t>(body)].id;
  const auto before = id_of_person_.find(truth.id);
  score.switches += before != id_of_person_.end() && before->second != id ? 1 : 0;
  id_of_person_[truth.id] = id;
}

void IndoorEvaluator::AddFrame(const LabelledFrame& truth, const tracker::BodyFrame& answer) {
  const Overlaps o = CountOverlaps(truth, answer);
  const std::vector<int> body_of = Match(o);
  ++score.frames;
  for (size_t p = 0; p < truth.bodies.size(); ++p) {
    const auto& visible = truth.bodies[p].visible;
    const bool in_view = o.person_m2[p] >= kInView_m2 &&
                         std::count(visible.begin(), visible.end(), true) >= kInViewJoints;
    if (!in_view) continue;
    ++score.in_view;
    if (body_of[p] >= 0) {
      ++score.found;
      score.iou += o.Iou(static_cast<size_t>(body_of[p]), p);
    }
    AddPerson(truth.bodies[p], answer, body_of[p], truth.depth.time_s);
  }
  for (size_t b = 0; b < o.body.size(); ++b) {
    if (std::find(body_of.begin(), body_of.end(), static_cast<int>(b)) != body_of.end()) continue;
    double on_people = 0;
    for (const double common : o.common[b]) on_people += common;
    // A single body on a person of whom little is visible counts neither as found nor as false.
    const auto p = static_cast<size_t>(std::max_element(o.common[b].begin(), o.common[b].end()) -
                                       o.common[b].begin());
    const bool person = 2 * on_people > o.body[b];
    if (!person) ++score.invented;
    if (person && body_of[p] >= 0) ++score.cut;
  }
}

}  // namespace ossa::tools
