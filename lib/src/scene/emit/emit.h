/* Functions as C. The programs of their kernels are written as loops that a compiler sees through,
 * in the order of the byte code's sums, so that digits are the same. The text is C11 with no word
 * in it but ours. */
#ifndef DVI_SCENE_EMIT_EMIT_H
#define DVI_SCENE_EMIT_EMIT_H
#include "scene/elaborate/blocks.h"

/* The destination of text. Fill in write and user. The rest starts at zero. After write returned
 * not 0, or memory ran out, nothing more is written. */
typedef struct dvi__emitter {
  int (*write)(const char *text, size_t size, void *user); /* as in dvi_scene_emit_c */
  void *user;
  dvi_status failed; /* DVI_IO_ERROR or DVI_NO_MEMORY */
  int array_count;   /* static arrays so far */
  struct dvi__emitted_array *array;
} dvi__emitter;

/* Write as printf does, at most 500 characters. Doubles that are read again need
 * dvi__emit_number. */
void dvi__emit(dvi__emitter *out, const char *format, ...) DVI__TEXT_PRINTF(2, 3);
void dvi__emit_number(dvi__emitter *out, double value);

/* Write an array of a file and return its number n. It is `static const int dvi_list_n[]` or
 * `static const double dvi_row_n[]`. An array that was written before (by its address) is not
 * written again. */
int dvi__emit_ints(dvi__emitter *out, int count, const int *value);
int dvi__emit_doubles(dvi__emitter *out, int count, const double *value);
/* Write, likewise, numbers that have no lasting address. `key` stands for it. With key NULL they
 * are always written. */
int dvi__emit_ints_of(dvi__emitter *out, const void *key, int count, const int *value);
/* Write `static const int *const dvi_lists_n[]`, which points to the lists of these numbers, and
 * return n. */
int dvi__emit_lists(dvi__emitter *out, int count, const int *list);

/* Write the headers and small functions that the functions below need, first in a file. */
void dvi__emit_begin(dvi__emitter *out);

/* Write a function of a scene as
 *
 *     static void NAME(int count, const double *t, const double *q, const double *v,
 *                      const double *w, double *f_.., ..)
 *
 * It does what dvi__function_value does, or dvi__function_gradient (an array for each block b with
 * blocks[b]), or dvi__function_second (an array for each pair with pairs[pair]). It does not look
 * for values that are not finite. Arrays are in the order of blocks and pairs in
 * scene/elaborate/blocks.h. Those that do not occur may be NULL. `name` is an identifier. `lanes`
 * is 1 if the function is for many points, and worth being compiled for several instruction sets.
 * With `lanes` 0 it may be called for many points, too. */
dvi_status dvi__emit_value(dvi__emitter *out, dvi__function *function, const char *name);
dvi_status dvi__emit_gradient(dvi__emitter *out, dvi__function *function, const char *blocks,
                              int lanes, const char *name);
dvi_status dvi__emit_second(dvi__emitter *out, dvi__function *function, const char *pairs,
                            int lanes, const char *name);

/* Free the memory of the emitter. Returns DVI_OK, or the first failure. */
dvi_status dvi__emit_end(dvi__emitter *out);

#endif
