#pragma once
#include <array>
#include <cstddef>
#include <optional>

#include "depth/scene/measure_scene.h"
#include "depth/scene/silhouette.h"
#include "tools/people/body_measures.h"

/// Every threshold of finding people and telling them apart, by stage.
///
/// Constants: where a line names no other origin ("anthropometry": bodies of 1 to 2 m must pass;
/// "sensor": noise and quantisation of structured light at 1 to 6 m), a value was set by hand while
/// developing on rendered rooms with validation subjects (`ossa experiment indoor-scenes --seed 1
/// --parameters p.toml`, p.toml: mocap of validation subjects); no sweep over it is recorded.
/// Ranges: lengths, areas, times and counts are > 0, shares, scores and weights in [0, 1]. Areas
/// are of seen surface, as a frontal view shows it.
namespace ossa::people {

/// More than this share of cells is most of them.
inline constexpr double kMostly = 0.5;

/// Heads by shape: a blob of about 20 cm, free at its sides and above, with shoulders below.
struct HeadOptions {
  float inner_radius_m = 0.085F;   // anthropometry: well inside any head
  float outer_radius_m = 0.19F;    // anthropometry: well outside any head, above the shoulders
  float min_score = 0.4F;          // filled share of the disc x free share of the ring x shoulders
  float min_distance_m = 0.25F;    // anthropometry: of two people's heads, each 15 cm wide; of one
                                   // person the better one counts
  float max_depth_step_m = 0.15F;  // anthropometry: a head is less than 20 cm deep
  float max_body_depth_step_m = 0.35F;  // anthropometry: of the body above a chest that is no head
  float max_shoulder_depth_step_m =
      0.3F;           // anthropometry: of who turns sideways: half the breadth, 22 cm, and more
  int max_above = 5;  // of 15 points above it; a lifted arm covers one column of three
  int max_ring = 3;   // of 14 points of the ring that may be filled
  float shoulders_below_m = 0.32F;  // anthropometry: centre of the head to the shoulders' row,
  float shoulders_half_m = 0.17F;   // ... and half their width
  float occluder_m = 0.1F;          // sensor: what is so much nearer occludes the shoulders
};

/// People and their heads before a camera under the ceiling. Heights are over the floor. Set by
/// hand on the dev stills of `ossa experiment real` (itop_top), whose heads score 0.88 to 1.
struct OverheadOptions {
  float foot_m = 0.12F;          // sensor: what is lower is the floor, and feet on it
  float min_head_m = 0.5F;       // anthropometry: of a child, or of who sits on the floor,
  float max_head_m = 2.3F;       // ... and of a tall person on heels
  float inner_radius_m = 0.07F;  // anthropometry: well inside any head
  float outer_radius_m = 0.20F;  // anthropometry: well outside any head, on the shoulders
  float level_m = 0.08F;    // anthropometry: of points on top of one head: a third of its height
  float lower_m = 0.10F;    // anthropometry: shoulders and neck are so much lower
  float min_disc = 0.75F;   // share of the disc that is level
  float min_score = 0.85F;  // share of the disc x lower share of the ring
  float min_distance_m =
      0.35F;  // anthropometry: of heads over the floor: shoulders keep them apart
  // Over the floor from the middle of the head:
  float reach_m = 1.3F;   // anthropometry: a foot or hand stretched out by who leans the same way
  float trunk_m = 0.45F;  // anthropometry: trunk, and the knees and elbows close to it
};

/// How a connected region is cut into one piece a person.
struct SeedOptions {
  float head_radius_m = 0.12F;  // anthropometry: of the disc around a head that belongs to it
  float owner_step_m = 0.25F;   // from frame to frame a running person's head moves 15 cm
  size_t min_track_cells = 40;  // of a track in a region, to be a seed; of 160 x 120 cells
  float max_reach_m = 1.75F;    // anthropometry: over the surface from the head to the farthest toe
  float growth_m = 0.5F;        // beyond where a track was a frame ago: limbs that were missed
  float background_rim_m = 0.06F;  // so far a track enters the background: silhouettes flicker
  float sideways = 1.5F;           // times the way sideways costs more than down: bodies are tall
  float jump_cost_m = 0.3F;        // of a step where the surface is not continuous
  float one_person_m2 = 1.0F;      // anthropometry: more is more than a person
  int one_person_background_cells = 40;  // a lone track with more in the background is cut
};

/// How small regions and those beside occluders become one.
struct MergeOptions {
  float whole_m2 = 0.12F;  // smaller regions are hands, forearms, lower legs: pieces of others,
  float reach_m = 0.42F;   // ... within a forearm and a hand's length of them (anthropometry)
  float search_m = 0.12F;  // in the image around a piece's cells, at its depth
  int min_search_cells = 3, max_search_cells = 16;
  // A piece that comes out beside a track of which a good part is hidden: at most this share of the
  // surface seen lately is in view, and with the piece at most this.
  float hidden_share = 0.75F, whole_share = 1.1F;
  float expected_aside_m = 0.35F, expected_deep_m = 0.25F;  // off the track's predicted place,
  float stride_m = 0.6F;  // ... or a step (anthropometry) with nothing but nearer surface between
  float sideways_m2 = 0.3F;  // anthropometry: of an adult seen from the side
};

/// When two regions with something nearer between them are one person.
struct OcclusionOptions {
  float nearer_m = 0.1F;    // sensor: an occluder is so much nearer than both,
  float farther_m = 0.15F;  // ... and what is so much farther is the room between two things
  float occluded_share = 1.0F / 3;  // share of the way between them in the image, at least
  float beside_aside_m = 0.7F, beside_deep_m = 0.5F;  // over the floor: who is hidden is in stride
  float above_aside_m = 0.35F, above_deep_m = 0.3F;   // one above the other
  float person_m2 = 0.5F;  // both together are no more than what shows beside an occluder
  // Legs below a table: below the body, broader than a table's own.
  float legs_aside_m = 0.3F, legs_deep_m = 0.35F, legs_below_m = 0.45F;
  float min_legs_m2 = 0.02F, max_legs_m2 = 0.3F, legs_width_m = 0.09F;  // anthropometry
  float min_body_m2 = 0.12F;
};

/// What of a fresh scene in which nobody is found is tried as one body that is occluded in its
/// middle. By hand on rendered first frames of validation subjects (docs/benchmarks/tracking.md);
/// in 240 rooms whose people were cut out nobody is found by it.
struct JoinOptions {
  float piece_m2 = 0.01F;   // anthropometry: a hand and a wrist; less changes no score
  float first_m2 = 0.02F;   // anthropometry: a face; what grows begins with no less
  float occluder_m = 0.2F;  // anthropometry: an arm's width in front of it, and its shadow
  float step_m = 0.35F;     // anthropometry: a forearm's length: so far before a chest hands hold
  float farther_m = 0.15F;  // sensor: what is so much farther than both is the room behind them
  float person_m2 = 0.5F;   // all together are no more than what shows beside an occluder
  int border_cells = 3;     // of 160 x 120, at the lower border: sensors leave rows out
};

/// Seat backs, boxes, screens: all but one plane, and things are behind them.
struct PlanarOccluderOptions {
  float min_m2 = 0.08F;        // anthropometry: less is the flat side of a limb or a head
  double planar_share = 0.85;  // of the cells; edges are never flat
  double behind_m = 0.1;       // anthropometry: a chin and a neck lie less far behind a chest
};

/// How cells and regions are given to the tracks of the frames before.
struct PredictionOptions {
  double max_step_s = 0.1;        // a velocity moves cells for at most so long,
  double max_prediction_s = 0.5;  // ... and a body's middle: nobody walks straight for long
  float same_depth_m = 0.12F;     // of a cell in two frames
  size_t overlap_fraction = 4;    // a track goes on where 1 / so many of its cells or theirs are
  float return_gate_m = 0.6F;     // a step off the predicted place a lost person may reappear,
  float return_speed_m_s = 0.7F;  // ... growing with time
  float height_weight = 0.3F;     // of somebody half hidden height says little
};

struct CandidateOptions {
  float speck_m2 = 0.004F;     // anthropometry: a fist has 0.006; less is noise
  float min_area_m2 = 0.07F;   // anthropometry: head and shoulders
  float min_height_m = 0.28F;  // ... or length
  size_t min_cells = 30;       // of 160 x 120
  // Of what stands before the background: a head over somebody nearer.
  float min_foreground_area_m2 = 0.045F, min_foreground_height_m = 0.2F;
  // Close to somebody seen a new piece may be the rest of them: so far off their predicted middle,
  // and from their nearer side, over the floor.
  float rest_m = 0.45F, beside_m = 0.7F;
  depth::SilhouetteOptions silhouette;
  HeadOptions heads;
  std::optional<OverheadOptions> overhead;  // instead, where the camera is under the ceiling
  SeedOptions seeds;
  MergeOptions merge;
  OcclusionOptions occlusion;
  JoinOptions join;
  PlanarOccluderOptions occluder;
  PredictionOptions prediction;
};

/// What the forest is asked about a candidate.
struct EvidenceOptions {
  bool from_above = false;   // by the weights of people and things under a camera at the ceiling
  double sample_m = 0.012;   // pixels are thinned until one stands for so much of the surface,
  size_t max_pixels = 6000;  // ... and further, to at most so many: time;
  size_t max_rejected_pixels = 1500;  // ... of what scored low a moment ago
  double min_surface_score =
      0.1;                      // score by the surface alone; below, no joints are proposed: time
  double min_head_m2 = 0.009;   // anthropometry: half of a face, a disc of 15 cm
  double min_head_share = 0.4;  // share of the largest head's surface: heads are of about one size
  double min_head_distance_m = 0.3;  // sideways: nobody stands on another one's shoulders
};

/// What the forest saw of a track a moment ago, for the next frame.
struct TrackPriorOptions {
  double memory = 0.85;        // share of the mean score in the new one
  int min_facing_age = 12;     // detections; before, on furniture the belief would feed itself
  double facing_s = 0.2;       // longer ago says nothing about now
  float fresh_facing = 0.05F;  // share that starts anew: an error does not keep itself alive
  double moving_s = 1.0;       // since the last shift; who is new may not have shifted yet
};

/// Which candidates the forest looks at, and what it makes of several together.
struct ClassificationOptions {
  size_t max_candidates = 16;  // the largest first: time
  double rejected = 0.35;      // mean score below which a tentative track is looked at only ...
  double retry_s = 0.25;       // ... so much later, one in a frame,
  double max_retry_s = 0.5;    // ... or this much, however many
  int mature_age = 30;         // detections; then a person is not taken for part of another,
  float grown_share = 1.2F;    // times the surface seen lately; else it is not taken for two
  float two_people_m2 = 1.1F;  // anthropometry: together they are more than one person
  double stacked_loss =
      0.2;  // of score: one above the other need not look better together: nobody stands
  float stacked_m = 0.3F;   // ... on another; so close aside and in depth
  float leaning_m = 0.45F;  // ... where both look like people: who bends leans so far
  // Halves of a person meet along a rim: within so many cells over the shadow that an edge casts,
  // with at most such a jump, as from a shirt's hem to the trousers, and so long.
  int rim_cells = 2;
  float rim_jump_m = 0.15F, rim_m = 0.1F;
  double max_bone = 1.4;      // of an average body's bone: longer ones hang together with nothing
  float crop_m = 0.3F;        // anthropometry: half a stout trunk, and what proposals are off
  float crop_far_m = 0.4F;    // more than that ever is
  float crop_area_m2 = 0.9F;  // anthropometry: nobody free of furniture shows more
  float same_pose_m = 0.35F;  // anthropometry: joints of two people are farther apart, in the mean
  float pieces_m = 1.0F;      // anthropometry: the middles of two pieces of a person are nearer
  // In a fresh scene what is no person as it stands is cut once more, around its heads: so far over
  // the surface (anthropometry: to the hands of half-spread arms; to the hips), if at most that
  // share is left, and it is a person with this score, at which none of 413 other things passed.
  std::array<float, 2> touching_reach_m = {1.1F, 0.8F};
  float touching_share = 0.9F;
  double touching_person = 0.7;
  size_t min_crop_bones = 6;      // fewer: the forest saw too little of the body to say
  size_t min_cropped_cells = 40;  // taken off for less, silhouettes would flicker
};

/// What score, [0, 1], a candidate needs to become or stay a person. Thresholds of a logistic
/// regression whose single observations pass 96 % of the people and 0.8 % of other things at 0.6
/// (`ossa experiment person-classifier`).
struct InitiationOptions {
  // A new track with a head's shape in a fresh scene, where there is one look only, or as the mean
  // of a few observations at what moved; other new tracks in a fresh scene, and as the mean of a
  // few observations at what stands still; and somebody tracked a moment ago: hysteresis keeps who
  // turns away.
  double new_person = 0.6;
  double sure_person = 0.93;
  double known_person = 0.25;
  // Where the pose network has its say (ComputeScoreWithPose), in place of the former two: 96 % of
  // the people in rendered first frames pass, and 2 of 413 other things.
  double person_by_pose = 0.5;
  // ... but where the forest is sure by itself, so little leaves the decision to it, at a first
  // look with the surface fit's consent: of who is near and half outside the image the network
  // knows less.
  double contested_person = 0.1;
  // Without a network the surface fit decides about who has less than sure_person at a first look,
  // too: at least so much is explained less what is seen through (recon::SurfaceFit::score).
  // Rendered and real dev stills: 1 of 16 such people has less, 14 of 16 such things have.
  double least_body = 0.5;
  // Beside somebody about whom there is no doubt more is asked: so much is explained, less half of
  // what is seen through, and so much of the forest's score. On rendered first frames people have
  // 0.945 and more, most coats on stands less than 0.94.
  double person_share = 0.3;
  double least_other_body = 0.94;
  int tentative_observations = 4;
  int standing_observations =
      3;  // of what has not moved, unbroken: scraps of furniture come and go
  // What stands before the background: furniture does not come by itself. At the first look; and,
  // where something nearer hides part of it, so that little is seen, as the mean of a few; and once
  // it was accepted, while it moves.
  double foreground_first = 0.6;   // score
  double foreground_mean = 0.15;   // score
  double foreground_known = 0.02;  // score
  // ... and what also went so far over the floor since the first look, with nobody beside whose
  // rest it may be: only people walk.
  double walked_m = 0.5;        // anthropometry: less than a step
  double walked_person = 0.02;  // score
  // Somebody accepted a few observations ago: what was a person by luck is none on average.
  double early_person = 0.4;  // score
  int early_age = 12;
  // What has not moved at all after so many observations: most likely furniture. Of somebody
  // accepted less is asked, for who sits behind a thing that does not move seems not to move,
  // either.
  double still_person = 0.75;  // score
  double still_known = 0.7;    // score
  int still_age = 10;
  int mature_age = 30;           // detections; who bends down then was somebody before
  double occluded_share = 0.12;  // share of the silhouette: some of it may be out of sight
  double forget_s = 2.0;         // a tentative track that is not seen
  int max_observations = 8;      // that a tentative track's mean is of
  double unbroken_s = 0.12;      // three frames at 30 Hz: single ones may be missed
  double same_place = 0.6;       // cells of the larger in common: the same thing as before
  float step_m = 0.25F;          // what came moves so far between two observations,
  double step_s = 0.2;           // ... which are so near in time
  int max_users = 6;             // most people at a time, >= 1; the SDK's
};

/// Velocity and movement of a track.
struct MotionOptions {
  float half_hidden = 0.8F;    // share of the surface seen lately below which a person is hidden
  float max_hidden_m = 0.35F;  // from what is seen of who is hidden to where they are expected
  double max_hidden_s = 0.5;   // ... who go on as before for so long
  float forget_area = 0.99F;   // a frame; who turns sideways shows less for long
  // Shares of a new velocity in the next. Keypoints jump by centimetres: with shares of 0.5, 0.25,
  // 0.15 and 0.1 the velocity sideways was off by 0.34, 0.25, 0.22 and 0.22 m/s (rms, validation
  // subjects crossing, half hidden); by the surface by 0.34.
  float keypoint_share = 0.2F, surface_share = 0.5F;
  float max_m_s = 4.0F;               // anthropometry: nobody is faster in view of a Kinect
  float min_s = 1e-3F, max_s = 0.5F;  // between two frames that a velocity is of
  size_t min_keypoints = 4;           // seen in both
  float moved_m = 0.05F;              // furniture stays where it is ...
  float moved_area = 0.15F;  // ... and shows the same surface; people shift, breathe and turn
};

/// When somebody who comes into view is one of those who went out of it, and not somebody new.
struct ReidentifyOptions {
  double forget_s = 2.5;           // after so long out of view a person is new,
  double forget_occluded_s = 5.0;  // ... after so long behind somebody
  double walk_s = 2.0;             // how long who is out of view walks on as before
  double walk_share = 0.6;         // share of those out of view who walk on,
  double stay_share = 0.3;  // share of those who stay about there; the others may be anywhere
  // Standard deviations over the floor of where somebody is who walked on, stayed, or went
  // anywhere: metres, and metres for each second out of view.
  double walk_m = 0.2, walk_m_s = 0.35, stay_m = 0.25, stay_m_s = 0.25, any_m = 0.5, any_m_s = 0.9;
  double rough_m_s = 1.0;  // more where the velocity is of one frame, of n frames 1 / n
  // New people for each of those who come back, a square metre of floor: few appear in the middle
  // of a room, and hardly anybody out of nothing behind somebody nearer.
  double new_border_per_m2 = 0.1;
  double new_open_per_m2 = 0.02;
  double new_occluded_per_m2 = 0.004;
  double other_way = 0.3;  // likelihood of who went behind somebody to come back elsewhere, or v.v.
  float border_m = 0.3F;   // to the image's border, or to somebody nearer: what a walker covers
                           // during the first observations
  float occluder_m = 0.1F;  // sensor: somebody so much nearer occludes
  BodyMatchOptions measures;
};

struct AssociationOptions {
  float same_depth_m = 0.15F;  // of a cell in two frames
  size_t heir_factor = 2;      // times as many cells another piece must hold to take an id over
  double same_cells = 8;       // log odds that what is where somebody just was is them,
  double min_overlap = 0.3;    // ... from such a share in common,
  double overlap_s = 0.5;      // ... within so long
  double nobody_yet = 1;       // log odds against what is nobody yet being one of the lost
  double rival_taken = 0.1;    // share of a rival's cells that people may hold
  double cells_s = 0.2;        // then the last cells say nothing any more
  MotionOptions motion;
  ReidentifyOptions reidentify;
};

struct MeasureOptions {
  double min_confidence =
      0.3;  // confidence of a joint's proposal, to be a keypoint or end of a measure
  // Of the average body: shorter than a child's or longer than anybody's are the limbs of people
  // half hidden (anthropometry).
  double min_length = 0.55, max_length = 1.4;
};

struct PeopleOptions {
  depth::SceneOptions scene;
  CandidateOptions candidates;
  TrackPriorOptions prior;
  EvidenceOptions evidence;
  ClassificationOptions classification;
  InitiationOptions initiation;
  MeasureOptions measure;
  AssociationOptions association;
  int threads = 1;              // candidates are classified on, >= 1; the result is the same
  bool trace_surfaces = false;  // PeopleInFrame::decisions also holds furniture and background
};

/// Of a camera under the ceiling that looks down.
PeopleOptions PeopleOptionsFromAbove();

}  // namespace ossa::people
