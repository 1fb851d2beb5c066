/* What an expression is elaborated in: a graph, where its inputs come from, and the indices that
 * are bound.
 *
 * A context has elements: one, or those of a sum. An index is a number for every element; an
 * expression without coordinates is one number for every element, too, and becomes a constant if
 * they are all the same and a row of data if not. */
#ifndef DVI_SCENE_CONTEXT_H
#define DVI_SCENE_CONTEXT_H
#include "expr/function/function.h"
#include "scene/elaborate/model.h"

enum { DVI__INDICES_MAX = 64 };

/* The nodes of a value, row by row; a number has its node in `one`. */
typedef struct dvi__value {
  dvi__shape shape;
  dvi__node one;
  dvi__node *node;
} dvi__value;

typedef struct dvi__index {
  const char *name;
  const int *each; /* [elements]; NULL: `all` for every element */
  int all;
  const double *row; /* `each` as data, once it is needed */
} dvi__index;

/* Numbers of variables for every element: number[e], or base + stride * e. */
typedef struct dvi__numbering {
  const int *number;
  int base, stride;
} dvi__numbering;

typedef struct dvi__context {
  dvi_scene *scene;
  dvi__graph *graph;
  unsigned may;      /* DVI__SAYS_.. that may be mentioned */
  const char *where; /* "a potential": for messages */
  int elements;
  dvi__index index[DVI__INDICES_MAX];
  int index_count;
  dvi__kernel_input *input;
  int input_count;
  dvi__numbering *numbering;
  int numbering_count;
  int *of_number[DVI__BLOCKS]; /* input + 1 of a variable that is the same for all elements */
  dvi__value *definition;      /* [definition_count] values, rank -1: not elaborated yet */
  int depth;
  dvi__span whole; /* of the expression at depth 1 */
  int sample;      /* 1: sums take their first and last index only, to learn shapes */
  int uneven;      /* the expression is not the same for all elements: elaborate them one by one */
} dvi__context;

/* One element and no indices; dvi__context_free. */
bool dvi__context_make(dvi__context *c, dvi_scene *scene, unsigned may, const char *where);
void dvi__context_free(dvi__context *c);

/* Note that a parameter stands in what is read now. */
bool dvi__note_parameter(dvi_scene *scene, dvi__parameter *parameter);

/* Elaborate; rank -1 if it makes no sense, which was told, or c->uneven was set. */
dvi__value dvi__elaborate(dvi__context *c, const dvi__expression *e);
/* The same, where a number is needed. */
bool dvi__elaborate_number(dvi__context *c, const dvi__expression *e, dvi__node *node);

/* A number without coordinates for every element: *each [elements], to be freed, or NULL and it is
 * *all for all of them. */
bool dvi__numbers_of(const dvi__context *c, const dvi__expression *e, double **each, double *all);
/* The same of a node without variables. */
bool dvi__node_numbers(dvi__context *c, const dvi__expression *e, dvi__node node, double **each,
                       double *all);
/* The same for whole numbers; `what` for messages. */
bool dvi__whole_numbers_of(const dvi__context *c, const dvi__expression *e, const char *what,
                           int **each, int *all);

/* The numbers of a value in which nothing is unknown, [rows * columns]; told if one is not
 * finite. */
bool dvi__constants_of(dvi__context *c, const dvi__expression *e, dvi__value value, double *number);

/* A variable of a block as a node: number numbering + offset. */
dvi__node dvi__variable_node(dvi__context *c, int block, dvi__numbering numbering, int offset);
/* The numbers scale * (each or all) + shift as a numbering. */
bool dvi__numbering_of(dvi__context *c, const int *each, int all, int shift, int scale,
                       dvi__numbering *numbering);
/* A row of data [elements] as a node; copied. */
dvi__node dvi__data_node(dvi__context *c, const double *row);
/* The same variable of another block: the velocity of a coordinate. */
dvi__node dvi__sibling_node(dvi__context *c, int input, int block);

/* Bind an index, without its values; refused if the name is taken. */
bool dvi__index_bind(dvi__context *c, dvi__span span, const char *name);
const dvi__index *dvi__index_find(const dvi__context *c, const char *name);

/* Over what a sum runs, for every element: the bounds of FORM_SUM. */
typedef struct dvi__bounds {
  int *first, *last; /* [elements] to be freed, or NULL */
  int all_first, all_last;
} dvi__bounds;
bool dvi__sum_bounds(const dvi__context *c, const dvi__expression *sum, dvi__bounds *bounds);

/* What an expression mentions: DVI__SAYS_.. */
unsigned dvi__says(const dvi_scene *scene, const dvi__expression *e);

/* The operators of a chain a + b - c.., from the inner to the outer one, of the same kind (sums or
 * products) as e: *count of them. */
const dvi__expression **dvi__spine(dvi_scene *scene, const dvi__expression *e, int *count);

bool dvi__refuse(const dvi__context *c, dvi__span span, const char *format, ...)
    DVI__TEXT_PRINTF(3, 4);

#endif
