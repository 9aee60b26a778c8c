#ifndef OSSA_C_H
#define OSSA_C_H
/* ossa::tracker for other languages: plain C, no exceptions, no global state. Camera space, metres:
   x to the sensor's left, y up, z forward. Every call that can fail returns 0 on success and 1 on
   failure; ossa_last_error then says why in one line (of the calling thread's last failure). */
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { OSSA_JOINTS = 20, OSSA_MOST_BODIES = 6 };

typedef enum { OSSA_NOT_TRACKED = 0, OSSA_INFERRED = 1, OSSA_TRACKED = 2 } ossa_joint_state;
typedef enum { OSSA_POSITION_ONLY = 0, OSSA_FULLY_TRACKED = 1 } ossa_body_state;

typedef struct {
  float raw_m[3], reconstructed_m[3], smoothed_m[3];
  float absolute_wxyz[4], hierarchical_wxyz[4]; /* orientation of the bone that ends here */
  float confidence, reliability;                /* [0, 1] */
  int32_t state;                                /* ossa_joint_state */
} ossa_joint;

typedef struct {
  int32_t id;
  int32_t state; /* ossa_body_state */
  float position_m[3];
  uint32_t clipped_edges;         /* 1 right, 2 left, 4 top, 8 bottom */
  ossa_joint joints[OSSA_JOINTS]; /* order of the Kinect SDK */
} ossa_body;

typedef struct {
  int32_t body_count;
  ossa_body bodies[OSSA_MOST_BODIES];
  int32_t has_floor;
  float floor[4]; /* a b c d of ax + by + cz + d = 0, unit normal up */
  float tilt_down_rad;
  const uint8_t* users; /* height x width, the body id of each pixel; valid until the next push */
} ossa_frame;

typedef struct {
  const char* model;     /* .ossa file; NULL: the shipped one */
  const char* database;  /* .ossadb file; NULL: the shipped one */
  const char* method;    /* as `ossa track --method`; NULL: best */
  const char* smoothing; /* as `ossa track --smoothing`; NULL: none with best, else default */
  int32_t physics, seated, near_range;
  int32_t max_users; /* 1 to 6; 0: 6 */
  int32_t threads;   /* 0: 1 */
} ossa_options;

typedef struct {
  int32_t width, height;
  double fx, fy, cx, cy; /* pixels */
} ossa_camera;

/* NUI_TRANSFORM_SMOOTH_PARAMETERS of the Kinect SDK. */
typedef struct {
  float smoothing;                               /* [0, 1) */
  float correction;                              /* [0, 1] */
  float prediction;                              /* frames, [0, 100) */
  float jitter_radius_m, max_deviation_radius_m; /* above 0 */
} ossa_smooth_parameters;

typedef struct ossa_tracker ossa_tracker;

/* options may be NULL. NULL on failure. */
ossa_tracker* ossa_tracker_create(const ossa_options* options);
void ossa_tracker_destroy(ossa_tracker* tracker);

/* One depth image, row-major, millimetres, 0 = no reading; fills *frame. Fails for a camera that
   cannot be: focal lengths of 0, NaN and the like. */
int ossa_tracker_push(ossa_tracker* tracker, const uint16_t* depth_mm, const ossa_camera* camera,
                      double time_s, ossa_frame* frame);

/* Track only these fully; count < 0: all. */
int ossa_tracker_choose_users(ossa_tracker* tracker, const int32_t* ids, int32_t count);

/* From the next push on. 0: standing, all 20 joints; else seated, the upper ten. */
int ossa_tracker_set_seated(ossa_tracker* tracker, int32_t seated);
/* From the next push on: a preset by name, as `ossa track --smoothing`. */
int ossa_tracker_set_smoothing(ossa_tracker* tracker, const char* preset);
/* From the next push on: the SDK's filter with these parameters. Fails outside their ranges, and
   the smoothing stays as it was. */
int ossa_tracker_set_smooth_parameters(ossa_tracker* tracker,
                                       const ossa_smooth_parameters* parameters);

const char* ossa_last_error(void);

#ifdef __cplusplus
}
#endif
#endif
