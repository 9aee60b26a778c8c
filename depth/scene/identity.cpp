// Who is who from one frame to the next.
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "depth/scene/pieces.h"
#include "depth/scene/reidentify_internal.h"
#include "depth/scene/scene.h"

namespace ossa::depth {
namespace {

using Eigen::Vector3f;

// How far a person is from where a user is expected. Of somebody half hidden the middle of what is
// seen lies too high or too low: height says little.
double OffPredicted_m(const UserTrack& user, const Region& region, double time_s) {
  Vector3f off = PredictedMean_m(user, time_s) - region.mean_m;
  off.y() *= 0.3F;
  return static_cast<double>(off.norm());
}

double Gate_m(const UserTrack& user, double time_s, const SceneOptions& options) {
  const double gone_s = std::max(0.0, time_s - user.seen_s);
  return static_cast<double>(options.return_gate_m) +
         static_cast<double>(options.return_speed_m_s) * gone_s;
}

std::vector<float> DepthsOf(const PointGrid& grid, const Region& region) {
  std::vector<float> z_m;
  z_m.reserve(region.cells.size());
  for (const int cell : region.cells) z_m.push_back(grid.z(cell));
  return z_m;
}

// Cells of the user's surface that the person holds now.
size_t Common(const PointGrid& grid, const UserTrack& user, const Candidate& person) {
  size_t common = 0, i = 0;
  for (const int cell : person.region.cells) {
    while (i < user.cells.size() && user.cells[i] < cell) ++i;
    if (i < user.cells.size() && user.cells[i] == cell &&
        std::abs(user.z_m[i] - grid.z(cell)) < 0.15F) {
      ++common;
    }
  }
  return common;
}

// Cells both hold, as a share of the smaller.
double Overlap(const PointGrid& grid, const UserTrack& user, const Candidate& person) {
  if (user.cells.empty()) return 0;
  return static_cast<double>(Common(grid, user, person)) /
         static_cast<double>(std::min(user.cells.size(), person.region.cells.size()));
}

// Whose each cell is, as an index into `people`; -1 for nobody's.
std::vector<int> PersonOfCells(const PointGrid& grid, const std::vector<const Candidate*>& people) {
  std::vector<int> person_of(static_cast<size_t>(grid.cells()), -1);
  for (size_t p = 0; p < people.size(); ++p) {
    for (const int cell : people[p]->region.cells)
      person_of[static_cast<size_t>(cell)] = static_cast<int>(p);
  }
  return person_of;
}

// Which user each person goes on as by their cells; -1 for nobody. Of somebody whose pieces are
// taken for two people the one that holds most goes on, whichever was told to.
std::vector<int> TracksGoingOn(const PointGrid& grid, const std::vector<const Candidate*>& people,
                               const SceneState& state) {
  constexpr size_t kMuchMore = 2;  // times as many cells: ids do not go to and fro
  std::vector<int> track_of;
  for (const Candidate* person : people) track_of.push_back(person->track);
  for (size_t p = 0; p < people.size(); ++p) {
    if (people[p]->track < 0) continue;
    const UserTrack& user = state.users[static_cast<size_t>(people[p]->track)];
    size_t most = kMuchMore * Common(grid, user, *people[p]), heir = p;
    for (size_t other = 0; other < people.size(); ++other) {
      if (track_of[other] >= 0) continue;
      const size_t common = Common(grid, user, *people[other]);
      if (common > most) most = common, heir = other;
    }
    if (heir != p) std::swap(track_of[p], track_of[heir]);
  }
  return track_of;
}

// What came and is nobody yet may be one of the lost, too, and leaves the others to those who are
// somebody already.
std::vector<const Candidate*> Rivals(const Scene& scene, const std::vector<int>& person_of) {
  constexpr double kMostly = 0.5, kHardly = 0.1;
  std::vector<const Candidate*> rivals;
  for (const Candidate& candidate : scene.candidates) {
    if (candidate.track >= 0 || candidate.arrived_share <= kMostly || !candidate.returning)
      continue;
    const auto& cells = candidate.region.cells;
    const auto taken = std::count_if(cells.begin(), cells.end(), [&](int cell) {
      return person_of[static_cast<size_t>(cell)] >= 0;
    });
    if (static_cast<double>(taken) < kHardly * static_cast<double>(cells.size()))
      rivals.push_back(&candidate);
  }
  return rivals;
}

// Which user each person is: who goes on from the frame before, and all the others at once as those
// of the lost users they most likely are. -1 for somebody new.
std::vector<int> TracksOf(const Scene& scene, const std::vector<const Candidate*>& people,
                          const std::vector<int>& person_of, double time_s, const SceneState& state,
                          const SceneOptions& options) {
  std::vector<int> track_of = TracksGoingOn(scene.grid, people, state);
  std::vector<uint8_t> taken(state.users.size(), 0);
  std::vector<size_t> newcomers, lost;
  for (size_t p = 0; p < people.size(); ++p) {
    for (const int track : people[p]->absorbed) taken[static_cast<size_t>(track)] = 1;
    if (track_of[p] >= 0) taken[static_cast<size_t>(track_of[p])] = 1;
    if (track_of[p] < 0) newcomers.push_back(p);
  }
  for (size_t t = 0; t < state.users.size(); ++t) {
    if (!taken[t]) lost.push_back(t);
  }
  if (newcomers.empty() || lost.empty()) return track_of;
  std::vector<std::vector<double>> weight;
  const auto add = [&](const Candidate& person, int self, double less) {
    const Region& region = person.region;
    const Way way = WayOf(scene.grid, region.cells, DepthsOf(scene.grid, region), person_of, self);
    weight.emplace_back();
    for (const size_t t : lost) {
      const UserTrack& user = state.users[t];
      constexpr double kSameCells = 8;  // e^8 : 1 that what is where a user just was is that user
      const double overlap = time_s - user.seen_s < 0.5 ? Overlap(scene.grid, user, person) : 0.0;
      weight.back().push_back(
          LogLikelihoodRatio(scene.grid, user, person, way, time_s, options.reidentify) +
          (overlap > 0.3 ? kSameCells * overlap : 0.0) - less);
    }
  };
  constexpr double kNobodyYet = 1;  // e : 1 against it
  for (const size_t p : newcomers) add(*people[p], static_cast<int>(p), 0.0);
  for (const Candidate* rival : Rivals(scene, person_of)) add(*rival, -1, kNobodyYet);
  const std::vector<int> assigned = BestAssignment(weight, lost.size());
  for (size_t i = 0; i < newcomers.size(); ++i) {
    if (assigned[i] >= 0)
      track_of[newcomers[i]] = static_cast<int>(lost[static_cast<size_t>(assigned[i])]);
  }
  return track_of;
}

// Of those who were in view a moment ago.
void NoteWhereLost(const Scene& scene, const std::vector<int>& person_of, double time_s,
                   SceneState& state) {
  constexpr double kMoment_s = 0.2;  // then the last cells say nothing any more
  for (UserTrack& user : state.users) {
    if (user.seen_s == time_s || user.cells.empty()) continue;
    user.lost_behind =
        user.lost_behind || WayOf(scene.grid, user.cells, user.z_m, person_of, -1) == Way::kBehind;
    if (user.seen_s < time_s - kMoment_s) user.cells.clear(), user.z_m.clear();
  }
}

// While a good part of a person is hidden, the middle of the rest moves as the hiding thing does:
// the person is taken to go on as before, near what is seen of them.
void MoveHidden(UserTrack& user, const Region& region, double time_s) {
  constexpr float kFarthest_m = 0.35F;
  const Vector3f expected = PredictedMean_m(user, time_s) - region.mean_m;
  const float far_m = expected.norm();
  user.mean_m = region.mean_m + (far_m > kFarthest_m ? kFarthest_m / far_m : 1.0F) * expected;
}

// How far the body went from one look to the next, by what is seen of it in both: the mean of the
// middle half, for single marks jump. Nothing where there are too few.
std::optional<Vector3f> ShiftOf(const Marks& before_m, const Marks& now_m) {
  constexpr size_t kFewest = 4;
  std::array<std::vector<float>, 3> way_m;
  for (size_t i = 0; i < std::min(before_m.size(), now_m.size()); ++i) {
    if (!before_m[i] || !now_m[i]) continue;
    for (int axis = 0; axis < 3; ++axis)
      way_m[static_cast<size_t>(axis)].push_back((*now_m[i])[axis] - (*before_m[i])[axis]);
  }
  const size_t count = way_m[0].size();
  if (count < kFewest) return std::nullopt;
  Vector3f shift_m;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<float>& way = way_m[static_cast<size_t>(axis)];
    std::sort(way.begin(), way.end());
    const auto skipped = static_cast<std::ptrdiff_t>(count / 4);
    shift_m[axis] = std::accumulate(way.begin() + skipped, way.end() - skipped, 0.0F) /
                    static_cast<float>(static_cast<std::ptrdiff_t>(count) - 2 * skipped);
  }
  return shift_m;
}

// By marks on the body, where they are seen: also of who is half hidden. Else by the middle of the
// surface, which says nothing of who is half hidden: it moves as the hiding thing does.
template <class IsHidden>
void RenewVelocity(UserTrack& user, const Candidate& person, const IsHidden& is_hidden,
                   float dt_s) {
  // Shares of a new velocity in the next. Marks jump by centimetres: with shares of 0.5, 0.25, 0.15
  // and 0.1 the velocity sideways was off by 0.34, 0.25, 0.22 and 0.22 m/s (rms, people crossing,
  // half hidden); by the surface by 0.34.
  constexpr float kByMarks = 0.2F, kBySurface = 0.5F;
  constexpr float kFastest_m_s = 4;  // in view of a Kinect
  const auto shift_m = ShiftOf(user.marks_m, person.marks_m);
  const bool in_time = dt_s > 1e-3F && dt_s < 0.5F;
  if (!in_time || (!shift_m && user.cells.empty())) {
    user.velocity_m_s.setZero();
    user.steps = 0;
    return;
  }
  if (!shift_m && is_hidden()) return;
  ++user.steps;
  const float share =
      shift_m ? std::max(kByMarks, 1.0F / static_cast<float>(user.steps)) : kBySurface;
  Vector3f velocity = (shift_m ? *shift_m : person.region.mean_m - user.mean_m) / dt_s;
  velocity.y() = 0;  // nobody flies
  user.velocity_m_s += share * (velocity - user.velocity_m_s);
  const float fast = user.velocity_m_s.norm();
  if (fast > kFastest_m_s) user.velocity_m_s *= kFastest_m_s / fast;
}

void NoteMovement(UserTrack& user, const Region& region, double time_s) {
  if (user.first_m2 == 0) {
    user.first_mean_m = region.mean_m;
    user.first_m2 = region.area_m2;
  }
  if (user.rest_m2 == 0 || HasMoved(user.rest_mean_m, user.rest_m2, region)) {
    user.rest_mean_m = region.mean_m;
    user.rest_m2 = region.area_m2;
    user.moved_s = time_s;
  }
  user.moved = user.moved || HasMoved(user.first_mean_m, user.first_m2, region);
}

// `person_of` as in WayOf, where the person is `self`.
void Renew(UserTrack& user, const PointGrid& grid, const Candidate& person,
           const std::vector<int>& person_of, int self, double time_s) {
  constexpr float kHidden = 0.8F;  // of the surface seen lately
  const Region& region = person.region;
  const bool hidden = region.area_m2 < kHidden * user.full_m2;
  const auto is_hidden = [&] {
    return hidden ||
           WayOf(grid, region.cells, DepthsOf(grid, region), person_of, self) == Way::kBehind;
  };
  RenewVelocity(user, person, is_hidden, static_cast<float>(time_s - user.seen_s));
  if (hidden && !user.cells.empty()) {
    MoveHidden(user, region, time_s);
  } else {
    user.mean_m = region.mean_m;
  }
  if (!hidden) user.body.Add(person.body);  // of who is half hidden joints are guesses
  NoteMovement(user, region, time_s);
  constexpr float kForget = 0.99F;  // who turns sideways shows less for long
  user.full_m2 = std::max(region.area_m2, kForget * user.full_m2);
  user.cells = region.cells;
  user.z_m = DepthsOf(grid, region);
  user.marks_m = person.marks_m;
  user.seen_s = time_s;
  user.arrived_share = person.arrived_share;
  user.came = user.came || person.arrived_share > 0.5;
  user.lost_behind = false;
}

bool HasId(const std::vector<UserTrack>& users, int id) {
  return std::any_of(users.begin(), users.end(),
                     [&](const UserTrack& user) { return user.id == id; });
}

constexpr int kLargestId = 255;  // ids fit the user image's byte

// The next one in turn that nobody has, in view or remembered. See ForgetTooMany: there is one.
int TakeId(SceneState& state) {
  const auto next = [](int id) { return id % kLargestId + 1; };
  int id = state.next_id;
  while (HasId(state.users, id)) id = next(id);
  state.next_id = next(id);
  return id;
}

// Where time stands still nobody is out of view for too long, but ids are not to run out: then who
// came first of those out of view goes. Half of the ids stay free for the next frame.
void ForgetTooMany(const std::vector<int>& ids, SceneState& state) {
  constexpr size_t kMost = kLargestId / 2;
  size_t too_many = std::max(state.users.size(), kMost) - kMost;
  std::erase_if(state.users, [&](const UserTrack& user) {
    const bool goes = too_many > 0 && std::find(ids.begin(), ids.end(), user.id) == ids.end();
    too_many -= goes ? 1 : 0;
    return goes;
  });
}

// Who turned out to be part of somebody else is nobody, and may not claim cells again.
void ForgetAbsorbed(const std::vector<const Candidate*>& people, const std::vector<int>& ids,
                    SceneState& state) {
  std::vector<int> absorbed;
  for (const Candidate* person : people) {
    for (const int track : person->absorbed)
      absorbed.push_back(state.users[static_cast<size_t>(track)].id);
  }
  const auto among = [](const std::vector<int>& all, int id) {
    return std::find(all.begin(), all.end(), id) != all.end();
  };
  std::erase_if(state.users, [&](const UserTrack& user) {
    return among(absorbed, user.id) && !among(ids, user.id);
  });
}

}  // namespace

