/* The context in which an expression is elaborated. It holds a graph, the sources of its inputs,
 * and the indices that are bound.
 *
 * A context has one element, or those of a sum. An index is a number for every element. An
 * expression without coordinates is one number for every element, too. It becomes a constant if
 * they are all the same, else a row of data. */
#ifndef DVI_SCENE_ELABORATE_CONTEXT_H
#define DVI_SCENE_ELABORATE_CONTEXT_H
#include "expr/function/function.h"
#include "scene/elaborate/model.h"

enum { DVI__INDICES_MAX = 64 };

/* The nodes of a value, row by row. A number has its node in `one`. */
typedef struct dvi__value {
  dvi__shape shape;
  dvi__node one;
  dvi__node *node;
} dvi__value;

typedef struct dvi__index {
  const char *name;
  const int *each; /* [elements], or NULL for `all` in every element */
  int all;
  const double *row; /* `each` as data, once needed */
} dvi__index;

/* Numbers of variables for every element, number[e] or base + stride * e. */
typedef struct dvi__numbering {
  const int *number;
  int base, stride;
} dvi__numbering;

typedef struct dvi__context {
  dvi_scene *scene;
  dvi__graph *graph;
  unsigned may;      /* flags DVI__MENTIONS_.. that may be mentioned */
  const char *where; /* "a potential", for messages */
  int elements;
  dvi__index index[DVI__INDICES_MAX];
  int index_count;
  int index_first; /* those before it are around the use of a definition, which does not see them */
  dvi__kernel_input *input;
  int input_count;
  dvi__numbering *numbering;
  int numbering_count;
  int *of_number[DVI__BLOCKS]; /* input + 1 of a variable that is the same for all elements */
  dvi__value *definition;      /* [definition_count] values, of rank -1 before elaboration */
  int depth;
  dvi__span whole; /* span of the expression at depth 1 */
  int sample;      /* 1 if sums take only their first and last index, to learn shapes */
  int uneven;      /* 1 if the elements must be elaborated one by one, since they differ */
} dvi__context;

/* Make a context of one element without indices. Free it by dvi__context_free. */
bool dvi__context_make(dvi__context *c, dvi_scene *scene, unsigned may, const char *where);
void dvi__context_free(dvi__context *c);

/* Note that a parameter occurs in the expression that is read now. */
bool dvi__note_parameter(dvi_scene *scene, dvi__parameter *parameter);

/* Elaborate an expression. The result has rank -1 if it makes no sense, with a complaint, or if
 * c->uneven was set. */
dvi__value dvi__elaborate(dvi__context *c, const dvi__expression *e);
/* Elaborate an expression that must be a number. */
bool dvi__elaborate_number(dvi__context *c, const dvi__expression *e, dvi__node *node);

/* Compute a number without coordinates for every element. Sets *each [elements], freed by the
 * caller, or *each = NULL and *all if all are the same. */
bool dvi__numbers_of(const dvi__context *c, const dvi__expression *e, double **each, double *all);
/* Compute, likewise, the numbers of a node without variables. */
bool dvi__node_numbers(dvi__context *c, const dvi__expression *e, dvi__node node, double **each,
                       double *all);
/* Compute, likewise, whole numbers. `what` is for messages. */
bool dvi__whole_numbers_of(const dvi__context *c, const dvi__expression *e, const char *what,
                           int **each, int *all);

/* Compute the numbers [rows * columns] of a value without variables. Complains if one is not
 * finite. */
bool dvi__constants_of(dvi__context *c, const dvi__expression *e, dvi__value value, double *number);

/* Return a variable of a block as a node, by number numbering + offset. */
dvi__node dvi__variable_node(dvi__context *c, int block, dvi__numbering numbering, int offset);
/* Make the numbers scale * (each or all) + shift into a numbering. */
bool dvi__numbering_of(dvi__context *c, const int *each, int all, int shift, int scale,
                       dvi__numbering *numbering);
/* Return a row of data [elements] as a node. The row is copied. */
dvi__node dvi__data_node(dvi__context *c, const double *row);
/* Return the same variable of another block, as the velocity of a coordinate. */
dvi__node dvi__sibling_node(dvi__context *c, int input, int block);

/* Bind an index, without its values. Refuses a name that is taken. */
bool dvi__index_bind(dvi__context *c, dvi__span span, const char *name);
const dvi__index *dvi__index_find(const dvi__context *c, const char *name);

/* The range of a sum for every element, from the bounds of FORM_SUM. */
typedef struct dvi__bounds {
  int *first, *last; /* [elements], freed by the caller, or NULL */
  int all_first, all_last;
} dvi__bounds;
bool dvi__sum_bounds(const dvi__context *c, const dvi__expression *sum, dvi__bounds *bounds);

/* Return the flags DVI__MENTIONS_.. of an expression. */
unsigned dvi__mentions(const dvi_scene *scene, const dvi__expression *e);

/* List the operators of a chain a + b - c.. of the same kind (sums or products) as e, from the
 * inner to the outer one. Sets *count. */
const dvi__expression **dvi__spine(dvi_scene *scene, const dvi__expression *e, int *count);

bool dvi__refuse(const dvi__context *c, dvi__span span, const char *format, ...)
    DVI__TEXT_PRINTF(3, 4);

#endif
