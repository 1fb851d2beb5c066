/* Files of a test, in a folder of its own, and the state of an integrator as the bytes of its
 * checkpoint. */
#ifndef SUPPORT_FILES_H
#define SUPPORT_FILES_H
#include <dvi/dvi.h>

/* For tcase_add_checked_fixture: make the folder; remove it with all that is in it. */
void make_folder(void);
void remove_folder(void);

/* Path of a file in the folder; valid until the eighth next call. */
const char *in_folder(const char *name);

/* How many files are in the folder. */
int files_in_folder(void);

typedef struct bytes {
  unsigned char *at; /* to be freed */
  size_t count;
} bytes;

bytes read_bytes(const char *path);
void write_bytes(const char *path, const unsigned char *at, size_t count);

/* All that the next step depends on, and the number of steps so far. */
bytes state_of(const dvi_integrator *integrator);

/* The test fails unless both integrators are in the same state bit for bit, or the integrator is in
 * that state; frees `expected`. */
void check_same_state(const dvi_integrator *a, const dvi_integrator *b);
void check_state(const dvi_integrator *integrator, bytes expected);

#endif
