#ifndef OSSA_OSSA_C_H
#define OSSA_OSSA_C_H
/* ossa for other languages: the tracker in plain C, no exceptions, no global state.

   Depth images in, skeletons out. Positions are in camera space, metres: origin at the sensor, x to
   the sensor's left, y up, z forward. Left and right of a body are the person's own. Quaternions
   are w x y z.

   Calls that can fail return an ossa_status; ossa_last_error gives the reason of the calling
   thread's last failed call in one line. A tracker or a source is used by one thread at a time.

   Structs grow at their ends from version to version. The caller sets struct_size to the sizeof of
   a struct before passing it: `ossa_frame frame = {.struct_size = sizeof frame};`. Members that a
   program was compiled without are left alone, and members that this library does not know must be
   zero. A struct_size that no version had is an error.

   Not available here, but in C++ (ossa/ossa.h), Python and the command: reading, completing and
   comparing skeleton files, fusing several cameras (recordings only), training on a sensor, and the
   forest's probabilities and proposals. In C++ only: the mechanical world and its events. In the
   command only: sending skeletons live to other programs. */
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum {
  OSSA_OK = 0,
  OSSA_FAILED = 1,  /* see ossa_last_error */
  OSSA_END = 2,     /* ossa_source_read: the recording's last frame has been read;
                       ossa_tracker_drain_lag: all frames were returned */
  OSSA_TIMEOUT = 3, /* ossa_source_read: no frame came in time; read again */
  OSSA_HELD = 4     /* ossa_tracker_track with a lag: no frame yet; track the next image */
} ossa_status;

/* The joints of the Kinect SDK 1.x, in its order. */
typedef enum {
  OSSA_HIP_CENTER,
  OSSA_SPINE,
  OSSA_SHOULDER_CENTER,
  OSSA_HEAD,
  OSSA_SHOULDER_LEFT,
  OSSA_ELBOW_LEFT,
  OSSA_WRIST_LEFT,
  OSSA_HAND_LEFT,
  OSSA_SHOULDER_RIGHT,
  OSSA_ELBOW_RIGHT,
  OSSA_WRIST_RIGHT,
  OSSA_HAND_RIGHT,
  OSSA_HIP_LEFT,
  OSSA_KNEE_LEFT,
  OSSA_ANKLE_LEFT,
  OSSA_FOOT_LEFT,
  OSSA_HIP_RIGHT,
  OSSA_KNEE_RIGHT,
  OSSA_ANKLE_RIGHT,
  OSSA_FOOT_RIGHT,
  OSSA_JOINT_COUNT
} ossa_joint_id;

enum { OSSA_MAX_BODIES = 6 };

typedef enum { OSSA_NOT_TRACKED = 0, OSSA_INFERRED = 1, OSSA_TRACKED = 2 } ossa_joint_state;
typedef enum { OSSA_POSITION_ONLY = 0, OSSA_FULLY_TRACKED = 1 } ossa_body_state;

/* "0.1.0": the version of the loaded library, not of this header. */
const char* ossa_version(void);
/* The reason of the calling thread's last failed call; "" before the first. Valid until the next.
 */
const char* ossa_last_error(void);
/* "HipCenter" and so on, as in skeleton files; NULL for an invalid joint. */
const char* ossa_joint_name(int32_t joint);
/* The parent of a joint; -1 for OSSA_HIP_CENTER. */
int32_t ossa_joint_parent(int32_t joint);
/* The body part of a label of ossa_frame.parts, "LU arm": L and R are the person's left and right,
   U and W upper and lower; 0 "background", 32 "other" is an object held by or in front of the
   person. NULL for an invalid label. */
const char* ossa_part_name(int32_t label);

/* ---- depth images and their sources ---- */

typedef struct {
  uint32_t struct_size;
  int32_t width, height;    /* pixels */
  double fx, fy, cx, cy;    /* pixels: u = cx - fx x/z, v = cy - fy y/z */
  const uint16_t* depth_mm; /* width x height, row by row, millimetres, 0 = no reading; not
                               mirrored; those of Kinect SDKs, OpenNI2 and libfreenect2 are by
                               default: unmirror them by ossa_unmirror, else left and right of
                               people are exchanged */
  double time_s;            /* time of capture; any origin */
} ossa_depth_image;

