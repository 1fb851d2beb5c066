/* Functions and types shared by the files of emit. */
#ifndef DVI_SCENE_EMIT_EMIT_PARTS_H
#define DVI_SCENE_EMIT_EMIT_PARTS_H
#include "scene/emit/emit.h"
#include "expr/function/function_parts.h"

/* Write a program's straight line. Its numbers are `r%d` from *next on, which advances. name
 * [row_count + input_count] are the names of registers, then of inputs. The caller sets those of
 * inputs, and finds those of outputs afterwards. */
void dvi__emit_program(dvi__emitter *out, const dvi__program *program, const char *indent,
                       int *name, int *next);

/* Return 1 if the program takes inverse roots, so that it needs `careful` and `unusual`. */
int dvi__program_has_inverse_roots(const dvi__program *program);

/* A sum of a scene's function as a C function. Array a of its results has a name. */
typedef struct dvi__emitted_sum {
  const dvi__function_sum *sum;
  const char *name;
  const char *const *array;
  int points; /* most points at once, a power of two, or 1 for one instruction set */
} dvi__emitted_sum;

/* An output that is added to an entry of a result, or subtracted, by one element. Outputs are
 * counted over all parts of the sum. */
typedef struct dvi__contribution {
  int array, entry, order, output, element, negative;
} dvi__contribution;

typedef struct dvi__contributions {
  int count, output_count;
  dvi__contribution *list; /* by array, entry and order */
} dvi__contributions;

/* Find all contributions of some parts. The caller frees the list. */
dvi_status dvi__contributions_find(int part_count, const dvi__part *part, dvi__contributions *all);
/* Return 1 if contribution i is the first one to its entry. */
int dvi__contribution_is_first(const dvi__contributions *all, int i);
/* Return how many entries of an array have contributions. */
int dvi__entries_written(const dvi__contributions *all, int array);

/* Return 1 if the unit of elements that starts at `first` adds them all to one entry. */
int dvi__is_one_entry(const dvi__entries *entries, int first);

/* A number for each of many. `list` is a table, or -1 with one number for all. */
typedef struct dvi__numbers {
  int list, value;
} dvi__numbers;

/* The additions of a part to an array. Each adds a row, with a sign, to entries start + step * e,
 * or, if listed, to start + the list `step` at e. */
typedef struct dvi__additions {
  int count, listed;
  dvi__numbers row, sign, start, step;
  enum { DVI__NEVER, DVI__SOMETIMES, DVI__ALWAYS } folds; /* folding in units that have one entry */
  int flags; /* the list of units that fold, for DVI__SOMETIMES */
} dvi__additions;

/* Write the tables, before a function. dvi__additions_emit writes the loop in it. */
dvi_status dvi__additions_declare(dvi__emitter *out, const dvi__part *part, int array,
                                  dvi__additions *all);
void dvi__additions_emit(dvi__emitter *out, const dvi__additions *all, const char *array,
                         int elements);

/* Write the parts of a function. NAME_at(careful, n, ..) returns 1 if it has to be called again,
 * carefully. dvi__emit_expressions takes kernels with one element, dvi__emit_elements any. */
dvi_status dvi__emit_expressions(dvi__emitter *out, const dvi__emitted_sum *own);
dvi_status dvi__emit_elements(dvi__emitter *out, const dvi__emitted_sum *own);

/* The names of the blocks. */
extern const char *const dvi__block_name[DVI__INPUTS];

/* Write the function's last parameters, the blocks and the arrays. The other functions write them
 * as arguments, mention unused ones, and write statements that shift those which a part uses. */
void dvi__emit_parameters(dvi__emitter *out, const dvi__emitted_sum *own);
void dvi__emit_arguments(dvi__emitter *out, const dvi__emitted_sum *own);
void dvi__emit_mentions(dvi__emitter *out, const dvi__emitted_sum *own);
void dvi__emit_shifts(dvi__emitter *out, const dvi__emitted_sum *own, const dvi__part *part);
/* Write zeros to an array. */
void dvi__emit_zeros(dvi__emitter *out, const dvi__emitted_sum *own, int array);

/* Name a part's rows. Its variables and columns get *next and following. The caller frees the
 * names. NULL if there is no memory. */
int *dvi__name_rows(const dvi__part *part, int *next);

#endif
