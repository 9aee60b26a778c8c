/* live_tracker.cpp in C: follows everybody in a SOURCE and prints where their heads are. */
#include <ossa/ossa_c.h>
#include <stdio.h>

/* What was assumed, passed over or lost: of a folder that states no camera, which was taken. */
static void say_notes(ossa_source* source) {
  const char* note = NULL;
  while ((note = ossa_source_take_note(source, NULL)) != NULL) fprintf(stderr, "%s\n", note);
}

int main(int argc, char** argv) {
  ossa_depth_image image = {.struct_size = sizeof image};
  ossa_frame frame = {.struct_size = sizeof frame};
  ossa_body body = {.struct_size = sizeof body};
  ossa_source* source = ossa_source_open(argc > 1 ? argv[1] : "openni:", NULL);
  ossa_tracker* tracker = source != NULL ? ossa_tracker_create(NULL) : NULL;
  ossa_status status = tracker != NULL ? OSSA_OK : OSSA_FAILED;
  while (status == OSSA_OK || status == OSSA_TIMEOUT) {
    status = ossa_source_read(source, 100, &image);
    say_notes(source);
    if (status != OSSA_OK) continue;
    status = ossa_tracker_track(tracker, &image, &frame);
    for (int i = 0; status == OSSA_OK && i < frame.body_count; ++i) {
      status = ossa_tracker_body(tracker, i, &body);
      const ossa_joint* head = &body.joints[OSSA_HEAD];
      printf("%.3f s: person %d has the head at %.2f %.2f %.2f m, %s\n", frame.time_s, body.id,
             head->position_m[0], head->position_m[1], head->position_m[2],
             head->state == OSSA_TRACKED ? "seen" : "guessed");
    }
  }
  if (status == OSSA_FAILED) fprintf(stderr, "live_tracker_c: %s\n", ossa_last_error());
  ossa_tracker_destroy(tracker);
  ossa_source_close(source);
  return status == OSSA_FAILED ? 1 : 0;
}