typedef struct {
  uint32_t struct_size;
  const char* camera; /* a preset's name, "fx,fy,cx,cy" or a file, as `ossa track --camera`; NULL:
                         the source's own, else by the image size */
  double depth_scale; /* units per metre of its depths; 0: the source's own, else millimetres */
  double fps;         /* frames a second of a recording; 0: its own times */
  double wait_s;      /* for a device to be plugged in; 0: it must be there */
  const char* depth_format; /* of its 16-bit values, as `ossa track --depth-format`; NULL: plain */
  int32_t find_camera;      /* not 0: without intrinsics in the source and in `camera`, tests on
                               some images whether a camera with a narrower view took them, as
                               `ossa track` does: takes seconds; a note states the result */
  int32_t mirrored;         /* not 0: its images are mirrored, and its intrinsics, or those in
                               `camera`, are of mirrored images; both are returned unmirrored */
  /* Called about ten times a second, in the waiting thread, while a call waits for a device
     (wait_s) or a frame (ossa_source_read), or searches frames for a camera (find_camera) or for
     the upright rotation (ossa_tracker_find_upright). Returning 0 ends the wait: opening a device
     fails, reading times out, nothing is found. It may read a flag set by another thread. NULL: no
     early end. */
  int32_t (*keep_waiting)(void* keep_waiting_user);
  void* keep_waiting_user;
} ossa_source_options;

typedef struct ossa_source ossa_source;

/* Opens a SOURCE as `ossa track` does: "openni:" for the first device, a recording's file, a folder
   of depth images. options may be NULL. NULL on failure. */
ossa_source* ossa_source_open(const char* source, const ossa_source_options* options);
void ossa_source_close(ossa_source* source);
/* Reads the next frame into *image, waiting at most timeout_ms. Its depth_mm is valid until the
   next read of this source. A device that was unplugged times out until it is back. */
ossa_status ossa_source_read(ossa_source* source, int32_t timeout_ms, ossa_depth_image* image);

typedef enum {
  OSSA_NOTE_INFO = 0,   /* an assumption, or skipped data */
  OSSA_NOTE_WARNING = 1 /* lost data, an assumption that is probably wrong, or models that do
                              not belong together */
} ossa_note_kind;

/* The next message about a source that was not taken yet, from opening it and from all reads so
   far, as `ossa track` prints them to stderr: such as an assumed camera, and frames that cannot be
   read; NULL if there is none. Valid until the next call with this source. kind, an ossa_note_kind,
   may be NULL. */
const char* ossa_source_take_note(ossa_source* source, int32_t* kind);
/* The number of frames of a recording; -1 for a device, and a file that does not store it. */
int64_t ossa_source_frame_count(const ossa_source* source);
/* The number of frames lost so far between those that were read. */
int64_t ossa_source_dropped(const ossa_source* source);

/* Unmirrors an image with fx, fy, cx, cy of the mirrored image: u = cx + fx x/z. Writes the
   reversed rows to depth_mm, width x height, which may be image->depth_mm; *image then refers to
   these, with the cx changed. Images of ossa_source_read are not mirrored, unless the source's are
   and ossa_source_options.mirrored is not set. */
ossa_status ossa_unmirror(ossa_depth_image* image, uint16_t* depth_mm);

/* ---- conversion of pixels and camera space, as the Kinect SDK's CoordinateMapper ---- */

/* Projects a point of camera space to a pixel, u to the right and v down, by the image's camera;
   depth_mm is not read and may be NULL. Pixel centres are whole numbers; the pixel may be outside
   the image. Fails for a point that is not in front of the camera. */
ossa_status ossa_project(const ossa_depth_image* image, const float point_m[3], float pixel_uv[2]);
/* Back-projects a pixel at a depth along the camera's axis, above 0, to a point, metres. */
ossa_status ossa_back_project(const ossa_depth_image* image, const float pixel_uv[2],
                              float depth_mm, float point_m[3]);
/* Back-projects all pixels: width x height x 3 floats, row by row; 0 0 0 without a reading. */
ossa_status ossa_points(const ossa_depth_image* image, float* points_m);

/* ---- the tracker ---- */

typedef struct {
  uint32_t struct_size;
  int32_t physics;       /* not 0: a physical character follows the posture */
  int32_t seated;        /* not 0: the ten upper joints */
  int32_t near_range;    /* not 0: people from 0.4 to 3 m */
  int32_t max_users;     /* 1 to 6; 0: 6 */
  int32_t threads;       /* for several people; 0: 1 */
  const char* method;    /* as `ossa track --method`; NULL: best */
  const char* smoothing; /* as `ossa track --smoothing`; NULL: the method's default */
  /* Files as in `ossa track`; NULL: the shipped ones; "none": without. */
  const char *model, *refinement, *learned, *prior, *database;
  /* The clockwise rotation of the images after which people stand upright: "0", "90", "180", "270",
     or "auto": searched while no person is tracked. Results are in the unrotated camera's space;
     NULL: 0. */
  const char* rotate;
  /* The mount of the camera, as `ossa track --mount`: auto, level or ceiling; NULL: auto. */
  const char* mount;
  /* Further files, likewise. surface: the body that is fitted to the depth image, see ossa_body and
     ossa_skin; "none": no fit, which is faster. mesh: its skin. */
  const char *pose_network, *surface, *mesh;
  /* A scene file: all people in one mechanical world with its objects (docs/scene.md), in place of
     `physics`; NULL: no scene. */
  const char* scene;
  /* Files of ossa_tracker_save_person: the shapes of the people with id 1, 2 and so on; NULL:
     unknown. */
  const char* person[OSSA_MAX_BODIES];
  int32_t lag;   /* 0 to 2: delay of frames in images, for smoother joints */
  int32_t parts; /* not 0: ossa_frame.parts is filled; an eighth of a frame's time */
} ossa_options;

