/* Marches by any method, for tests. What fails is reported. */
#ifndef TESTS_SUPPORT_FIELD_MARCHES_H
#define TESTS_SUPPORT_FIELD_MARCHES_H
#include <dvi/march.h>

void advance_march(dvi_march *march, double t);
double observe_march(const dvi_march *march, const char *name);
double step_of_march(const dvi_march *march);

/* Give all values of a form, in an array of the caller's, or in one for free(). */
void copy_march(const dvi_march *march, dvi_march_form form, double *values);
double *sample_march(const dvi_march *march, dvi_march_form form);

/* Give the bytes of a march's state [size], for free(). Nothing is reported, and *size is 0 if it
 * is not saved. */
unsigned char *save_march(const dvi_march *march, size_t *size);

/* Return whether the state of a march, or a file, has these bytes. */
int march_has_bytes(const dvi_march *march, const unsigned char *bytes, size_t size);
int file_has_bytes(const char *path, const unsigned char *bytes, size_t size);

enum { STATE_TRIAL_MOST = 5 /* processes */ };

/* States that several processes save and load, and what came of it. */
typedef struct state_trial {
  char path[64];
  size_t size;
  unsigned char *saved, *later; /* [size] states of one process, the second at a later time */
  const unsigned char *tried;   /* [tried_size] bytes that are refused */
  size_t tried_size;
  dvi_status status[STATE_TRIAL_MOST];
  int same[STATE_TRIAL_MOST]; /* as what was expected */
} state_trial;

/* Remove the file, and free the states. */
void end_state_trial(state_trial *trial);

#endif
