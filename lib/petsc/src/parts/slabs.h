/* Datasets of HDF5 that processes read and write in parts. The world of a process alone is NULL,
 * and MPI need not be started. */
#ifndef DVI_PETSC_SLABS_H
#define DVI_PETSC_SLABS_H
#include <dvi/status.h>
#include <stddef.h>
#include <stdint.h>

#include "world.h"

typedef struct dvi__slabs dvi__slabs;

/* What numbers are, in memory and in the file. */
typedef enum dvi__number_type { DVI__INT8, DVI__INT32, DVI__INT64, DVI__DOUBLE } dvi__number_type;

/* Some rows of a dataset, which has one axis, or two if `width` is not 0. */
typedef struct dvi__slab {
  const char *name;
  dvi__number_type type;
  int64_t first, rows;
  int width;
} dvi__slab;

/* Open a file on all processes of a world. DVI_IO_ERROR, DVI_BAD_FILE if it is none of HDF5. */
dvi_status dvi__slabs_open(const dvi__world *world, const char *path, dvi__slabs **file);

/* Make a file with a name of its own beside `path`, on all processes. With `keep` the end gives it
 * the name `path`, and otherwise it is removed. */
dvi_status dvi__slabs_create(const dvi__world *world, const char *path, dvi__slabs **file);
dvi_status dvi__slabs_end(dvi__slabs **file, int keep);

/* Tell whether the file has a dataset or a group. A/B is looked for if there is an A. */
int dvi__slabs_have(const dvi__slabs *file, const char *name);

/* Give the number of members of a group. DVI_BAD_FILE if it is not there. */
dvi_status dvi__slabs_members(const dvi__slabs *file, const char *name, int *members);

/* Give the number of rows of a dataset, and their width, 0 if it has one axis. DVI_BAD_FILE if it
 * has more, or is not there. */
dvi_status dvi__slabs_shape(const dvi__slabs *file, const char *name, int64_t *rows, int *width);

/* Read rows. DVI_BAD_FILE if the file has other ones. */
dvi_status dvi__slabs_read(const dvi__slabs *file, const dvi__slab *slab, void *numbers);

/* Read a text that has fewer than `size` bytes. */
dvi_status dvi__slabs_read_text(const dvi__slabs *file, const char *name, size_t size, char *text);

/* Write a dataset of `total` rows, of which each process gives its own, maybe none. Or write a
 * text, a group or, in a process alone, a whole dataset with checksums. All processes make these
 * calls, and agree on failures afterwards. */
dvi_status dvi__slabs_write_rows(const dvi__slabs *file, const dvi__slab *slab, int64_t total,
                                 const void *numbers);
dvi_status dvi__slabs_write(const dvi__slabs *file, const dvi__slab *slab, const void *numbers);
dvi_status dvi__slabs_write_text(const dvi__slabs *file, const char *name, const char *text);
dvi_status dvi__slabs_write_group(const dvi__slabs *file, const char *name);

/* Fail because of what the file has: "PATH: SENTENCE". */
dvi_status dvi__slabs_refuse(const dvi__slabs *file, const char *sentence, ...)
    __attribute__((format(printf, 2, 3)));

#endif
