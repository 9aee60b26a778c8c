// People on the floor, who hardly score and are missed now and then.
#include "tests/tools/people/scenes.h"

namespace ossa::people {
namespace {

constexpr double kScore = 0.01;  // of somebody who lies there

// Somebody who came into a room that was empty before, and ends up close to the floor or stands.
class LowPerson : public testing::Test {
 protected:
  explicit LowPerson(double height_m = 0.75) {
    pose_.height_m = height_m;
    for (; frame_ < 40; ++frame_) See(Shot({}, frame_));
  }

  // One frame, in which the candidates are accepted or not; the frame's time.
  double See(const CapsuleRender& render, bool accepts = true) {
    const Proposed proposed = Propose(render, state_);
    Confirm(proposed, accepts ? proposed.candidates : std::vector<Candidate>{}, render.frame.time_s,
            state_, {}, kScore);
    return render.frame.time_s;
  }
  double SeePerson(bool accepts = true) { return See(Shot({pose_}, frame_++), accepts); }
  // The track of somebody who was a person for sure until now.
  Track& Recognise() {
    const double time_s = SeePerson();
    EXPECT_EQ(state_.tracks.tracks.size(), 1U);
    Track& track = state_.tracks.tracks.at(0);
    track.certain_until_s = time_s + 0.1;
    return track;
  }
  // The share of them that is certainly the room, after being missed in five frames of six, more often
  // than the empty room was seen.
  double MissAndMeasureRoom() {
    constexpr int kFrames = 60;
    for (int i = 0; i < kFrames; ++i) SeePerson(i % 6 == 0);
    const Proposed proposed = Propose(Shot({pose_}, frame_), state_);
    const auto& cells = state_.tracks.tracks.at(0).cells;
    EXPECT_FALSE(cells.empty());
    const auto known = std::count_if(cells.begin(), cells.end(), [&](int cell) {
      return proposed.scene.background.certain[static_cast<size_t>(cell)] != 0;
    });
    return static_cast<double>(known) / static_cast<double>(cells.size());
  }

  CapsulePose pose_ = PersonAt(0.0, 2.6);
  int frame_ = 0;
  PeopleState state_;
};

TEST_F(LowPerson, StaysAPersonForSureWhileTheyMoveNowAndThen) {
  Track& track = Recognise();
  double time_s = 0.0;
  for (int i = 0; i < 30; ++i) time_s = SeePerson();
  EXPECT_GT(track.certain_until_s, time_s + 10.0);
  track.moved_s = time_s - AssociationOptions{}.lying_s;
  const double until_s = track.certain_until_s;
  SeePerson();
  EXPECT_EQ(track.certain_until_s, until_s);
}

TEST_F(LowPerson, WhoWasNoneForSureDoesNotBecomeOne) {
  Track& track = Recognise();
  track.certain_until_s = 0.0;
  for (int i = 0; i < 30; ++i) SeePerson();
  EXPECT_EQ(track.certain_until_s, 0.0);
}

struct StandingPerson : LowPerson {
  StandingPerson() : LowPerson(1.75) {}
};

TEST_F(StandingPerson, WhoScoresLowIsNoneForSureAfterAWhile) {
  Track& track = Recognise();
  const double until_s = track.certain_until_s;
  for (int i = 0; i < 30; ++i) SeePerson();
  EXPECT_EQ(track.certain_until_s, until_s);
}

TEST_F(LowPerson, IsNotLearnedAsTheRoomWhileMissed) {
  Recognise().certain_until_s = 1e9;
  EXPECT_EQ(MissAndMeasureRoom(), 0.0);
}

TEST_F(LowPerson, WhoWasNoneForSureIsLearnedAsTheRoom) {
  Recognise().certain_until_s = 0.0;
  EXPECT_GT(MissAndMeasureRoom(), 0.5);
}

}  // namespace
}  // namespace ossa::people
