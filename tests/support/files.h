/* Files of a test in a folder of its own, and states of integrators as the bytes of checkpoints. */
#ifndef SUPPORT_FILES_H
#define SUPPORT_FILES_H
#include <dvi/dvi.h>

/* Make the folder, and remove it with all of its files, for tcase_add_checked_fixture. */
void make_folder(void);
void remove_folder(void);

/* Gives the path of a file in the folder. It is valid until the eighth next call. */
const char *path_in_folder(const char *name);

/* Counts the files in the folder. */
int count_files_in_folder(void);

typedef struct bytes {
  unsigned char *at; /* to be freed */
  size_t count;
} bytes;

bytes read_bytes(const char *path);
void write_bytes(const char *path, const unsigned char *at, size_t count);

/* Reads everything that the next step depends on, and the number of steps so far. */
bytes read_state(const dvi_integrator *integrator);

/* Require that two integrators are in the same state bit for bit, or that an integrator is in the
 * expected state, which is freed. */
void check_same_state(const dvi_integrator *a, const dvi_integrator *b);
void check_state(const dvi_integrator *integrator, bytes expected);

#endif
