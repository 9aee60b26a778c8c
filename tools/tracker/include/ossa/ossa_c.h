#ifndef OSSA_OSSA_C_H
#define OSSA_OSSA_C_H
/* ossa for other languages: the tracker in plain C, no exceptions, no global state.

   Depth images in, skeletons out. Positions are in camera space, metres: origin at the sensor, x to
   the sensor's left, y up, z forward. Left and right of a body are the person's own. Quaternions
   are w x y z.

   Calls that can fail return an ossa_status; ossa_last_error says in one line why the calling
   thread's last failed call failed. A tracker or a source is used from one thread at a time.

   Structs grow at their ends from version to version. Whoever hands one over first sets its
   struct_size to sizeof of it: `ossa_frame frame = {.struct_size = sizeof frame};`. Members that a
   program was compiled without are left alone, and members that this library does not know must be
   zero. A struct_size that no version had is refused.

   Not here, but in C++ (ossa/ossa.h), Python and the command: skeleton files that are read, made
   complete and compared, several cameras fused into one (recordings only), what is learned of a
   sensor, and the forest's probabilities and proposals. In C++ alone: the mechanical world itself
   and what happened in it. In the command alone: skeletons sent live to other programs. */
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum {
  OSSA_OK = 0,
  OSSA_FAILED = 1,  /* see ossa_last_error */
  OSSA_END = 2,     /* of ossa_source_read: the recording's last frame has been read; of
                       ossa_tracker_drain_lag: all frames are out */
  OSSA_TIMEOUT = 3, /* of ossa_source_read: no frame came in time; read again */
  OSSA_HELD = 4 /* of ossa_tracker_track with a lag: no frame is out yet; track the next image */
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

/* "0.1.0": of the library that runs, not of this header. */
const char* ossa_version(void);
/* Why the calling thread's last failed call failed; "" before the first. Valid until the next. */
const char* ossa_last_error(void);
/* "HipCenter" and so on, as skeleton files name joints; NULL for what is no joint. */
const char* ossa_joint_name(int32_t joint);
/* The joint at the other end of the bone that ends in this one; -1 for OSSA_HIP_CENTER. */
int32_t ossa_joint_parent(int32_t joint);
/* What a label of ossa_frame.parts stands for, "LU arm": L and R are the person's left and right, U
   and W upper and lower; 0 "background", 32 "other" is held or before the person. NULL for what is
   no label. */
const char* ossa_part_name(int32_t label);

/* ---- depth images and where they come from ---- */

typedef struct {
  uint32_t struct_size;
  int32_t width, height;    /* pixels */
  double fx, fy, cx, cy;    /* pixels: u = cx - fx x/z, v = cy - fy y/z */
  const uint16_t* depth_mm; /* width x height, row by row, millimetres, 0 = no reading; not
                               mirrored (ossa_unmirror), as those of Kinect SDKs, OpenNI2 and
                               libfreenect2 are by default: people's left would be their right */
  double time_s;            /* when it was taken; any origin */
} ossa_depth_image;

typedef struct {
  uint32_t struct_size;
  const char* camera; /* a preset's name, "fx,fy,cx,cy" or a file, as `ossa track --camera`; NULL:
                         what the source says, else by the images' size */
  double depth_scale; /* units to the metre of its depths; 0: what it says, else millimetres */
  double fps;         /* frames a second of a recording; 0: its own times */
  double wait_s;      /* for a device to be plugged in; 0: it must be there */
  const char* depth_format; /* what its numbers are, as `ossa track --depth-format`; NULL: plain */
  int32_t find_camera;      /* not 0: of images that state no camera, nor `camera` does, looks at
                               some for whether one of a narrower view took them, as `ossa track`
                               does: takes seconds; a note says what was found */
  int32_t mirrored;         /* not 0: its images are as a mirror shows them, and its own camera, or
                               `camera`'s numbers, is of these; both come as the sensor looks */
  /* Asked about ten times a second, in the thread that waits, while a call waits for a device
     (wait_s) or a frame (ossa_source_read), or looks through frames for a camera (find_camera) or
     for which way is up (ossa_tracker_find_upright). 0 ends that: opening a device fails, reading
     times out, nothing is found. What it looks at another thread may set. NULL: none ends early. */
  int32_t (*keep_waiting)(void* keep_waiting_user);
  void* keep_waiting_user;
} ossa_source_options;

typedef struct ossa_source ossa_source;

/* Opens a SOURCE as `ossa track` does: "openni:" for the first device, a recording's file, a folder
   of 16-bit PNGs. options may be NULL. NULL on failure. */
ossa_source* ossa_source_open(const char* source, const ossa_source_options* options);
void ossa_source_close(ossa_source* source);
/* The next frame into *image, waiting at most timeout_ms. Its depth_mm is valid until the next read
   of this source. A device that was unplugged times out until it is back. */
ossa_status ossa_source_read(ossa_source* source, int32_t timeout_ms, ossa_depth_image* image);

typedef enum {
  OSSA_NOTE_INFO = 0,   /* what was assumed or passed over */
  OSSA_NOTE_WARNING = 1 /* what was lost, or does not belong together */
} ossa_note_kind;

/* What `ossa track` says of a source on its error output: the next line that nobody has taken yet,
   from opening it and from all reads until now; NULL when there is none. So a camera that is not
   stated is told of, and frames that cannot be read. Valid until the next call with this source.
   kind, an ossa_note_kind, may be NULL. */
const char* ossa_source_take_note(ossa_source* source, int32_t* kind);
/* Frames of a recording; -1 of a device, and of a file that does not know. */
int64_t ossa_source_frame_count(const ossa_source* source);
/* Frames that were lost until now, between those that were read. */
int64_t ossa_source_dropped(const ossa_source* source);

/* Turns back an image that is mirrored, with fx, fy, cx, cy as of that image: u = cx + fx x/z. Its
   rows reversed go to depth_mm, width x height, which may be where they are; *image is then of
   those, its cx with them. What ossa_source_read delivers is as the sensor looks already, unless
   the source's images are mirrored and ossa_source_options.mirrored does not say so. */
ossa_status ossa_unmirror(ossa_depth_image* image, uint16_t* depth_mm);

/* ---- between pixels and camera space, the Kinect SDK's CoordinateMapper ---- */

/* The pixel, u to the right and v down, that shows a point of camera space: of the image's camera,
   whose depths are not read and may be NULL. Pixel centres are whole numbers; the pixel may lie
   beside the image. Fails for a point that is not before the camera. */
ossa_status ossa_project(const ossa_depth_image* image, const float point_m[3], float pixel_uv[2]);
/* The point, metres, that a pixel shows at a depth along the camera's axis, above 0. */
ossa_status ossa_back_project(const ossa_depth_image* image, const float pixel_uv[2],
                              float depth_mm, float point_m[3]);
/* The points of all pixels: width x height x 3 floats, row by row; 0 0 0 where there is no
   reading. */
ossa_status ossa_points(const ossa_depth_image* image, float* points_m);

/* ---- the tracker ---- */

typedef struct {
  uint32_t struct_size;
  int32_t physics;       /* not 0: a mechanical character follows the posture */
  int32_t seated;        /* not 0: the ten upper joints */
  int32_t near_range;    /* not 0: people from 0.4 to 3 m */
  int32_t max_users;     /* 1 to 6; 0: 6 */
  int32_t threads;       /* for several people; 0: 1 */
  const char* method;    /* as `ossa track --method`; NULL: best */
  const char* smoothing; /* as `ossa track --smoothing`; NULL: what goes with the method */
  /* Files as of `ossa track`; NULL: those that ossa ships; "none": do without. */
  const char *model, *refinement, *learned, *prior, *database;
  /* How far images must be turned clockwise for people to stand in them: "0", "90", "180", "270",
     or "auto": found while nobody is followed. Results stay in the unturned camera's space; NULL:
     0. */
  const char* rotate;
  /* Where the camera is, as `ossa track --mount`: auto, level or ceiling; NULL: auto. */
  const char* mount;
  /* Further files, by the same rules. surface: the body that is fitted to the depth image, for what
     ossa_body and ossa_skin say of it; "none": no fit, which is faster. mesh: its skin. */
  const char *pose_network, *surface, *mesh;
  /* A scene file: all people in one mechanical world with its things (docs/scene.md), in place of
     `physics`; NULL: no scene. */
  const char* scene;
  /* Files of ossa_tracker_save_person: the shapes of whoever gets id 1, 2 and so on; NULL: not
     known. */
  const char* person[OSSA_MAX_BODIES];
  int32_t lag;   /* 0 to 2: frames come so many images later, and steadier */
  int32_t parts; /* not 0: ossa_frame.parts is filled; an eighth of a frame's time */
} ossa_options;

/* One joint of a skeleton. This struct does not grow. */
typedef struct {
  float position_m[3];
  float orientation_wxyz[4]; /* camera from bone: the y axis of the bone that ends here runs along
                                it from the parent */
  float confidence;          /* what was seen there, [0, 1] */
  float reliability;         /* does it move and measure as a joint? [0, 1] */
  int32_t state;             /* ossa_joint_state */
} ossa_joint;

typedef struct {
  uint32_t struct_size;
  int32_t id;                          /* the same from frame to frame, from 1 */
  int32_t state;                       /* ossa_body_state; of position only, all below is 0 */
  float position_m[3];                 /* middle of the seen surface */
  uint32_t clipped_edges;              /* by the image: 1 right, 2 left, 4 top, 8 bottom */
  ossa_joint joints[OSSA_JOINT_COUNT]; /* the skeleton, by ossa_joint_id */
  /* Each bone's turn against its parent's, as the Kinect SDK's hierarchical orientations. */
  float hierarchical_wxyz[OSSA_JOINT_COUNT][4];
  /* What each stage before made of the joints: the forest; the refinement at the depth image, the
     same again where there was none; the method. */
  float raw_m[OSSA_JOINT_COUNT][3];
  float refined_m[OSSA_JOINT_COUNT][3];
  float reconstructed_m[OSSA_JOINT_COUNT][3];
  float person_score; /* how surely this is a person, [0, 1] */
  /* Lengths by all frames until now of the bones that end in the joints, [OSSA_HIP_CENTER] 0; of
     methods that keep bones. */
  int32_t has_bones;
  float bones_m[OSSA_JOINT_COUNT];
  /* The body whose surface explains the depth, in this frame; see ossa_tracker_skin. */
  int32_t has_fit;
  float fitted_m[OSSA_JOINT_COUNT][3];
  float explained; /* share of the person's pixels within 3 cm of the surface */
  float
      fit_score; /* that, less the share of the surface through which the camera sees; 1: perfect */
  /* How tall the person is, barefoot, by all frames until now, and its standard deviation. */
  int32_t has_stature;
  float stature_m, stature_sigma_m;
} ossa_body;

typedef struct {
  uint32_t struct_size;
  int32_t body_count; /* at most OSSA_MAX_BODIES; see ossa_tracker_body */
  double time_s;      /* the image's */
  int32_t has_floor;
  float floor[4];       /* a b c d of ax + by + cz + d = 0, unit normal up */
  float tilt_down_rad;  /* of the sensor, from the floor */
  const uint8_t* users; /* width x height, the id of the body each pixel belongs to, 0 nobody; valid
                           until the tracker's next frame or reset */
  int64_t index;        /* the image's, from 0 since the tracker was created or reset */
  const uint8_t* parts; /* likewise the body part that each pixel shows, see ossa_part_name; NULL
                           unless asked for */
  int32_t width, height; /* of users and parts */
  int32_t object_count;  /* things of ossa_options.scene; see ossa_tracker_object */
  int32_t under_ceiling; /* not 0: the camera hangs there and looks down, as far as is known now */
} ossa_frame;

/* The skin of a body as triangles: camera space, metres; valid until the next ossa_tracker_skin,
   frame or reset of that tracker. */
typedef struct {
  uint32_t struct_size;
  int32_t vertex_count;      /* 0: the person was not fitted in this frame */
  const float* vertices_m;   /* vertex_count x 3 */
  const uint32_t* triangles; /* triangle_count x 3 vertices' numbers, counter-clockwise from
                                outside; the same in every frame */
  int32_t triangle_count;
  int32_t body_id;
} ossa_skin;

/* A thing of a scene. */
typedef struct {
  uint32_t struct_size;
  int32_t held_by_count;
  const char* name; /* as the scene file has it; valid until the tracker's next frame or reset */
  float position_m[3];
  float orientation_wxyz[4]; /* camera from the thing's own axes */
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

/* One depth image in, its people out; images in order of time. Fails for a camera that cannot be:
   focal lengths of 0, NaN and the like. With ossa_options.lag the frame is that of an image so many
   before, see ossa_frame.index, and of the first images OSSA_HELD, with nobody in *frame. */
ossa_status ossa_tracker_track(ossa_tracker* tracker, const ossa_depth_image* image,
                               ossa_frame* frame);
/* With ossa_options.lag, after the last image: the next frame that is still held; OSSA_END when all
   are out. */
ossa_status ossa_tracker_drain_lag(ossa_tracker* tracker, ossa_frame* frame);
/* With rotate "auto", before a recording: reads up to 20 s of it for which way up its camera is,
   so that its first frames are tracked the right way, too. Open the source anew to track it. */
ossa_status ossa_tracker_find_upright(ossa_tracker* tracker, ossa_source* source);
/* A body of the last frame, by its place from 0 to body_count - 1. */
ossa_status ossa_tracker_body(const ossa_tracker* tracker, int32_t place, ossa_body* body);
/* Its skin. Fails where there is none to pose: no surface, or one of your own without its mesh. */
ossa_status ossa_tracker_skin(ossa_tracker* tracker, int32_t place, ossa_skin* skin);
/* What is known of its shape, into a file for ossa_options.person. Fails where nothing is. */
ossa_status ossa_tracker_save_person(const ossa_tracker* tracker, int32_t place, const char* path);
/* A thing of the last frame, by its place from 0 to object_count - 1. */
ossa_status ossa_tracker_object(const ossa_tracker* tracker, int32_t place, ossa_object* object);
/* What `ossa track` says of the models' files on its error output, as ossa_source_take_note: so a
   refinement is told of that was learned at another forest's joints. Valid until the next call. */
const char* ossa_tracker_take_note(ossa_tracker* tracker, int32_t* kind);
/* Degrees by which images are turned now, clockwise. */
int32_t ossa_tracker_rotation(const ossa_tracker* tracker);
/* Forgets everybody and everything seen: another recording begins. */
ossa_status ossa_tracker_reset(ossa_tracker* tracker);

/* Track only these fully, the others by position; count < 0: all. */
ossa_status ossa_tracker_choose_users(ossa_tracker* tracker, const int32_t* ids, int32_t count);
/* From the next frame on. 0: standing, all 20 joints; else seated, the upper ten. */
ossa_status ossa_tracker_set_seated(ossa_tracker* tracker, int32_t seated);
/* From the next frame on: a preset by name, as `ossa track --smoothing`. */
ossa_status ossa_tracker_set_smoothing(ossa_tracker* tracker, const char* preset);
/* From the next frame on: the SDK's filter with these parameters. Fails outside their ranges, and
   the smoothing stays as it was. */
ossa_status ossa_tracker_set_smooth_parameters(ossa_tracker* tracker,
                                               const ossa_smooth_parameters* parameters);

/* ---- skeleton files ---- */

typedef struct {
  uint32_t struct_size;
  const char* posture; /* final, reconstructed, fitted, refined or raw, as `ossa track --posture`;
                          NULL: final */
  const char* names; /* of a .bvh or .glb, as `ossa track --bvh-names`; NULL: sdk, of a .glb vrm */
  const char *surface, *mesh; /* of a .glb: the skin that people wear, as those of ossa_options;
                                 mesh "none": bones alone */
} ossa_writer_options;

typedef struct ossa_writer ossa_writer;

/* A file that tracked people are written to, in the format of its extension: .jsonl, .csv, .trc,
   .bvh or .glb, as `ossa track --out`. options may be NULL. NULL on failure. */
ossa_writer* ossa_writer_open(const char* path, const ossa_writer_options* options);
/* Adds the tracker's last frame. Fails when the disk is full: ossa_writer_finish keeps what fits.
 */
ossa_status ossa_writer_write(ossa_writer* writer, const ossa_tracker* tracker);
/* Makes the file appear under its name, whole. Nothing can be written after it. */
ossa_status ossa_writer_finish(ossa_writer* writer);
/* Without ossa_writer_finish before, nothing is left. */
void ossa_writer_close(ossa_writer* writer);

#ifdef __cplusplus
}
#endif
#endif
