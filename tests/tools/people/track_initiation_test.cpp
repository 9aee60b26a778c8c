// Track initiation and termination: synthetic detections, no forest.
#include <gtest/gtest.h>

#include <algorithm>

#include "tools/people/detect_people.h"
#include "tools/people/track_initiation.h"

namespace ossa::people {
namespace {

struct Observation {
  double score = 0;
  float x_m = 0;                // position of the centroid
  double foreground_share = 0;  // share in front of the known background
  float area_m2 = 0.1F;
  bool has_head = true;
  bool isolated = true;
  double occluded_share = 0.3;  // share of its silhouette that is occluded
  Verifier verifier = Verifier::kForest;
  float z_m = 3;  // of the centroid
};

class NewPerson : public testing::Test {
 protected:
  // An object of 100 cells; a step of 4 cm moves it by one column of 160.
  Detection Detect(const Observation& look) {
    Detection detection;
    detection.score = detection.evidence.score = look.score;
    detection.verifier = look.verifier;
    Candidate& candidate = detection.candidate;
    candidate.foreground_share = look.foreground_share;
    candidate.foreground_m2 = static_cast<float>(look.foreground_share) * look.area_m2;
    candidate.has_head = look.has_head;
    candidate.isolated = look.isolated;
    candidate.occluded_share = look.occluded_share;
    candidate.region.mean_m = {look.x_m, 0, look.z_m};
    candidate.region.area_m2 = look.area_m2;
    const int column = 80 + static_cast<int>(std::lround(look.x_m / 0.04F));
    for (int row = 20; row < 120; ++row) candidate.region.cells.push_back(160 * row + column);
    return detection;
  }

