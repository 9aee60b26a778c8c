#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "depth/image/depth_frame.h"
#include "depth/image/image.h"
#include "depth/scene/background.h"
#include "depth/scene/body_measures.h"
#include "depth/scene/floor.h"
#include "depth/scene/regions.h"

namespace ossa::depth {

/// Points of a body that are known again in every look, in a fixed order: where they are seen.
using Marks = std::vector<std::optional<Eigen::Vector3f>>;

/// People of the frames before, as far as places go.
struct UserTrack {
  int id = 0;
  std::vector<int> cells;  // of the last frame it was seen in
  std::vector<float> z_m;  // depth of those cells
  Eigen::Vector3f mean_m = Eigen::Vector3f::Zero();
  Eigen::Vector3f velocity_m_s = Eigen::Vector3f::Zero();
  int steps = 0;      // from frame to frame that the velocity is of
  Marks marks_m;      // of the last frame it was seen in
  float full_m2 = 0;  // the most surface seen of it lately
  Eigen::Vector3f first_mean_m = Eigen::Vector3f::Zero();  // and surface, when it was new
  float first_m2 = 0;
  bool moved = false;  // since then
  double moved_s = 0;  // when it was new or last elsewhere, or showed another surface than before
  Eigen::Vector3f rest_mean_m = Eigen::Vector3f::Zero();  // where it was then, and its surface
  float rest_m2 = 0;
  double seen_s = 0;
  double arrived_share = 0;  // of what was seen last; see Candidate
  bool came = false;         // most of it once stood where the room behind it was seen before
  bool lost_behind = false;  // out of view, it was last seen at the outline of somebody nearer
  BodyMeasures body;
};

/// All that the scene remembers between frames.
struct SceneState {
  FloorState floor;
  BackgroundState background;
  std::vector<UserTrack> users;  // in view, or lost a moment ago
  int next_id = 1;
  int frame_width = 0, frame_height = 0;
  std::vector<float> last_z_m;  // of the grid's cells in the last frame
  double last_s = -1e9;         // and its time
};

/// When somebody who comes into view is one of those who went out of it, and not somebody new.
struct ReidentifyOptions {
  double forget_s = 2.5;         // after so long out of view a person is new,
  double forget_behind_s = 5.0;  // ... after so long behind somebody
  double walk_s = 2.0;           // how long who is out of view walks on as before
  double walk_share = 0.6;       // of those out of view who walk on,
  double stay_share = 0.3;       // ... and who stay about there; the others may be anywhere
  // New people for each of those who come back, a square metre of floor: few appear in the middle
  // of a room, and hardly anybody out of nothing behind somebody nearer.
  double new_border_1_m2 = 0.1;
  double new_open_1_m2 = 0.02;
  double new_behind_1_m2 = 0.004;
  double other_way = 0.3;  // likelihood of who went behind somebody to come back elsewhere, or v.v.
};

struct SceneOptions {
  FloorOptions floor;
  BackgroundOptions background;
  float max_depth_m = 6.0F;   // nobody is looked for beyond
  float min_area_m2 = 0.07F;  // of a person in view: head and shoulders
  float min_height_m = 0.28F;
  float min_arrived_m2 = 0.045F;      // of what came into view where the room was seen before: a
  float min_arrived_height_m = 0.2F;  // head over somebody nearer
  float max_reach_m = 1.75F;  // over the surface from the head to the farthest toe or finger
  float growth_m = 0.5F;      // ... and beyond where a known person was a frame ago
  double fresh_s = 0.3;       // without frames for so long, the scene is fresh
  ReidentifyOptions reidentify;
  float return_gate_m = 0.6F;     // how far off the predicted place a lost person may reappear,
  float return_speed_m_s = 0.7F;  // growing with time
};

/// A piece of the scene that may be a person.
struct Candidate {
  std::vector<int32_t> pixels;  // v * width + u of the full image, ascending
  Region region;                // on the grid
  int track = -1;               // index into SceneState::users it seems to continue, or -1
  std::vector<int> absorbed;    // others there who turned out to be parts of the same person
  bool returning = false;       // somebody who went out of view is expected about here
  bool has_head = false;        // something like head and shoulders is seen
  double flat_share = 0;        // of the cells that lie on flat pieces
  double arrived_share = 0;     // of the cells that stand where something behind them was seen; 0
                                // for what may be the rest of somebody who is seen
  float arrived_m2 = 0;         // the same as surface, without its rims: edges flicker
  bool alone = true;            // nobody who is seen is beside it
  double hidden_share = 0;      // of its outline where more of it may be out of sight
  int origin = -1;              // candidates of one connected region have the same
  MeasuredBody body{};          // by the caller, of those it confirms
  Marks marks_m;                // likewise
  /// Of what is all but one plane: that plane.
  std::optional<FlatPlane> board{};
};

struct Scene {
  PointGrid grid;
  std::optional<FloorPlane> floor;
  std::vector<Candidate> candidates;  // largest first
  bool fresh = true;                  // no frame of this scene was seen a moment ago
};

/// What of this frame may be people. Works from a single frame; what is remembered makes it
/// better. Nothing is claimed to be a person: the caller looks at the candidates and says which are
/// (ConfirmUsers).
Scene FindCandidates(const DepthFrame& frame, const SceneState& state, SceneState& next,
                     const SceneOptions& options = {});

/// Cuts a candidate into one for each of several heads found otherwise (camera space, metres).
std::vector<Candidate> SplitCandidate(const Scene& scene, const DepthFrame& frame,
                                      const Candidate& candidate,
                                      const std::vector<Eigen::Vector3d>& heads_m,
                                      const SceneOptions& options = {});

/// True where two candidates meet along a rim: at a shirt's hem or a belt the surface may jump by
/// more than connected surface does.
bool Adjoining(const Scene& scene, const Candidate& a, const Candidate& b);

/// True where one is all but one plane, as the back of a seat is, and the other is behind it: they
/// are not one person, however they look together.
bool HidesPartOf(const Scene& scene, const Candidate& board, const Candidate& person);

/// Two pieces at one place over the floor, one above the other: nobody stands on somebody else,
/// whatever shows between them.
bool OneAbove(const PointGrid& grid, const Region& a, const Region& b);

/// Two candidates as one; it goes on as `a`, if that was anybody, and `b` is nobody any more.
Candidate JoinCandidates(const Scene& scene, const DepthFrame& frame, const Candidate& a,
                         const Candidate& b);

struct Bone {
  Eigen::Vector3f from_m, to_m;
};
/// Takes off a candidate what is farther than `reach_m` from every bone of the person in it: the
/// sofa that the person touches.
void KeepNear(const Scene& scene, const DepthFrame& frame, std::span<const Bone> bones,
              float reach_m, Candidate& candidate);

/// Gives the confirmed candidates their identities (same order), 1 to 255, and learns the
/// background from everything else. Nobody gets the identity of somebody who is remembered.
std::vector<int> ConfirmUsers(const Scene& scene, const std::vector<const Candidate*>& people,
                              double time_s, SceneState& state, const SceneOptions& options = {});

/// True of a user out of view for too long.
bool IsForgotten(const UserTrack& user, double time_s, const ReidentifyOptions& options);

/// Furniture stays where it is and shows the same surface; people shift, breathe and turn.
bool HasMoved(const Eigen::Vector3f& first_mean_m, float first_m2, const Region& now);

/// The SDK's player index: user id per pixel (0 nobody), as an image of the frame's size.
Image<uint8_t> UserImage(const DepthFrame& frame, const std::vector<const Candidate*>& people,
                         const std::vector<int>& ids);

}  // namespace ossa::depth
