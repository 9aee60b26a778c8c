#include "tools/tracker/upright.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

#include "depth/image/turn.h"

namespace ossa::tracker {
namespace {

// The borders of an image, clockwise from the top.
constexpr std::array<unsigned, 4> kBorders = {kClippedTop, kClippedRight, kClippedBottom,
                                              kClippedLeft};

unsigned EdgesBefore(unsigned edges, int quarters) {
  unsigned before = 0;
  for (size_t i = 0; i < kBorders.size(); ++i) {
    const size_t turned = (i + static_cast<size_t>(quarters)) % kBorders.size();
    if ((edges & kBorders[turned]) != 0) before |= kBorders[i];
  }
  return before;
}

void TurnBack(recon::Posture& posture, const Eigen::Matrix3d& turn) {
  for (Eigen::Vector3d& position_m : posture.position_m) position_m = turn * position_m;
}

void TurnBack(recon::SurfaceFit& fit, const Eigen::Matrix3d& turn) {
  fit.pose.pelvis_m = turn * fit.pose.pelvis_m;
  Eigen::Matrix3d& camera_from_pelvis = fit.pose.parent_from_segment[0];
  camera_from_pelvis = turn * camera_from_pelvis;
  TurnBack(fit.joints_m, turn);
  TurnBack(fit.blended_m, turn);
  const Eigen::Quaterniond rotation(turn);
  for (Eigen::Quaterniond& camera_from : fit.camera_from_segment) {
    camera_from = rotation * camera_from;
  }
  for (Eigen::Matrix3d& covariance_m2 : fit.covariance_m2) {
    covariance_m2 = turn * covariance_m2 * turn.transpose();
  }
}

void TurnBack(Body& body, const Eigen::Matrix3d& turn, int quarters) {
  const Eigen::Quaterniond rotation(turn);
  body.position_m = turn * body.position_m;
  for (JointEstimate& joint : body.joints) {
    joint.position_m = turn * joint.position_m;
    joint.orientation = rotation * joint.orientation;
  }
  TurnBack(body.raw.posture, turn);
  for (auto& proposals : body.proposals) {
    for (JointProposal& proposal : proposals) proposal.position_m = turn * proposal.position_m;
  }
  if (body.refined) TurnBack(*body.refined, turn);
  if (body.fit) TurnBack(*body.fit, turn);
  TurnBack(body.reconstructed, turn);
  body.clipped_edges = EdgesBefore(body.clipped_edges, quarters);
}

void TurnBack(PartProbabilities& probabilities, int quarters) {
  depth::Image<int32_t> from(probabilities.width, probabilities.height);
  std::iota(from.data.begin(), from.data.end(), 0);
  from = depth::Turned(from, 4 - quarters);
  const auto classes = static_cast<size_t>(probabilities.classes);
  PartProbabilities turned{from.width, from.height, probabilities.classes, {}};
  turned.data.reserve(probabilities.data.size());
  for (const int32_t pixel : from.data) {
    const float* const of_pixel = probabilities.data.data() + static_cast<size_t>(pixel) * classes;
    turned.data.insert(turned.data.end(), of_pixel, of_pixel + classes);
  }
  probabilities = std::move(turned);
}

}  // namespace

void TurnBack(BodyFrame& frame, int quarters) {
  if (quarters == 0) return;
  const Eigen::Matrix3d turn = depth::CameraFromTurned(quarters);
  for (Body& body : frame.bodies) TurnBack(body, turn, quarters);
  if (frame.floor) frame.floor->head<3>() = turn * frame.floor->head<3>();
  for (people::Decision& decision : frame.decisions.candidates) {
    decision.place_m = turn * decision.place_m;
    decision.size_m = (turn * decision.size_m).cwiseAbs();
  }
  frame.users = depth::Turned(frame.users, 4 - quarters);
  frame.parts = depth::Turned(frame.parts, 4 - quarters);
  TurnBack(frame.probabilities, quarters);
}

// Scores at most `most` rotations, the current one first; if that has a certain person, the others
// are skipped, unless the first person is doubtful. True when the search is complete.
bool UprightFinder::ScoreRotations(const depth::DepthFrame& frame, int most,
                                   const ScoreOfTurn& score) {
  if (scored_ == 0) scores_ = {};
  for (; most > 0 && scored_ < kTurns; --most) {
    const int turn = (quarters_ + scored_++) % kTurns;
    const TurnScore found = score(frame, turn);
    scores_[static_cast<size_t>(turn)] = found.score;
    const bool decides = found.score >= options_.sure && (sure_ || !found.is_doubtful);
    if (turn == quarters_ && contested_ == 0 && decides) scored_ = kTurns;
  }
  return scored_ == kTurns;
}

int UprightFinder::FindBestTurn() const {
  const double present = scores_[static_cast<size_t>(quarters_)];
  if (present >= options_.sure) return quarters_;
  const auto best =
      static_cast<int>(std::max_element(scores_.begin(), scores_.end()) - scores_.begin());
  const double most = scores_[static_cast<size_t>(best)];
  return most >= options_.sure && most > present + options_.clearly ? best : -1;
}

bool UprightFinder::IsContested() const {
  return !sure_ &&
         std::ranges::count_if(scores_, [&](double score) { return score >= options_.sure; }) > 1;
}

std::optional<int> UprightFinder::CompareMeans() {
  ++contested_;
  for (size_t turn = 0; turn < sums_.size(); ++turn) sums_[turn] += scores_[turn];
  auto order = sums_;
  std::ranges::sort(order, std::greater<>());
  const int best = static_cast<int>(std::max_element(sums_.begin(), sums_.end()) - sums_.begin());
  const bool is_clear = order[0] - order[1] > options_.clearly * contested_;
  if (is_clear && (best == quarters_ || contested_ >= options_.agreeing)) return best;
  if (contested_ >= options_.most_contested) return quarters_;
  return std::nullopt;
}

// True if the rotation changed.
bool UprightFinder::Choose(int turn) {
  sure_ = true;
  agreeing_ = contested_ = 0;
  sums_ = {};
  return std::exchange(quarters_, turn) != turn;
}

bool UprightFinder::Update(const depth::DepthFrame& frame, const ScoreOfTurn& score) {
  const double since_s = frame.time_s - searched_s_, alone_s = frame.time_s - tracked_s_;
  const bool in_doubt = agreeing_ > 0 || contested_ > 0 || !std::isfinite(since_s);
  const double step_s = frame.time_s - std::exchange(previous_s_, frame.time_s);
  const bool is_shared = !in_doubt && step_s >= 0 && step_s < options_.shared_s;
  if (contested_ == 0 && alone_s >= 0 && alone_s < options_.every_s) {
    scored_ = 0;
    return false;
  }
  if (scored_ == 0 && !in_doubt && since_s >= 0 && since_s < options_.every_s) return false;
  if (scored_ == 0) searched_s_ = frame.time_s;
  if (!ScoreRotations(frame, is_shared ? 1 : kTurns, score)) return false;
  scored_ = 0;
  if (contested_ > 0 || IsContested()) {
    const auto turn = CompareMeans();
    return turn && Choose(*turn);
  }
  const int best = FindBestTurn();
  agreeing_ = best >= 0 && (agreeing_ == 0 || best == candidate_) ? agreeing_ + 1 : 0;
  candidate_ = best;
  return (best == quarters_ || agreeing_ >= options_.agreeing) && Choose(best);
}

}  // namespace ossa::tracker
