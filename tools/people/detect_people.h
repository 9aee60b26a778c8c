#pragma once
#include <optional>
#include <vector>

#include "depth/image/depth_frame.h"
#include "depth/image/image.h"
#include "tools/people/associate_tracks.h"
#include "tools/people/decision.h"
#include "tools/people/detection.h"
#include "tools/people/track_initiation.h"

/// Who is in the picture, and which pixels are whose.
namespace ossa::people {

/// All that is remembered between frames.
struct PeopleState {
  depth::SceneState scene;
  TrackList tracks;                       // confirmed and lost
  std::vector<TentativeTrack> tentative;  // no person so far
};

struct Person {
  int id = 0;  // 1 to 255, the same while somebody is followed
  Detection detection;
};

struct PeopleInFrame {
  std::optional<FloorPlane> floor;
  std::vector<Person> people;
  depth::Image<uint8_t> users;  // id of the person each pixel belongs to, 0 nobody
  FrameDecisions decisions;     // on every candidate
  double segment_ms = 0, classify_ms = 0, propose_ms = 0;  // wasted observations included
};

/// One frame's way from depth to people, each step with what the ones before it made: geometry,
/// candidates, the forest's word on them, decisions, identities, user pixels, background. Frames of
/// any size, in order of time. Works from a single frame; what is remembered makes it better.
PeopleInFrame DetectPeople(const DepthFrame& frame, const PersonClassifier& classifier,
                           PeopleState& state, const PeopleOptions& options = {});

/// Whether a person accepted at the first look is to be held against a body's surface.
bool IsDoubtfulAtFirst(const Detection& detection, const InitiationOptions& options);

/// How much of somebody a fitted body explains, shares in [0, 1] (recon::SurfaceFit).
struct ExplainedShares {
  double explained = 0.0;
  double score = 0.0;  // less what is seen through
};

/// Whether a body that was accepted at the first look explains too little of what is seen;
/// `beside_somebody`: about somebody else in the image there is no doubt.
bool IsUnlikeABody(const ExplainedShares& fit, double person_score, bool beside_somebody,
                   const InitiationOptions& options);

/// Takes back that somebody accepted in this frame is a person: they have no track, no pixels.
void Withdraw(int id, PeopleState& state, depth::Image<uint8_t>& users, FrameDecisions& decisions);

}  // namespace ossa::people