bool HasMoved(const Vector3f& first_mean_m, float first_m2, const Region& now) {
  constexpr float kStep_m = 0.05F, kChange = 0.15F;
  return (now.mean_m - first_mean_m).norm() > kStep_m ||
         std::abs(now.area_m2 - first_m2) > kChange * first_m2;
}

Vector3f PredictedMean_m(const UserTrack& user, double time_s) {
  // A person does not keep walking straight for long: predict for at most half a second.
  const auto dt = static_cast<float>(std::clamp(time_s - user.seen_s, 0.0, 0.5));
  return user.mean_m + dt * user.velocity_m_s;
}

bool IsForgotten(const UserTrack& user, double time_s, const ReidentifyOptions& options) {
  const double forget_s = user.lost_behind ? options.forget_behind_s : options.forget_s;
  return time_s - user.seen_s > forget_s;
}

bool MayReturnAs(const UserTrack& user, const Region& region, double time_s,
                 const SceneOptions& options) {
  return time_s - user.seen_s < options.reidentify.forget_s &&
         OffPredicted_m(user, region, time_s) < Gate_m(user, time_s, options);
}

std::vector<int> ConfirmUsers(const Scene& scene, const std::vector<const Candidate*>& people,
                              double time_s, SceneState& state, const SceneOptions& options) {
  for (UserTrack& user : state.users) {
    if (time_s < user.seen_s) user.seen_s = time_s;  // the clock went back: a new recording
  }
  const std::vector<int> person_of = PersonOfCells(scene.grid, people);
  std::vector<int> track_of = TracksOf(scene, people, person_of, time_s, state, options);
  std::vector<int> ids;
  std::vector<uint8_t> claimed(static_cast<size_t>(scene.grid.cells()), 0);
  for (size_t p = 0; p < people.size(); ++p) {
    if (track_of[p] < 0) {
      track_of[p] = static_cast<int>(state.users.size());
      UserTrack newcomer;
      newcomer.id = TakeId(state);
      state.users.push_back(std::move(newcomer));
    }
    UserTrack& user = state.users[static_cast<size_t>(track_of[p])];
    Renew(user, scene.grid, *people[p], person_of, static_cast<int>(p), time_s);
    ids.push_back(user.id);
    for (const int cell : people[p]->region.cells) claimed[static_cast<size_t>(cell)] = 1;
  }
  ForgetAbsorbed(people, ids, state);
  std::erase_if(state.users, [&](const UserTrack& user) {
    return IsForgotten(user, time_s, options.reidentify);
  });
  ForgetTooMany(ids, state);
  NoteWhereLost(scene, person_of, time_s, state);
  LearnBackground(scene.grid, claimed, state.background, options.background);
  return ids;
}

}  // namespace ossa::depth
