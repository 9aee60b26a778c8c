#pragma once
#include <array>
#include <cstddef>
#include <optional>

#include "depth/scene/measure_scene.h"
#include "depth/scene/silhouette.h"
#include "tools/people/body_measures.h"

/// All thresholds of person detection and tracking, by stage.
///
/// Constants: where a line names no other origin ("anthropometry": bodies of 1 to 2 m must pass;
/// "sensor": noise and quantisation of structured light at 1 to 6 m), a value was set by hand
/// during development on rendered rooms with validation subjects (`ossa experiment indoor-scenes
/// --seed 1 --parameters p.toml`, p.toml: mocap of validation subjects); no sweep over it is
/// recorded. Ranges: lengths, areas, times and counts are > 0; shares, scores and weights are in
/// [0, 1]. Areas are of visible surface, as seen frontally. Cells are of the 160 x 120 point grid.
namespace ossa::people {

/// A share above this is the majority of the cells.
inline constexpr double kMajority = 0.5;

/// Head detection by shape: a blob of about 20 cm, free at its sides and above, shoulders below.
struct HeadOptions {
  float inner_radius_m = 0.085F;        // anthropometry: inside any head
  float outer_radius_m = 0.19F;         // anthropometry: outside any head, above the shoulders
  float min_score = 0.4F;               // filled share of the disc x free share of the ring
                                        // x filled share of the shoulders' row
  float min_distance_m = 0.25F;         // anthropometry: between the heads of two people, each
                                        // 15 cm wide; of closer ones the best is kept
  float max_depth_step_m = 0.15F;       // anthropometry: a head is less than 20 cm deep
  float max_body_depth_step_m = 0.35F;  // anthropometry: of body above a chest; then it is no head
  float max_shoulder_depth_step_m = 0.3F;  // anthropometry: of shoulders in profile, at least half
                                           // the breadth, 22 cm
  int max_above = 5;  // filled points above the head, of 15; a raised arm fills a column of three
  int max_ring = 3;   // filled points of the ring, of 14
  float shoulders_below_m = 0.32F;  // anthropometry: from the centre of the head down to the row
  float shoulders_half_m = 0.17F;   // anthropometry: half the width of that row
  float occluder_m = 0.1F;          // sensor: surface nearer by this occludes the shoulders
};

/// Head detection by shape for a camera under the ceiling. Heights are above the floor. Set by
/// hand on the dev stills of `ossa experiment real` (itop_top), whose heads score 0.88 to 1.
struct OverheadOptions {
  float foot_m = 0.12F;          // sensor: below this height are the floor and feet on it
  float min_head_m = 0.5F;       // anthropometry: a child, or a person sitting on the floor
  float max_head_m = 2.3F;       // anthropometry: a tall person in heels
  float inner_radius_m = 0.07F;  // anthropometry: inside any head
  float outer_radius_m = 0.20F;  // anthropometry: outside any head, on the shoulders
  float level_m = 0.08F;         // anthropometry: depth of a head's top, a third of its height
  float lower_m = 0.10F;         // anthropometry: shoulders and neck are lower by this
  float min_disc = 0.75F;        // share of the disc that is level
  float min_score = 0.85F;       // level share of the disc x lower share of the ring
  float min_distance_m = 0.35F;  // anthropometry: between heads, kept apart by shoulders
  // Horizontal distances from the middle of the head:
  float reach_m = 1.3F;   // anthropometry: a foot or hand stretched out while leaning towards it
  float trunk_m = 0.45F;  // anthropometry: trunk, and the knees and elbows close to it
};

/// How a connected region is split into one segment per person.
struct SeedOptions {
  float head_radius_m = 0.12F;  // anthropometry: disc around a head that belongs to it
  float owner_step_m = 0.25F;   // between frames the head of a running person moves 15 cm
  size_t min_track_cells = 40;  // cells of a track in a region, to seed a segment
  float max_reach_m = 1.75F;    // anthropometry: over the surface from the head to the farthest toe
  float growth_m = 0.5F;        // beyond the track's last segment: limbs that it missed
  float background_rim_m = 0.06F;  // a track may enter the background this far: edges flicker
  float sideways = 1.5F;           // factor: horizontal steps cost more, since bodies are tall
  float jump_cost_m = 0.3F;        // added to a step across a depth discontinuity
  float one_person_m2 = 1.0F;      // anthropometry: largest visible surface of one person
  int one_person_background_cells = 40;  // a lone track with more of the background is split
};

/// How small regions, and regions beside occluders, are merged.
struct MergeOptions {
  float whole_m2 = 0.12F;  // anthropometry: smaller regions are hands, forearms, lower legs,
  float reach_m = 0.42F;   // ... merged within the length of a forearm and a hand
  float search_m = 0.12F;  // in the image around a small region's cells, at its depth
  int min_search_cells = 3, max_search_cells = 16;
  // A region that appears beside a partly occluded track: the track's largest recent surface is
  // visible to at most hidden_share, and together with the region to at most whole_share. Regions
  // at such a track's depth are not merged into another track.
  float hidden_share = 0.75F, whole_share = 1.1F;
  float expected_aside_m = 0.35F, expected_deep_m = 0.25F;  // from the track's predicted place,
  float stride_m = 0.6F;     // ... or one step (anthropometry) across an occluder
  float sideways_m2 = 0.3F;  // anthropometry: visible surface of an adult in profile
};

/// When two regions with an occluder between them are one person.
struct OcclusionOptions {
  float nearer_m = 0.1F;    // sensor: an occluder is nearer than both regions by this
  float farther_m = 0.15F;  // sensor: surface farther than both by this is a gap between objects
  float occluded_share = 1.0F / 3;  // least share of occluder on the line between them
  float beside_aside_m = 0.7F, beside_deep_m = 0.5F;  // horizontally: an occluded walker's stride
  float above_aside_m = 0.35F, above_deep_m = 0.3F;   // horizontally, one above the other
  float person_m2 = 0.5F;  // largest sum of both: what is visible beside an occluder
  // Legs below a table: below the body, and wider than the table's legs.
  float legs_aside_m = 0.3F, legs_deep_m = 0.35F, legs_below_m = 0.45F;
  float min_legs_m2 = 0.02F, max_legs_m2 = 0.3F, legs_width_m = 0.09F;  // anthropometry
  float min_body_m2 = 0.12F;
};

/// Which regions of a fresh scene without detections are tried as one body occluded in its middle.
/// By hand on rendered first frames of validation subjects (docs/benchmarks/tracking.md); in 240
/// rooms without people it yields no false positive.
struct JoinOptions {
  float piece_m2 = 0.01F;   // anthropometry: a hand and a wrist; less changes no score
  float first_m2 = 0.02F;   // anthropometry: a face; the smallest region that others are added to
  float occluder_m = 0.2F;  // anthropometry: an arm's width in front of it, and its shadow
  float step_m = 0.35F;     // anthropometry: a forearm's length: hands in front of a chest
  float farther_m = 0.15F;  // sensor: surface farther than both by this is the room behind them
  float person_m2 = 0.5F;   // largest sum: what is visible beside an occluder
  int border_cells = 3;     // at the lower border: sensors leave rows out
};

/// Seat backs, boxes, screens: nearly planar regions that occlude people.
struct PlanarOccluderOptions {
  float min_m2 = 0.08F;        // anthropometry: less is the flat side of a limb or a head
  double planar_share = 0.85;  // of the cells; edges are never flat
  double behind_m = 0.1;       // anthropometry: more than from a chest back to its chin and neck
};

/// Who was a person for sure (AssociationOptions::certain_s) stays one, whatever the score, while
/// more than this share of their surface is foreground, or less than this share is the known room:
/// somebody on the floor or in a sofa is hardly in front of it.
struct RestOptions {
  double foreground_share = 0.2, background_share = 0.3;
  // Anthropometry: the middle of who lies or sits on the floor is below this height.
  double floor_below_m = 0.5;
  // Seconds for which somebody on the floor counts as that who was it: noise hides them at times.
  double lay_s = 1.0;
};

/// How cells and regions are assigned to the tracks of earlier frames.
struct PredictionOptions {
  double max_step_s = 0.1;        // longest prediction of a track's cells
  double max_prediction_s = 0.5;  // ... of its centroid: paths are straight for no longer
  float same_depth_m = 0.12F;     // between a cell's depths in two frames
  size_t overlap_fraction = 4;    // a track needs an overlap of 1 / this of its or the candidate's
                                  // cells
  double in_plane_share = 0.33;   // of a track's cells in the plane of furniture; more are a person
  double plane_score = 0.75;      // mean score of a track over which no plane grows, [0, 1]
  // Anthropometry: of who lies, from the middle to head or feet, and a step.
  float lying_reach_m = 1.2F;
  RestOptions rest;
  double return_score = 0.6;      // last mean score of a track, [0, 1], that may return
  float return_gate_m = 0.6F;     // a step: from the predicted place of a lost track,
  float return_speed_m_s = 0.7F;  // ... growing with time
  float height_weight = 0.3F;     // of the vertical offset: occlusion changes the centroid's height
};

struct CandidateOptions {
  float speck_m2 = 0.004F;     // anthropometry: a fist has 0.006; less is noise
  float min_area_m2 = 0.07F;   // anthropometry: head and shoulders
  float min_height_m = 0.28F;  // ... or length
  size_t min_cells = 30;
  // Of foreground: a head above a nearer person.
  float min_foreground_area_m2 = 0.045F, min_foreground_height_m = 0.2F;
  float min_rest_area_m2 = 0.03F;  // anthropometry: a face; of a person for sure
  // A new candidate may be part of a tracked person: horizontally, from the track's predicted
  // centroid and from the nearest side of its segment.
  float same_person_m = 0.45F, beside_person_m = 0.7F;
  // Nearer, it may be a lost track if it is before or behind the tracked person by more than a
  // trunk is thick (anthropometry), and off the lost track's depth by at most this share of that.
  float other_depth_m = 0.25F, lost_depth_share = 0.75F;
  depth::SilhouetteOptions silhouette;
  HeadOptions heads;
  std::optional<OverheadOptions> overhead;  // replaces `heads` for a camera under the ceiling
  SeedOptions seeds;
  MergeOptions merge;
  OcclusionOptions occlusion;
  JoinOptions join;
  PlanarOccluderOptions occluder;
  PredictionOptions prediction;
};

/// How a candidate is classified by the forest.
struct EvidenceOptions {
  bool from_above = false;   // use the weights for a camera under the ceiling
  double sample_m = 0.012;   // pixels are subsampled until one stands for this much surface,
  size_t max_pixels = 6000;  // ... and to at most this many: for speed,
  size_t max_rejected_pixels = 1500;  // ... fewer where the candidate was recently rejected
  double min_surface_score = 0.1;  // score before joints are proposed; below, none are: for speed
  double min_head_m2 = 0.009;      // anthropometry: half of a face, a disc of 15 cm
  double min_head_share = 0.4;     // share of the largest head's surface: heads have similar sizes
  double min_head_distance_m = 0.3;  // horizontally: people do not stand on each other
};

/// What the track of earlier frames contributes to the classification of the next frame.
struct TrackPriorOptions {
  double memory = 0.85;        // weight of the mean score against that of the new frame
  int min_facing_age = 12;     // detections; before, a false positive would reinforce itself
  double facing_s = 0.2;       // longest age of the facing estimate
  float fresh_facing = 0.05F;  // share of a uniform prior: errors do not sustain themselves
  double moving_s = 1.0;       // since the last movement; a new person may not have moved yet
};

/// Which candidates are classified, and when they are merged, split or cropped.
struct ClassificationOptions {
  size_t max_candidates = 16;    // the largest first: for speed
  double rejected_score = 0.35;  // mean score below which a tentative track is classified again ...
  double retry_s = 0.25;         // ... only after this time, one per frame,
  double max_retry_s = 0.5;      // ... or after this time, any number
  int mature_age = 30;           // detections; then a person is not merged into another any more,
  float grown_share = 1.2F;      // ... and not split below this factor of the recent surface
  float two_people_m2 = 1.1F;    // anthropometry: a larger sum is more than one person
  // Score that merging may cost where one is above the other: people do not stand on each other.
  double max_stacked_score_loss = 0.2;
  float stacked_m = 0.3F;   // horizontal distance for that,
  float leaning_m = 0.45F;  // ... where both are classified as people: a person may be leaning
  // Halves of a person share a rim: within rim_cells across the shadow that an edge casts, over a
  // depth jump of at most rim_jump_m, as from a shirt's hem to the trousers, for at least rim_m.
  int rim_cells = 2;
  float rim_jump_m = 0.15F, rim_m = 0.1F;
  double max_bone_ratio = 1.4;  // factor of the average body's bone; longer ones are not connected
  float crop_m = 0.3F;          // anthropometry: half a stout trunk and the error of proposals
  float crop_far_m = 0.4F;      // larger than that sum ever is
  float crop_area_m2 = 0.9F;    // anthropometry: visible surface of one person without furniture
  float same_pose_m = 0.35F;    // anthropometry: mean joint distance of two people is larger
  float pieces_m = 1.0F;        // anthropometry: between the centroids of two parts of a person
  // In a fresh scene a candidate that is not accepted is cropped around its heads: to this distance
  // over the surface (anthropometry: to the hands of half-spread arms; to the hips), if at most
  // max_head_piece_share is left and its score, which none of 413 other objects had, is reached.
  std::array<float, 2> head_piece_reach_m = {1.1F, 0.8F};
  float max_head_piece_share = 0.9F;
  double head_piece_score = 0.7;
  size_t min_crop_bones = 6;      // fewer describe too little of the body
  size_t min_cropped_cells = 40;  // removing fewer would make silhouettes flicker
};

/// The score, [0, 1], that a candidate needs to be accepted and to stay accepted. Thresholds of a
/// logistic regression that passes 96 % of the people and 0.8 % of other objects at 0.6 in single
/// frames (`ossa experiment person-classifier`).
struct InitiationOptions {
  // New, with a detected head in a fresh scene, decided in one frame; or as the mean of several
  // observations of what moved.
  double new_person_score = 0.6;
  // New, in a fresh scene without a detected head; or as the mean of several observations of what
  // did not move.
  double confident_score = 0.93;
  // Hysteresis: of a track, so that a person who turns away is kept.
  double tracked_score = 0.25;
  // Where the pose network contributes (ComputeScoreWithPose), this replaces new_person_score and
  // confident_score. docs/benchmarks/tracking.md has its choice.
  double person_by_pose_score = 0.6;
  // Less is enough for a track that never moved, and for each half of a divided person.
  double weak_by_pose_score = 0.5;
  // New, farther than this and at the image's upper border, where the head is cut off: of 14 such
  // objects in real rooms 13 have less.
  double cut_by_pose_score = 0.75;
  float cut_beyond_m = 1.5F;
  // Where the forest alone is confident, a score with the network of at least this leaves the
  // decision to the surface fit: the network is less reliable for people near the camera and half
  // outside the image.
  double contested_score = 0.1;
  // Without a network the surface fit also decides in a single frame about scores below
  // confident_score: least share explained less the share seen through (recon::SurfaceFit::score).
  // Rendered and real dev stills: 1 of 16 such people has less, 14 of 16 such objects have.
  double min_fit_score = 0.5;
  // If the forest and the network disagree (contested_score), farther than contested_beyond_m:
  // nearer, much of a person is outside the image. On real furniture 15 of 17 such objects have
  // less; about people so far away the two rarely disagree (5 of 1 581 in rendered first frames).
  double min_fit_score_contested = 0.75;
  float contested_beyond_m = 1.2F;  // by hand: where a Kinect v1 sees a trunk and a head
  // Beside a person without doubt the threshold is higher: on the share explained less half of the
  // share seen through, plus the forest's score times person_score_weight. On rendered first frames
  // people have 0.945 and more, most coats on stands less than 0.94.
  double person_score_weight = 0.3;
  double min_fit_score_beside_person = 0.94;
  int tentative_observations = 4;
  int standing_observations = 3;  // consecutive, of what did not move: parts of furniture flicker
  // Foreground needs less, because furniture does not enter by itself: in the first frame; partly
  // occluded, as the mean of several observations; and once accepted, while it moves.
  double foreground_first_score = 0.6;   // score
  double foreground_mean_score = 0.15;   // score
  double foreground_track_score = 0.02;  // score
  // Isolated foreground that walked this far since its first observation: only people walk.
  double walked_m = 0.5;       // anthropometry: less than a step
  double walked_score = 0.02;  // score
  RestOptions rest;
  // A track this young: a chance detection of another object has a low mean.
  double early_track_score = 0.4;  // score
  int early_age = 12;              // detections
  // Mean score of a new track that moves but was rejected before or was never foreground: a surface
  // that grows while a person who hid it walks past seems to move, too.
  double doubtful_mean_score = 0.75;  // score
  // Tracks without any movement after still_age observations are most likely furniture, unless the
  // pose network contributes (person_by_pose_score); lower, because a person behind a chair may
  // seem not to move.
  double still_track_score = 0.7;  // score
  int still_age = 10;              // detections
  int mature_age = 30;             // detections; then a person who bends down stays a person
  double occluded_share = 0.12;    // share of the silhouette; above, a part may be occluded
  double forget_s = 2.0;           // age of an unseen tentative track when it is deleted
  int max_observations = 8;        // in the mean of a tentative track
  double unbroken_s = 0.12;        // three frames at 30 Hz: single ones may be missed
  double likely_score = 0.9;       // by hand: a tentative track that may be a person's
  double likely_share = 0.8;       // of its cells: it is a part of a larger segment; by hand
  double min_common_share = 0.6;   // of the larger segment's cells: the same object as before,
  float same_depth_m = 0.3F;       // ... if it is not nearer or farther by more: half a step
  float step_m = 0.25F;  // largest movement between two observations of moving foreground,
  double step_s = 0.2;   // ... which are at most this far apart
  int max_users = 6;     // most people tracked at a time, >= 1; the SDK's
};

/// Velocity and movement of a track.
struct MotionOptions {
  float half_hidden = 0.8F;    // share of the recent surface below which a person is occluded
  float max_hidden_m = 0.35F;  // from an occluded person's visible centroid to the predicted one
  double max_hidden_s = 0.5;   // longest prediction for that
  float forget_area = 0.99F;   // factor per frame: a person in profile shows less for long
  // Weights of a new velocity. Keypoints jump by centimetres: with weights of 0.5, 0.25, 0.15 and
  // 0.1 the sideways velocity was off by 0.34, 0.25, 0.22 and 0.22 m/s (rms, validation subjects
  // crossing, half occluded); measured by the surface, by 0.34.
  float keypoint_share = 0.2F, surface_share = 0.5F;
  float max_m_s = 4.0F;               // anthropometry: bound of walking speed in a Kinect's view
  float min_s = 1e-3F, max_s = 0.5F;  // between two frames that give a velocity
  size_t min_keypoints = 4;           // seen in both frames
  float moved_m = 0.05F;              // displacement, or
  float moved_area = 0.15F;  // ... change of surface that counts as movement: people shift,
                             // breathe and turn, furniture does not
};

/// Criteria by which a person who appears is a lost track and not a new one.
struct ReidentifyOptions {
  double forget_s = 2.5;           // a track is deleted after this time out of view,
  double forget_occluded_s = 5.0;  // ... or after this time behind another person
  double walk_s = 2.0;             // time constant of walking on after the loss
  double walk_share = 0.6;         // prior that a lost person walks on,
  double stay_share = 0.3;         // ... or stays; the rest may go anywhere
  // Standard deviations of the position on the floor of a person who walked on, stayed, or went
  // anywhere: metres, and metres per second out of view.
  double walk_m = 0.2, walk_m_s = 0.35, stay_m = 0.25, stay_m_s = 0.25, any_m = 0.5, any_m_s = 0.9;
  double velocity_noise_m_s = 1.0;  // standard deviation of a velocity of one frame; of n: 1 / n
  // New people per returning person and square metre of floor: few appear in the middle of a room,
  // and hardly any from behind another person.
  double new_border_per_m2 = 0.1;
  double new_open_per_m2 = 0.02;
  double new_occluded_per_m2 = 0.004;
  double unexpected_entrance = 0.3;  // likelihood factor where a person lost behind another returns
                                     // elsewhere, or vice versa
  float border_m = 0.3F;    // to the image's border, or to a nearer person: the path of a walker
                            // during the first observations
  float occluder_m = 0.1F;  // sensor: a person nearer by this occludes
  BodyMatchOptions measures;
};

struct AssociationOptions {
  float same_depth_m = 0.15F;   // between a cell's depths in two frames
  size_t takeover_factor = 2;   // another segment takes an id over with this factor of common cells
  double overlap_log_odds = 8;  // log-odds per share of cells in common with a lost track,
  double min_overlap = 0.3;     // ... from this share on,
  double overlap_s = 0.5;       // ... within this time
  double rival_log_odds = 1;    // log-odds against an unconfirmed candidate being a lost track
  double max_rival_taken_share = 0.1;  // share of a rival's cells that people may hold
  double keep_cells_s = 0.2;           // age of a lost track's cells when they are deleted
  // A track of this age, in detections, with this mean score is a person for sure, for this time
  // since then, or since their last movement in front of the room as it was: long enough to lie on
  // the floor or sit deep in a sofa, where people hardly score.
  int certain_age = 12;
  double certain_score = 0.75;
  double certain_s = 30.0;
  // Somebody on the floor stays one for this time after their last movement, because who fell may
  // lie there for long: by hand, a person moves now and then, a bag that they left does not.
  // Anthropometry: the top of somebody on their elbows; the backs of chairs that they moved are
  // higher.
  double lying_s = 600.0, lying_top_m = 0.75;
  RestOptions rest;
  MotionOptions motion;
  ReidentifyOptions reidentify;
};

struct MeasureOptions {
  double min_confidence = 0.3;  // confidence of a joint's proposal, to be a keypoint or an end of a
                                // measure
  // Factors of the average body: limbs shorter than a child's or longer than anybody's belong to
  // occluded people (anthropometry).
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
  double search_every_s = 2.0;  // by hand: a search takes up to 50 ms; ThoroughSearch
  int threads = 1;              // for classification, >= 1; the result does not depend on it
  bool trace_surfaces = false;  // PeopleInFrame::decisions also lists furniture and background
};

/// Options for a camera under the ceiling that looks down.
PeopleOptions PeopleOptionsFromAbove();

}  // namespace ossa::people