  // The frame in which it is accepted, of `frames` at 30 Hz; -1 for none.
  template <class LookAt>
  int AcceptedIn(int frames, bool fresh, const LookAt& look_at) {
    std::vector<TentativeTrack> tentative;
    for (int f = 0; f < frames; ++f) {
      Detection detection = Detect(look_at(f));
      if (DecidePerson(fresh && f == 0, f / 30.0, options_, tentative, detection)) return f;
      rule_ = detection.decision.rule;
    }
    return -1;
  }
  InitiationOptions options_;
  Rule rule_ = Rule::kCount;  // of the last rejection
};

TEST_F(NewPerson, IsAcceptedAtOnceInAFreshSceneAndElsewhereAfterThreeConfidentFrames) {
  EXPECT_EQ(AcceptedIn(1, true, [](int) { return Observation{0.65}; }), 0);
  EXPECT_EQ(AcceptedIn(1, true, [](int) { return Observation{0.85, 0, 0, 0.1F, false}; }), -1);
  EXPECT_EQ(AcceptedIn(1, true, [](int) { return Observation{0.95, 0, 0, 0.1F, false}; }), 0);
  EXPECT_EQ(AcceptedIn(1, false, [](int) { return Observation{0.65}; }), -1);
  EXPECT_EQ(AcceptedIn(3, false, [](int) { return Observation{0.95}; }), 2);
  EXPECT_EQ(AcceptedIn(20, false, [](int f) { return Observation{f < 2 ? 0.98 : 0.7}; }), -1);
}

// A region with a low score does not count against it and others joined.
TEST_F(NewPerson, JoinedFromRegionsIsAnotherObjectThanEachOfThem) {
  const auto accepted_after = [&](bool is_joined) {
    std::vector<TentativeTrack> tentative;
    Detection part = Detect({0.05});
    DecidePerson(false, 0.0, options_, tentative, part);
    for (int frame = 1; frame <= 5; ++frame) {
      Detection whole = Detect({0.99});
      whole.is_joined = is_joined;
      if (DecidePerson(false, frame / 30.0, options_, tentative, whole)) return frame;
    }
    return 0;
  };
  EXPECT_EQ(accepted_after(true), options_.standing_observations);
  EXPECT_EQ(accepted_after(false), 0);
}

// A hand that the image or an object cuts off its arm looks like a person for a frame.
TEST_F(NewPerson, BesideATrackedPersonIsNotAcceptedInOneFrame) {
  const auto accepted_in = [&](bool isolated, int frames) {
    return AcceptedIn(frames, false, [&](int f) {
      return Observation{.score = 0.8,
                         .x_m = 0.04F * static_cast<float>(f),
                         .foreground_share = 1.0,
                         .isolated = isolated};
    });
  };
  EXPECT_EQ(accepted_in(true, 1), 0);
  EXPECT_EQ(accepted_in(false, 1), -1);
  EXPECT_EQ(accepted_in(false, 10), options_.tentative_observations - 1) << "it moves on";
}

// The head's shape is not used then.
TEST_F(NewPerson, PoseNetworkDecidesIfItWasRun) {
  const auto by_pose = [](double score, bool has_head) {
    return Observation{
        .score = score, .has_head = has_head, .verifier = Verifier::kForestAndNetwork};
  };
  EXPECT_EQ(AcceptedIn(1, true, [&](int) { return by_pose(0.55, true); }), -1);
  EXPECT_EQ(AcceptedIn(1, true, [&](int) { return by_pose(0.65, false); }), 0);
  EXPECT_EQ(AcceptedIn(60, false, [&](int) { return by_pose(0.55, true); }), -1);
  EXPECT_EQ(AcceptedIn(3, false, [&](int) { return by_pose(0.65, false); }), 2);
  // The surface fit is not needed, unless the forest is confident and the network is not.
  std::vector<TentativeTrack> tentative;
  Detection detection = Detect(by_pose(0.65, true));
  EXPECT_TRUE(DecidePerson(true, 0.0, options_, tentative, detection));
  EXPECT_FALSE(NeedsSurfaceCheck(detection, options_));
  Detection contested = Detect(Observation{0.97});
  contested.verifier = Verifier::kSurfaceFit;
  EXPECT_TRUE(DecidePerson(true, 0.0, options_, tentative, contested));
  EXPECT_TRUE(NeedsSurfaceCheck(contested, options_));
}

TEST_F(NewPerson, PieceIsAPersonUnlessThePoseNetworkRejectsIt) {
  std::vector<TentativeTrack> tentative;
  const auto is_one = [&](const Observation& look) {
    Detection piece = Detect(look);
    piece.is_piece = true;
    const bool is_person = DecidePerson(true, 0.0, options_, tentative, piece);
    rule_ = piece.decision.rule;
    return is_person;
  };
  EXPECT_TRUE(is_one({.score = 0.65}));
  EXPECT_TRUE(is_one({.score = 0.65, .verifier = Verifier::kForestAndNetwork}));
  EXPECT_EQ(rule_, Rule::kPieceWithHead);
  EXPECT_FALSE(is_one({.score = 0.55, .verifier = Verifier::kForestAndNetwork}));
  EXPECT_EQ(rule_, Rule::kPieceLowScore);
}

// Of what stands beside somebody tracked, and was taken for theirs, both models must be confident,
// if there are both.
TEST_F(NewPerson, PieceCutOffATrackedPersonIsNewUnlessBothModelsAreConfident) {
  const auto accepted_in = [&](const Observation& look) {
    std::vector<TentativeTrack> tentative;
    for (int f = 0; f < 4; ++f) {
      Detection piece = Detect(look);
      piece.is_piece = piece.is_cut_off = true;
      if (DecidePerson(false, f / 30.0, options_, tentative, piece)) return f;
    }
    return -1;
  };
  EXPECT_EQ(accepted_in({.score = 0.95, .verifier = Verifier::kForestAndNetwork}), 0);
  EXPECT_EQ(accepted_in({.score = 0.95, .verifier = Verifier::kSurfaceFit}), 2);
  EXPECT_EQ(accepted_in({.score = 0.9, .verifier = Verifier::kForestAndNetwork}), 2);
  EXPECT_EQ(accepted_in({.score = 0.95, .verifier = Verifier::kForest}), 0);
}

TEST_F(NewPerson, StaticLikeFurnitureIsNeverAccepted) {
  EXPECT_EQ(AcceptedIn(60, false, [](int) { return Observation{0.85}; }), -1);
  // A lower score of an object that turns, and grows by a quarter, is a person,
  const auto turns = [](int f) {
    return f < 10 ? Observation{0.7}
                  : Observation{.score = 0.7, .foreground_share = 0.2, .area_m2 = 0.125F};
  };
  EXPECT_EQ(AcceptedIn(60, false, turns), 10);
  // ... but not of one that a passer-by uncovers by a quarter: it is no foreground.
  const auto uncovered = [](int f) { return Observation{0.7, 0, 0, f < 10 ? 0.1F : 0.125F}; };
  EXPECT_EQ(AcceptedIn(60, false, uncovered), -1);
}

TEST_F(NewPerson, ThatScoredLikeAPersonTwiceIsNotLearnedAsTheRoom) {
  const auto marked_after = [this](int frames, double score) {
    std::vector<TentativeTrack> tentative;
    for (int f = 0; f < frames; ++f) {
      Detection detection = Detect({score});
      EXPECT_FALSE(DecidePerson(false, f / 30.0, options_, tentative, detection));
    }
    std::vector<uint8_t> marked(160 * 120, 0);
    MarkLikelyPeople(tentative, options_, marked);
    return std::count(marked.begin(), marked.end(), uint8_t{1});
  };
  EXPECT_EQ(marked_after(1, 0.95), 0);
  EXPECT_EQ(marked_after(2, 0.95), 100);
  EXPECT_EQ(marked_after(2, 0.85), 0);
}

TEST_F(NewPerson, ThatEnteredBehindOthersIsTrackedWithLowScores) {
  // A head above a person's shoulder, at 1.2 m/s: no cell is the same in consecutive frames.
  const auto at = [](int steps, double foreground_share) {
    return Observation{0.04, 0.04F * static_cast<float>(steps), foreground_share};
  };
  const auto walks = [&](int f) { return at(f, 1); };
  EXPECT_EQ(AcceptedIn(60, false, walks), 13);  // 52 cm
  const auto beside_somebody = [&](int f) {
    Observation look = at(f, 1);
    look.isolated = false;
    return look;
  };
  EXPECT_EQ(AcceptedIn(60, false, beside_somebody), -1);
  const auto sways = [&](int f) { return at(f % 8 < 4 ? f % 4 : 4 - f % 4, 1); };
  EXPECT_EQ(AcceptedIn(60, false, sways), -1);
  const auto was_there = [&](int f) { return at(f, 0); };
  EXPECT_EQ(AcceptedIn(60, false, was_there), -1);
}

TEST_F(NewPerson, CompletelyVisibleForegroundMustScoreLikeAPerson) {
  // A dog that walks by, completely visible.
  const auto walks = [](double score) {
    return [score](int f) {
      Observation look{score, 0.04F * static_cast<float>(f), 1};
      look.occluded_share = 0;
      return look;
    };
  };
  EXPECT_EQ(AcceptedIn(60, false, walks(0.4)), -1);
  EXPECT_EQ(AcceptedIn(60, false, walks(0.65)), 0);
}

TEST_F(NewPerson, ThatBendsDownIsKeptOnlyAsALongLivedTrack) {
  Observation bent{0.1, 0, 1};
  bent.occluded_share = 0;
  std::vector<TentativeTrack> tentative;
  for (const int age : {20, 40}) {
    Detection detection = Detect(bent);
    detection.age = age;
    detection.prior.moved = detection.prior.moving = true;
    EXPECT_EQ(DecidePerson(true, 1.0, options_, tentative, detection), age == 40);
    EXPECT_EQ(detection.decision.rule, age == 40 ? Rule::kTrackContinued : Rule::kTrackLowScore);
  }
}

// A wall of noise was looked at for a second before somebody steps in front of it.
TEST_F(NewPerson, IsNotJudgedByWhatIsBehindThem) {
  const auto accepted_in = [&](float z_m) {
    return AcceptedIn(40, false, [&](int f) {
      return f < 30 ? Observation{.score = 0.02, .z_m = 3.6F}
                    : Observation{.score = 0.95, .z_m = z_m};
    });
  };
  EXPECT_EQ(accepted_in(2.8F), 30 + options_.standing_observations - 1);
  EXPECT_EQ(accepted_in(3.5F), -1) << "the same object scores high for a moment";
}

// Somebody on the floor or deep in a sofa hardly scores. What left the room as it was is not them.
TEST_F(NewPerson, ForSureStaysWithoutAScoreUnlessOnlyTheRoomIsLeft) {
  struct Case {
    bool certain;
    double foreground_share, background_share;
    bool stays;
    double lay_s = 0.0;
  };
  std::vector<TentativeTrack> tentative;
  for (const Case& c : {Case{true, 0.0, 0.1, true}, Case{true, 0.3, 0.8, true},
                        Case{true, 0.1, 0.8, false}, Case{false, 0.3, 0.1, false},
                        Case{true, 0.1, 0.8, true, 0.5}, Case{false, 0.1, 0.8, false, 0.5}}) {
    Detection detection = Detect({0.001, 0, c.foreground_share});
    detection.age = 50;
    detection.candidate.background_share = c.background_share;
    detection.prior.moved = true;
    detection.prior.certain = c.certain;
    detection.prior.lay_s = c.lay_s;
    EXPECT_EQ(DecidePerson(false, 1.2, options_, tentative, detection), c.stays)
        << c.certain << c.foreground_share << c.background_share;
    EXPECT_EQ(detection.decision.rule, c.stays ? Rule::kTrackRests : Rule::kTrackLowScore);
  }
}

// The threshold is higher for young tracks, and highest for those that never moved.
TEST_F(NewPerson, ThresholdFallsWithAgeUnlessThePersonNeverMoved) {
  struct Case {
    int age;
    bool moved;
    double needed;
  };
  for (const Case& c : {Case{2, true, 0.4},
                        {12, true, 0.4},
                        {13, true, 0.25},
                        {10, false, 0.4},
                        {11, false, 0.7},
                        {40, false, 0.7}}) {
    std::vector<TentativeTrack> tentative;
    for (const double less : {0.0, 0.01}) {
      Detection detection = Detect(Observation{c.needed - less});
      detection.age = c.age;
      detection.prior.moved = c.moved;
      EXPECT_EQ(DecidePerson(false, 1.0, options_, tentative, detection), less == 0.0) << c.age;
      EXPECT_EQ(detection.decision.needed_score, c.needed) << c.age;
    }
    // A rejected track has a higher threshold from then on.
    const bool is_suspect = c.needed > options_.tracked_score;
    ASSERT_EQ(tentative.size(), is_suspect ? 1U : 0U) << c.age;
    if (is_suspect) {
      EXPECT_TRUE(tentative[0].was_rejected);
    }
  }
}

TEST_F(NewPerson, AcceptedByThePoseNetworkGoesOnByItsThresholdWithoutMoving) {
  for (const auto& [verifier, needed] :
       {std::pair(Verifier::kForest, options_.still_track_score),
        std::pair(Verifier::kForestAndNetwork, options_.weak_by_pose_score)}) {
    std::vector<TentativeTrack> tentative;
    Detection detection = Detect({.score = 0.6, .verifier = verifier});
    detection.age = options_.still_age + 1;
    EXPECT_EQ(DecidePerson(false, 1.0, options_, tentative, detection), needed < 0.6);
    EXPECT_EQ(detection.decision.needed_score, needed);
  }
}

// The number of tentative tracks after one object, and another after a delay: one if it is the
// same.
size_t CountThings(const TentativeTrack& before, Detection now, double later_s) {
  std::vector<TentativeTrack> known = {before};
  DecidePerson(false, later_s, InitiationOptions{}, known, now);
  return known.size();
}

TEST_F(NewPerson, NearbyNewForegroundCountsAsTheSamePerson) {
  TentativeTrack came;
  came.mean_m = {0.2F, 0, 3};
  came.is_foreground = true;
  TentativeTrack stood = came;
  stood.is_foreground = false;
  const Detection now = Detect({.score = 0.04, .foreground_share = 1});
  EXPECT_EQ(CountThings(came, now, 0.1), 1U);
  EXPECT_EQ(CountThings(stood, now, 0.1), 2U);
  EXPECT_EQ(CountThings(came, now, 0.3), 2U);
  EXPECT_EQ(CountThings(came, Detect({.score = 0.04}), 0.1), 2U);
  came.mean_m.x() = 0.3F;
  EXPECT_EQ(CountThings(came, now, 0.1), 2U);
}

TEST_F(NewPerson, LowScoreIsTentativeByTheThresholdRule) {
  EXPECT_EQ(AcceptedIn(1, false, [](int) { return Observation{0.95}; }), -1);
  EXPECT_EQ(rule_, Rule::kFirstLook);
  EXPECT_EQ(AcceptedIn(2, false, [](int) { return Observation{0.95}; }), -1);
  EXPECT_EQ(rule_, Rule::kFewObservations);
  EXPECT_EQ(AcceptedIn(20, false, [](int) { return Observation{0.7}; }), -1);
  EXPECT_EQ(rule_, Rule::kLowMeanScore);
}

TEST_F(NewPerson, LowScoringBoardIsRejected) {
  Detection board = Detect(Observation{0.3});
  board.candidate.plane = FlatPlane{0, 0, 0.4};
  std::vector<TentativeTrack> tentative;
  EXPECT_FALSE(DecidePerson(true, 0, options_, tentative, board));
  EXPECT_EQ(board.decision.rule, Rule::kPlanar);
  EXPECT_EQ(board.decision.needed_score, options_.new_person_score);
}

TEST_F(NewPerson, BeyondTheMaximumIsRejectedByThatRule) {
  options_.max_users = 2;
  std::vector<Detection> detections;
  for (const double score : {0.95, 0.97, 0.99}) detections.push_back(Detect(Observation{score}));
  std::vector<TentativeTrack> tentative;
  std::vector<Decision> decided;
  const auto people = SelectPeople(std::move(detections), true, 0, options_, tentative, decided);
  ASSERT_EQ(people.size(), 2U);
  EXPECT_EQ(people[0].score, 0.99);
  ASSERT_EQ(decided.size(), 1U);
  EXPECT_EQ(decided[0].rule, Rule::kUserLimit);
  EXPECT_EQ(decided[0].score, 0.95);
}

// Two heads in the region of one person so far: a carton that they hold, or somebody else.
TEST_F(NewPerson, SegmentBesideATrackedPersonNeedsAHighScore) {
  Detection piece = Detect(Observation{0.8});
  EXPECT_EQ(RequireOfPiece(piece, false, options_), options_.new_person_score);
  EXPECT_EQ(RequireOfPiece(piece, true, options_), options_.confident_score);
  piece.candidate.track = 0;
  EXPECT_EQ(RequireOfPiece(piece, true, options_), options_.new_person_score);
}

TEST_F(NewPerson, IsVerifiedByTheSurfaceFitIfOneFrameLeavesDoubt) {
  std::vector<TentativeTrack> tentative;
  const auto is_doubtful = [&](const Observation& look, bool fresh) {
    Detection detection = Detect(look);
    DecidePerson(fresh, 0.0, options_, tentative, detection);
    return NeedsSurfaceCheck(detection, options_);
  };
  EXPECT_TRUE(is_doubtful(Observation{0.7}, true));
  EXPECT_FALSE(is_doubtful(Observation{0.97}, true));
  EXPECT_FALSE(is_doubtful(Observation{0.7, 0, 1.0}, false));  // it entered a known room
}

TEST(Withdrawal, RemovesTrackAndPixels) {
  PeopleState state;
  state.tracks.tracks.resize(2);
  state.tracks.tracks[0].id = 1;
  state.tracks.tracks[1].id = 2;
  depth::Image<uint8_t> users(3, 1);
  users.data = {1, 2, 0};
  FrameDecisions decisions;
  decisions.candidates.resize(1);
  decisions.candidates[0].track = 2;
  decisions.tracks.resize(2);
  decisions.tracks[0].id = 1;
  decisions.tracks[1].id = 2;
  state.tracks.next_id = 3;
  WithdrawPerson({2, {}}, 0.0, state, users, decisions);
  ASSERT_EQ(state.tracks.tracks.size(), 1U);
  EXPECT_EQ(state.tracks.tracks[0].id, 1);
  EXPECT_EQ(users.data, (std::vector<uint8_t>{1, 0, 0}));
  EXPECT_EQ(decisions.candidates[0].rule, Rule::kUnlikeABody);
  EXPECT_EQ(decisions.candidates[0].track, 0);
  EXPECT_EQ(decisions.tracks.size(), 1U);
  EXPECT_EQ(state.tracks.next_id, 2) << "of who comes next";
}

// An object that is no person, however certain the forest is: it stands where it is and is seen
// again in every frame.
TEST_F(NewPerson, WithdrawnIsVerifiedAgainBeforeTheyReturn) {
  PeopleState state;
  depth::Image<uint8_t> users(1, 1);
  FrameDecisions decisions;
  WithdrawPerson({1, Detect({.score = 0.97})}, 0.0, state, users, decisions);
  for (int f = 1; f < 10; ++f) {
    Detection again = Detect({.score = 0.97});
    if (!DecidePerson(false, f / 30.0, options_, state.tentative, again)) continue;
    EXPECT_TRUE(NeedsSurfaceCheck(again, options_)) << f;
    WithdrawPerson({1, again}, f / 30.0, state, users, decisions);
  }
  EXPECT_EQ(state.tentative.size(), 1U);
}

// The network contests what the forest is confident of.
TEST_F(NewPerson, ContestedIsVerifiedByTheSurfaceAfterSeveralFrames) {
  std::vector<TentativeTrack> tentative;
  bool is_accepted = false;
  for (int f = 0; f < 4 && !is_accepted; ++f) {
    Detection contested = Detect({.score = 0.97, .verifier = Verifier::kSurfaceFit});
    is_accepted = DecidePerson(false, f / 30.0, options_, tentative, contested);
    EXPECT_EQ(NeedsSurfaceCheck(contested, options_), is_accepted);
  }
  EXPECT_TRUE(is_accepted);
}

// A contested observation counts with the forest's score, which real furniture may have, too.
TEST_F(NewPerson, ContestedOnceMustBeConfidentOnAverage) {
  const auto accepted_in = [&](bool contested, bool grows) {
    return AcceptedIn(8, false, [&](int f) {
      const bool now = contested && f < 2;
      return Observation{.score = now ? 0.97 : 0.8,
                         .area_m2 = 0.1F + (grows ? 0.01F * static_cast<float>(f) : 0.0F),
                         .verifier = now ? Verifier::kSurfaceFit : Verifier::kForestAndNetwork};
    });
  };
  EXPECT_EQ(accepted_in(false, false), options_.standing_observations - 1);
  EXPECT_EQ(accepted_in(true, false), -1);
  EXPECT_EQ(accepted_in(false, true), options_.tentative_observations - 1);
  EXPECT_EQ(accepted_in(true, true), -1);
}

// A strip of wall under the upper border resembles somebody whose head is outside; near the sensor
// a person's head often is.
TEST_F(NewPerson, FarAtTheUpperBorderNeedsAHigherScore) {
  const double between = 0.5 * (options_.person_by_pose_score + options_.cut_by_pose_score);
  for (const auto& [at_top, z_m, passes] :
       {std::tuple(false, 3.0F, true), std::tuple(true, 3.0F, false),
        std::tuple(true, 1.0F, true)}) {
    std::vector<TentativeTrack> tentative;
    Detection detection = Detect({.score = between, .verifier = Verifier::kForestAndNetwork});
    detection.candidate.at_top = at_top;
    detection.candidate.region.mean_m.z() = z_m;
    EXPECT_EQ(DecidePerson(true, 0.0, options_, tentative, detection), passes) << at_top << z_m;
  }
}

// A person accepted in the same frame keeps their id, and the next one has another.
TEST(Withdrawal, KeepsTheIdsOfOthers) {
  PeopleState state;
  state.tracks.tracks.resize(2);
  state.tracks.tracks[0].id = 1;
  state.tracks.tracks[1].id = 2;
  state.tracks.next_id = 3;
  depth::Image<uint8_t> users(1, 1);
  FrameDecisions decisions;
  WithdrawPerson({1, {}}, 0.0, state, users, decisions);
  EXPECT_EQ(state.tracks.next_id, 3);
}

}  // namespace
}  // namespace ossa::people
