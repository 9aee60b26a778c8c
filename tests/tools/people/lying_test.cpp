// People on the floor, who hardly score and are missed now and then.
#include "tests/tools/people/scenes.h"

namespace ossa::people {
namespace {

constexpr double kScore = 0.01;  // of somebody who lies there

// Somebody who came into a room that was empty before, and ends up close to the floor or stands.
class LowPerson : public testing::Test {
 protected:
  explicit LowPerson(double height_m = 0.7) {
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
  void ExpectCertainForNoLonger() {
    Track& track = Recognise();
    const double until_s = track.certain_until_s;
    track.moved_s = -1e3;
    for (int i = 0; i < 30; ++i) SeePerson();
    EXPECT_EQ(track.certain_until_s, until_s);
  }
  void ExpectCertainSinceTheLastMovement() {
    Track& track = Recognise();
    SeePerson();
    EXPECT_EQ(track.certain_until_s, track.moved_s + AssociationOptions{}.certain_s);
  }
  // Frames of which five in six miss them: as many as the empty room was seen in are 48.
  void Miss(int frames) {
    for (int i = 0; i < frames; ++i) SeePerson(i % 6 == 0);
  }
  // The share of their surface that is the unchanged room, by one of the background's masks.
  double MeasureRoom(std::vector<uint8_t> depth::BackgroundMasks::*mask) {
    const Proposed proposed = Propose(Shot({pose_}, frame_), state_);
    const auto& cells = state_.tracks.tracks.at(0).cells;
    EXPECT_FALSE(cells.empty());
    const auto known = std::count_if(cells.begin(), cells.end(), [&](int cell) {
      return (proposed.scene.background.*mask)[static_cast<size_t>(cell)] != 0;
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
  EXPECT_EQ(track.lay_s, time_s);
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
// As high as the back of a chair, whose middle is low.
struct SeatedPerson : LowPerson {
  SeatedPerson() : LowPerson(0.9) {}
};

TEST_F(StandingPerson, WhoScoresLowIsNoneForSureAfterAWhile) { ExpectCertainForNoLonger(); }
TEST_F(SeatedPerson, WhoScoresLowIsNoneForSureAfterAWhile) { ExpectCertainForNoLonger(); }
TEST_F(StandingPerson, WhoMovedNotLongAgoIsOneForSure) { ExpectCertainSinceTheLastMovement(); }
TEST_F(SeatedPerson, WhoMovedNotLongAgoIsOneForSure) { ExpectCertainSinceTheLastMovement(); }

TEST_F(LowPerson, IsNotLearnedAsTheRoomWhileMissed) {
  Recognise().certain_until_s = 1e9;
  Miss(60);
  EXPECT_EQ(MeasureRoom(&depth::BackgroundMasks::known), 0.0);
}

TEST_F(LowPerson, WhoWasNoneForSureIsLearnedAsTheRoom) {
  Recognise().certain_until_s = 0.0;
  Miss(60);
  EXPECT_GT(MeasureRoom(&depth::BackgroundMasks::certain), 0.5);
}

// Noise hides who hardly stands out from the room, in some frames: here most of them is within the
// depth tolerance of what was learned as the room, and half is it for certain.
TEST_F(LowPerson, WhoLayThereAMomentAgoGoesOnInWhatIsLikeTheRoom) {
  Recognise().certain_until_s = 0.0;
  Miss(60);
  pose_.feet_m.z() -= 0.0382;  // half the tolerance at 2.5 m
  ASSERT_GT(MeasureRoom(&depth::BackgroundMasks::known), 0.5);
  ASSERT_GT(MeasureRoom(&depth::BackgroundMasks::certain), RestOptions{}.background_share);
  const double time_s = frame_ / 30.0;
  const auto goes_on = [&](double lay_s, double certain_until_s) {
    PeopleState state = state_;
    Track& track = state.tracks.tracks.at(0);
    track.entered = true;
    track.certain_until_s = certain_until_s;
    track.lay_s = lay_s;
    const auto candidates = Propose(Shot({pose_}, frame_), state).candidates;
    return std::ranges::any_of(candidates, [](const Candidate& c) { return c.track == 0; });
  };
  EXPECT_TRUE(goes_on(time_s - 0.5, time_s + 1.0));
  EXPECT_FALSE(goes_on(time_s - 1.5, time_s + 1.0));
  EXPECT_FALSE(goes_on(time_s - 0.5, time_s - 1.0));
}

}  // namespace
}  // namespace ossa::people
