/* What the files of emit share. */
#ifndef DVI_SCENE_EMIT_PARTS_H
#define DVI_SCENE_EMIT_PARTS_H
#include "scene/emit/emit.h"
#include "expr/function/function_parts.h"

/* A program's straight line: `r%d` are its numbers, from *next on, which moves. name [row_count +
 * input_count]: of registers, then of inputs, whose names must be there; the outputs' are there
 * afterwards. */
void dvi__emit_program(dvi__emitter *out, const dvi__program *program, const char *indent,
                       int *name, int *next);

/* 1 if the program takes inverse roots, so that it wants `careful` and `unusual`. */
int dvi__program_has_inverse_roots(const dvi__program *program);

/* A sum of a scene's function as a C function: array a of its results has a name. */
typedef struct dvi__emitted_sum {
  const dvi__function_sum *sum;
  const char *name;
  const char *const *array;
  int points; /* most that are taken at once: a power of two; 1: it is compiled for one instruction
                 set */
} dvi__emitted_sum;

/* An output of the sum's parts, counted over all of them, of an element, that is added to an entry
 * of a result, or subtracted. */
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
/* How many entries of an array there are contributions to. */
int dvi__entries_written(const dvi__contributions *all, int array);

/* Whether the unit of elements that starts at `first` adds them all to one entry. */
int dvi__is_one_entry(const dvi__entries *entries, int first);

/* A number for each of many: a list, or -1 and the one number of all. */
typedef struct dvi__numbers {
  int list, value;
} dvi__numbers;

/* What a part adds to an array: each time a row, with a sign, to entries start + step * e, or,
 * listed, start + the list `step` at e. */
typedef struct dvi__additions {
  int count, listed;
  dvi__numbers row, sign, start, step;
  enum { DVI__NEVER, DVI__SOMETIMES, DVI__ALWAYS } folds; /* in units that have one entry */
  int flags; /* if sometimes: the list that says in which */
} dvi__additions;

/* Write the tables, before a function; and in it the loop. */
dvi_status dvi__additions_declare(dvi__emitter *out, const dvi__part *part, int array,
                                  dvi__additions *all);
void dvi__additions_emit(dvi__emitter *out, const dvi__additions *all, const char *array,
                         int elements);

/* The name's parts: NAME_at(careful, n, ..), which returns 1 if it wants to be called again,
 * carefully. Of kernels with one element, or any. */
dvi_status dvi__emit_expressions(dvi__emitter *out, const dvi__emitted_sum *own);
dvi_status dvi__emit_elements(dvi__emitter *out, const dvi__emitted_sum *own);

/* The blocks' names. */
extern const char *const dvi__block_name[DVI__BLOCKS];

/* The function's last parameters, the blocks and the arrays; the same as arguments; mentioned, for
 * those that are not used; and statements that shift those which a part uses. */
void dvi__emit_parameters(dvi__emitter *out, const dvi__emitted_sum *own);
void dvi__emit_arguments(dvi__emitter *out, const dvi__emitted_sum *own);
void dvi__emit_mentions(dvi__emitter *out, const dvi__emitted_sum *own);
void dvi__emit_shifts(dvi__emitter *out, const dvi__emitted_sum *own, const dvi__part *part);
/* Zeros in an array. */
void dvi__emit_zeros(dvi__emitter *out, const dvi__emitted_sum *own, int array);

/* Names for a part's rows, to be freed: its variables and columns have *next and following. NULL:
 * no memory. */
int *dvi__name_rows(const dvi__part *part, int *next);

#endif