/* One joint of a skeleton. This struct does not grow. */
typedef struct {
  float position_m[3];
  float orientation_wxyz[4]; /* camera from bone: the y axis points from the parent to this joint */
  float confidence;          /* of the observation, [0, 1] */
  float reliability;         /* plausibility of movement and bone lengths, [0, 1] */
  int32_t state;             /* ossa_joint_state */
} ossa_joint;

typedef struct {
  uint32_t struct_size;
  int32_t id;                          /* from 1; constant while the person is tracked */
  int32_t state;                       /* ossa_body_state; of position only, joints, stages,
                                          bones, fit and stature are 0 */
  float position_m[3];                 /* centroid of the visible surface */
  uint32_t clipped_edges;              /* by the image: 1 right, 2 left, 4 top, 8 bottom */
  ossa_joint joints[OSSA_JOINT_COUNT]; /* the skeleton, by ossa_joint_id */
  /* Rotation of each bone relative to its parent, the Kinect SDK's hierarchical orientations. */
  float hierarchical_wxyz[OSSA_JOINT_COUNT][4];
  /* The joints after earlier stages: the forest; the refinement at the depth image, equal to the
     former without one; the method. */
  float raw_m[OSSA_JOINT_COUNT][3];
  float refined_m[OSSA_JOINT_COUNT][3];
  float reconstructed_m[OSSA_JOINT_COUNT][3];
  float person_score; /* probability of being a person, [0, 1] */
  /* Lengths, over all frames so far, of the bones that end in the joints, [OSSA_HIP_CENTER] 0; for
     methods that keep bone lengths. */
  int32_t has_bones;
  float bones_m[OSSA_JOINT_COUNT];
  /* The body surface fitted to the depth image of this frame; see ossa_tracker_skin. */
  int32_t has_fit;
  float fitted_m[OSSA_JOINT_COUNT][3];
  float explained; /* share of the person's pixels within 3 cm of the surface */
  float fit_score; /* explained, less the share of the surface that the camera sees through */
  /* The barefoot stature over all frames so far, and its standard deviation. */
  int32_t has_stature;
  float stature_m, stature_sigma_m;
} ossa_body;

typedef struct {
  uint32_t struct_size;
  int32_t body_count; /* at most OSSA_MAX_BODIES; see ossa_tracker_body */
  double time_s;      /* the image's */
  int32_t has_floor;
  float floor[4];        /* a b c d of ax + by + cz + d = 0, unit normal up */
  float tilt_down_rad;   /* of the sensor, from the floor */
  const uint8_t* users;  /* width x height, the id of the body each pixel belongs to, 0 none; valid
                            until the tracker's next frame or reset */
  int64_t index;         /* the image's, from 0 since the tracker was created or reset */
  const uint8_t* parts;  /* likewise the body part of each pixel, see ossa_part_name; NULL without
                            ossa_options.parts */
  int32_t width, height; /* of users and parts */
  int32_t object_count;  /* objects of ossa_options.scene; see ossa_tracker_object */
  int32_t under_ceiling; /* not 0: the camera is under the ceiling, as detected so far */
} ossa_frame;

/* The skin of a body as triangles: camera space, metres; valid until the next ossa_tracker_skin,
   frame or reset of that tracker. */
typedef struct {
  uint32_t struct_size;
  int32_t vertex_count;      /* 0: the person was not fitted in this frame */
  const float* vertices_m;   /* vertex_count x 3 */
  const uint32_t* triangles; /* triangle_count x 3 vertex indices, counter-clockwise from
                                outside; the same in every frame */
  int32_t triangle_count;
  int32_t body_id;
} ossa_skin;

/* An object of a scene. */
typedef struct {
  uint32_t struct_size;
  int32_t held_by_count;
  const char* name; /* as in the scene file; valid until the tracker's next frame or reset */
  float position_m[3];
  float orientation_wxyz[4]; /* camera from the object's own axes */
  float velocity_m_s[3];
  int32_t held_by[OSSA_MAX_BODIES]; /* ids of bodies, ascending */
} ossa_object;

