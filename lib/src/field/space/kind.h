/* Kinds of spaces, and what they fill in.
 *
 * A kind of one axis is a file with one const dvi__kind, declared at the end of this header and
 * named in the list of kinds.c. Its `create` fills a dvi__line: cells, the numbering of their local
 * functions, and the quadrature points of a cell. Its `local` evaluates the local functions.
 * Points, operators, products of axes, boundaries, evaluation and interpolation follow from these.
 *
 * A kind whose functions are no products of those of axes, as on a mesh, is a dvi__domain. Its file
 * fills a dvi_space, and dvi_space_create calls it. */
#ifndef DVI_FIELD_SPACE_KIND_H
#define DVI_FIELD_SPACE_KIND_H
#include <stdatomic.h>

#include "field/space/space.h"

enum {
  DVI__SPACE_KEYS = 6,   /* most options of a kind */
  DVI__ORDER_MOST = 16,  /* of derivatives */
  DVI__LOCALS_MOST = 257 /* local functions of a cell */
};

/* ---- specifications ---- */

/* An option, a whole number, or one of the words that stand for the numbers from 0. */
typedef struct dvi__space_key {
  const char *name;
  int least, most;
  int fallback;            /* the value if the option is not given. 0 often means "not given" */
  const char *const *word; /* ended by NULL. NULL for numbers */
} dvi__space_key;

/* The words of a switch. */
extern const char *const dvi__no_yes[];

/* A name with its options, of which the last ones may have no name. */
typedef struct dvi__spec_form {
  const char *name;
  dvi__space_key key[DVI__SPACE_KEYS];
} dvi__spec_form;

/* Read "name:key=value,.." by the first form with this name, and give its number in the list
 * [forms] and all values. DVI_BAD_OPTION. */
dvi_status dvi__spec_read(const char *spec, int forms, const dvi__spec_form *const *form,
                          int *number, int value[DVI__SPACE_KEYS]);

/* Text that is cut off at its size. */
typedef struct dvi__note {
  char *text;
  size_t size, length;
} dvi__note;
void dvi__note_add(dvi__note *note, const char *format, ...);

/* ---- spaces of one axis ---- */

typedef struct dvi__kind dvi__kind;

/* A space of one dimension: cells with `locals` local functions and `cell_points` quadrature points
 * each. Local function l of cell c is function c stride + l, and periodic axes count round. */
typedef struct dvi__line {
  const dvi__kind *kind;
  char *name;
  double from, to;
  int periodic;
  int value[DVI__SPACE_KEYS]; /* of the options */
  int64_t cells;
  double *node; /* [cells+1] ends of the cells */
  double width; /* of equal cells, whose matrices have equal rows. 0 for other cells */
  int degree;   /* of polynomials, for dvi_space_explain. 0 for other functions */
  int locals, stride, smoothness;
  int64_t functions;
  int cell_points;
  double *place, *weight; /* [cell_points] the quadrature of a cell, as of the interval [0,1] */
  double *mark;           /* [locals] nodes in [0,1] that interpolate. NULL for other kinds */
  int is_nodal;           /* the quadrature points are the nodes */
  void *own;              /* of the kind */
} dvi__line;

struct dvi__kind {
  dvi__spec_form form;
  /* Fill what follows `value` in the line. node [nodes] is that of the axis, and NULL unless it is
   * given. Without a value of "cells" there are as many cells as nodes tell. On failure the line is
   * cleared by the caller. */
  dvi_status (*create)(const dvi_space_options *options, const dvi_axis *axis, dvi__line *line);
  /* Give the derivatives of the local functions [locals] in the local coordinate s, which runs from
   * 0 to 1 in the cell. */
  void (*local)(const dvi__line *line, int order, int64_t cell, double s, double *value);
  int is_affine;              /* the local functions, in s, are the same in each cell */
  void (*destroy)(void *own); /* NULL if there is nothing to release */
  /* Describe the quadrature behind "axis x, 0 to 1: fem, degree 2, 9 cells: 19 functions, ". */
  void (*explain)(const dvi__line *line, dvi__note *note);
  /* The domain of boxes with so many axes or more, all of this kind. NULL for products of axes. */
  const struct dvi__domain *domain;
  int domain_axes;
};

/* Create and release the space of axis d. */
dvi_status dvi__line_create(const dvi_space_options *options, int d, dvi__line *line);
void dvi__line_clear(dvi__line *line);

/* For `create`: make the cells, from the nodes of the axis or equal ones, `cells` of them. */
dvi_status dvi__line_divide(const dvi_axis *axis, int64_t cells, dvi__line *line);

/* For `create`: make a quadrature of Gauss with n points a cell. */
dvi_status dvi__line_gauss(int n, dvi__line *line);
void dvi__explain_gauss(const dvi__line *line, dvi__note *note);

