#pragma once
#include <limits>
#include <optional>
#include <vector>

#include "depth/image/depth_frame.h"
#include "depth/image/image.h"
#include "tools/people/associate_tracks.h"
#include "tools/people/decision.h"
#include "tools/people/detection.h"
#include "tools/people/frame_rate.h"
#include "tools/people/track_initiation.h"

/// Person detection and tracking: who is in the image, and which pixels belong to whom.
namespace ossa::people {

/// When candidates are searched thoroughly, for people who could not be told from furniture in the
/// first frame: while nobody is tracked, from time to time, and in some frames after somebody was
/// found, who is accepted only after several.
class ThoroughSearch {
 public:
  /// `every_s`: between two searches.
  bool IsDue(bool fresh_scene, bool has_tracked, double time_s, double every_s) const;
  /// Notes that a frame was searched, and whether somebody was found.
  void Note(double time_s, bool found);

 private:
  double last_s_ = -std::numeric_limits<double>::infinity();
  int found_in_a_row_ = 0;  // frames
};

/// The state between frames.
struct PeopleState {
  FrameRate rate;
  depth::SceneState scene;
  TrackList tracks;                       // confirmed and lost
  std::vector<TentativeTrack> tentative;  // not accepted as people so far
  ThoroughSearch search;                  // while nobody is tracked
};

struct Person {
  int id = 0;  // 1 to 255, constant while the person is tracked
  Detection detection;
};

struct PeopleInFrame {
  std::optional<FloorPlane> floor;
  std::vector<Person> people;
  depth::Image<uint8_t> users;  // id of the person each pixel belongs to, 0 for none
  FrameDecisions decisions;     // for every candidate
  double segment_ms = 0, classify_ms = 0, propose_ms = 0;  // including rejected candidates
};

/// Detects and tracks people in one frame: scene geometry, candidates, classification by the
/// forest, decisions, identities, user pixels, background. Frames may differ in size and come in
/// order of time. A single frame is enough; `state` improves later ones.
PeopleInFrame DetectPeople(const DepthFrame& frame, const PersonClassifier& classifier,
                           PeopleState& state, const PeopleOptions& options = {});

/// Whether a new person must be verified by the surface fit: one accepted in a single frame, or one
/// accepted after several whom the network contests or a fit refused before.
bool NeedsSurfaceCheck(const Detection& detection, const InitiationOptions& options);

/// How much of a candidate the fitted body explains, shares in [0, 1] (recon::SurfaceFit).
struct ExplainedShares {
  double explained = 0.0;
  double score = 0.0;  // less the share that the camera sees through
};

/// Whether the fitted body explains too little of a candidate that was accepted in a single frame.
/// `beside_person`: the image contains another person without doubt.
bool IsPoorBodyFit(const ExplainedShares& fit, const Detection& detection, bool beside_person,
                   const InitiationOptions& options);

/// Revokes the acceptance of a person in this frame: deletes their track and their user pixels.
/// They become a tentative track that must be verified again.
void WithdrawPerson(const Person& person, double time_s, PeopleState& state,
                    depth::Image<uint8_t>& users, FrameDecisions& decisions);

}  // namespace ossa::people
