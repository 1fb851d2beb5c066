/* States of marches whose arrays no process holds as a whole. What puts them into a file is another
 * library (lib/petsc). */
#ifndef DVI_MARCH_PARTS_H
#define DVI_MARCH_PARTS_H
#include <dvi/march.h>
#include <stddef.h>

/* Rows of an array of doubles that a process lists. */
typedef struct dvi__part_rows {
  int array; /* its number in the state */
  int64_t total, listed;
  const int64_t *number; /* [listed] ascending numbers of the rows. NULL for all rows */
  const int *owner;      /* [listed] the processes that put them. NULL for this one */
} dvi__part_rows;

/* Functions that all processes call in the same order. If one process fails, all do. */
typedef struct dvi__parts {
  /* Put the own rows among values [listed], every bit as it is. */
  dvi_status (*put)(void *of, const dvi__part_rows *rows, const double *value);
  /* Take all listed rows. */
  dvi_status (*take)(void *of, const dvi__part_rows *rows, double *value);
  void *of;
} dvi__parts;

/* Put the arrays of a state, and give all else as bytes for dvi__release, the same on all
 * processes. They are NULL after a failure. DVI_UNSUPPORTED for marches without such arrays. */
dvi_status dvi__march_put_parts(const dvi_march *march, const dvi__parts *parts,
                                unsigned char **bytes, size_t *size);

/* Take a state of these bytes, which are released in any case, with its arrays. `name` is for
 * sentences, and `status` whether the bytes could be had here. A failure changes nothing. */
dvi_status dvi__march_take_parts(dvi_march *march, const char *name, const dvi__parts *parts,
                                 unsigned char *bytes, size_t size, dvi_status status);

#endif