/* Return the width of a cell. Differences of the ends of equal cells would differ by roundings. */
static inline double dvi__cell_width(const dvi__line *line, int64_t cell)
{
  return line->width > 0 ? line->width : line->node[cell + 1] - line->node[cell];
}

/* Give point i of an axis and its weight. The last place of a cell may be the end of the cell
 * itself, to the bit. */
static inline double dvi__line_point(const dvi__line *line, int64_t i, double *weight)
{
  const int64_t cell = i / line->cell_points, k = i % line->cell_points;
  const double width = dvi__cell_width(line, cell);
  *weight = width * line->weight[k];
  return line->place[k] == 1 ? line->node[cell + 1] : line->node[cell] + width * line->place[k];
}

/* Return the number of quadrature points. */
static inline int64_t dvi__line_points(const dvi__line *line)
{
  return line->cells * line->cell_points;
}

/* Make the matrix [points x functions] of a derivative. */
dvi_status dvi__line_operator(const dvi__line *line, int order, dvi__csr *matrix);

/* Give the row of a derivative at x with at most `locals` entries, and return their number, 0
 * outside of the axis. */
int dvi__line_row(const dvi__line *line, int order, double x, int *column, double *value);

/* ---- spaces of any dimension ---- */

/* A function to interpolate, as dvi_space_interpolate takes it. */
typedef struct dvi__sampled {
  int (*f)(int64_t count, const double *x, double *f, void *user);
  void *user;
} dvi__sampled;

typedef struct dvi__domain {
  /* Fill what stands below `lines` in a space. Lines are made before, a mesh is shared. On failure
   * the space is cleared by the caller. */
  dvi_status (*create)(const dvi_space_options *options, dvi_space *space);
  void (*destroy)(void *own); /* NULL if there is nothing to release */
  /* Refuse orders that the smoothness along each axis allows. NULL if there are none. */
  dvi_status (*check_order)(const dvi_space *space, const int *order);
  /* The matrix of a derivative. NULL for transforms. */
  dvi_status (*matrix)(const dvi_space *space, const int *order, dvi__csr *made);
  /* dvi__operator_apply and the others of transforms. NULL for matrices. */
  void (*apply)(const dvi__space_operator *B, const double *U, double *values, double *work);
  void (*add_transposed)(const dvi__space_operator *B, const double *values, double *U,
                         double *work);
  /* dvi__space_row for an order that the space has, with room for all entries. */
  dvi_status (*row)(const dvi_space *space, const int *order, const double *x, int *column,
                    double *value, int64_t *count);
  /* dvi_space_evaluate for such an order. */
  dvi_status (*evaluate)(const dvi_space *space, const int *order, const double *U, int64_t count,
                         const double *x, double *values);
  dvi_status (*interpolate)(const dvi_space *space, const dvi__sampled *f, double *U);
  void (*explain)(const dvi_space *space, dvi__note *note);
} dvi__domain;

/* A part of the boundary with its functions. */
typedef struct dvi__space_part {
  const char *name; /* of a constant, or of the mesh */
  int64_t count;
  int *function;
} dvi__space_part;

struct dvi_space {
  atomic_int owners;
  const dvi__domain *domain;
  int dimension;
  dvi_mesh *mesh; /* or NULL */
  dvi__line line[DVI_AXES_MAX];
  int lines; /* 0 with a mesh */
  int smoothness[DVI_AXES_MAX];
  int64_t functions, points, row_entries, work;
  double *x, *weight; /* [dimension*points], [points] */
  int is_nodal;
  dvi__space_part *part; /* [parts] */
  int parts;
  void *own; /* of the domain */
};

/* For `create` of products of axes: count functions and points, and place the points. */
dvi_status dvi__box_place(dvi_space *space);

/* Describe how many functions and points a product of several axes has. */
void dvi__explain_product(const dvi_space *space, dvi__note *note);

/* Check the counts of a space, or of one of its axes before memory is taken. DVI_BAD_SIZE. */
dvi_status dvi__space_check_sizes(double functions, double points);

/* Check the order of a derivative. DVI_UNSUPPORTED. */
dvi_status dvi__space_check_order(const dvi_space *space, const int *order);

/* Fail because a point [dimension] lies outside. */
dvi_status dvi__space_outside(const dvi_space *space, const double *x);

/* Evaluate row by row. */
dvi_status dvi__evaluate_by_rows(const dvi_space *space, const int *order, const double *U,
                                 int64_t count, const double *x, double *values);

/* Call f at points x [dimension*count] axis by axis, and check the values. */
dvi_status dvi__space_sample(int dimension, const dvi__sampled *f, int64_t count, const double *x,
                             double *values);

/* The kinds of axes, ended by NULL, and the domains. */
extern const dvi__kind *const dvi__kinds[];
extern const dvi__kind dvi__fem, dvi__spline, dvi__legendre_element, dvi__chebyshev_element,
    dvi__fourier, dvi__msfem;
extern const dvi__domain dvi__box, dvi__torus, dvi__simplices, dvi__msfem_plane;

#endif
