/* What the files of emit share. */
#ifndef DVI_SCENE_EMIT_PARTS_H
#define DVI_SCENE_EMIT_PARTS_H
#include "scene/emit.h"
#include "scene/function_parts.h"

/* A program's straight line: `r%d` are its numbers, from *next on, which moves. name [row_count + input_count]: of registers, then of inputs, whose
 * names must be there; the outputs' are there afterwards. */
void dvi__emit_program(dvi__emitter *out, const dvi__program *program, const char *indent, int *name, int *next);

/* 1 if the program takes inverse roots, so that it wants `careful` and `unusual`. */
int dvi__program_has_inverse_roots(const dvi__program *program);

/* A sum as a function: result[a] has size[a] entries for the arrays in `mask`. */
typedef struct dvi__emitted_sum {
  const dvi__sum *sum;
  const char *name;
  const int *size;
  unsigned mask;
} dvi__emitted_sum;

/* An output of the sum's parts, counted over all of them, of an element, that is added to an entry of a result, or subtracted. */
typedef struct dvi__contribution {
  int array, entry, order, output, element, negative;
} dvi__contribution;

typedef struct dvi__contributions {
  int count, output_count;
  dvi__contribution *list; /* by array, entry and order */
} dvi__contributions;

/* All contributions of some parts; the list is to be freed. */
dvi_status dvi__contributions_find(int part_count, const dvi__part *part, dvi__contributions *all);
/* Whether contribution i is the first one to its entry. */
int dvi__contribution_is_first(const dvi__contributions *all, int i);

/* As dvi__emit_ints, for numbers that have no lasting address: `key` stands for it. */
int dvi__emit_ints_of(dvi__emitter *out, const void *key, int count, const int *value);

/* The name's parts: NAME_at(careful, count, x, result), which returns 1 if it wants to be called again, carefully. Of kernels with one element, or any. */
dvi_status dvi__emit_expressions(dvi__emitter *out, const dvi__emitted_sum *own);
dvi_status dvi__emit_elements(dvi__emitter *out, const dvi__emitted_sum *own);

/* Declare x0, .. for the blocks that parts first .. last-1 read, and y0, .. for the arrays that they add to, shifted by this. */
void dvi__emit_pointers(dvi__emitter *out, const dvi__emitted_sum *own, int first, int last, const char *shift);

/* Names for a part's rows, to be freed: its variables and columns have *next and following. NULL: no memory. */
int *dvi__name_rows(const dvi__part *part, int *next);

#endif