/* NUI_TRANSFORM_SMOOTH_PARAMETERS of the Kinect SDK. */
typedef struct {
  uint32_t struct_size;
  float smoothing;                               /* [0, 1) */
  float correction;                              /* [0, 1] */
  float prediction;                              /* frames, [0, 100) */
  float jitter_radius_m, max_deviation_radius_m; /* above 0 */
} ossa_smooth_parameters;

typedef struct ossa_tracker ossa_tracker;

/* Loads its files. options may be NULL. NULL on failure, also for a file that the method does not
   read. */
ossa_tracker* ossa_tracker_create(const ossa_options* options);
void ossa_tracker_destroy(ossa_tracker* tracker);

/* Tracks one depth image; images come in order of time. Fails for an invalid camera: focal lengths
   of 0, NaN and the like. With ossa_options.lag the frame is that of an earlier image, see
   ossa_frame.index, and the first images return OSSA_HELD, with an empty *frame. */
ossa_status ossa_tracker_track(ossa_tracker* tracker, const ossa_depth_image* image,
                               ossa_frame* frame);
/* With ossa_options.lag, after the last image: the next held frame; OSSA_END when all were
   returned. */
ossa_status ossa_tracker_drain_lag(ossa_tracker* tracker, ossa_frame* frame);
/* With rotate "auto", before tracking a recording: reads up to 20 s of it to find the rotation, so
   that its first frames are tracked upright, too. Open the source again to track it. */
ossa_status ossa_tracker_find_upright(ossa_tracker* tracker, ossa_source* source);
/* A body of the last frame, by its index from 0 to body_count - 1. */
ossa_status ossa_tracker_body(const ossa_tracker* tracker, int32_t place, ossa_body* body);
/* Its skin. Fails if there is none: no surface, or a custom one without its mesh. */
ossa_status ossa_tracker_skin(ossa_tracker* tracker, int32_t place, ossa_skin* skin);
/* Saves its shape to a file for ossa_options.person. Fails if the shape is unknown. */
ossa_status ossa_tracker_save_person(const ossa_tracker* tracker, int32_t place, const char* path);
/* An object of the last frame, by its index from 0 to object_count - 1. */
ossa_status ossa_tracker_object(const ossa_tracker* tracker, int32_t place, ossa_object* object);
/* The next message, as ossa_source_take_note: about the models' files, such as a refinement trained
   on another forest's joints, or about the times of the first images, which cannot be seconds.
   Valid until the next call. */
const char* ossa_tracker_take_note(ossa_tracker* tracker, int32_t* kind);
/* The current clockwise rotation of the images, degrees. */
int32_t ossa_tracker_rotation(const ossa_tracker* tracker);
/* Resets all state: another recording begins. */
ossa_status ossa_tracker_reset(ossa_tracker* tracker);

/* Tracks only these people fully, the others by position; count < 0: all. */
ossa_status ossa_tracker_choose_users(ossa_tracker* tracker, const int32_t* ids, int32_t count);
/* From the next frame on. 0: standing, all 20 joints; else seated, the upper ten. */
ossa_status ossa_tracker_set_seated(ossa_tracker* tracker, int32_t seated);
/* From the next frame on: a preset by name, as `ossa track --smoothing`. */
ossa_status ossa_tracker_set_smoothing(ossa_tracker* tracker, const char* preset);
/* From the next frame on: the SDK's filter with these parameters. Fails outside their ranges and
   leaves the smoothing unchanged. */
ossa_status ossa_tracker_set_smooth_parameters(ossa_tracker* tracker,
                                               const ossa_smooth_parameters* parameters);

/* ---- skeleton files ---- */

typedef struct {
  uint32_t struct_size;
  const char* posture; /* final, reconstructed, fitted, refined or raw, as `ossa track --posture`;
                          NULL: final */
  const char* names; /* of a .bvh or .glb, as `ossa track --bvh-names`; NULL: sdk, for a .glb vrm */
  const char *surface, *mesh; /* of a .glb: the skin, as in ossa_options; mesh "none": bones
                                 only */
} ossa_writer_options;

typedef struct ossa_writer ossa_writer;

/* Opens a skeleton file for writing, in the format of its extension: .jsonl, .csv, .trc, .bvh or
   .glb, as `ossa track --out`. options may be NULL. NULL on failure. */
ossa_writer* ossa_writer_open(const char* path, const ossa_writer_options* options);
/* Adds the tracker's last frame. Fails for a frame that is earlier than the one before, which is
   left out, and on a full disk; ossa_writer_finish keeps the complete frames. */
ossa_status ossa_writer_write(ossa_writer* writer, const ossa_tracker* tracker);
/* Completes the file under its name. Nothing can be written afterwards. */
ossa_status ossa_writer_finish(ossa_writer* writer);
/* Without ossa_writer_finish before, leaves no file. */
void ossa_writer_close(ossa_writer* writer);

#ifdef __cplusplus
}
#endif
#endif
