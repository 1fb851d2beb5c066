/* A density on a lattice of cells in space and time (dvi/multisymplectic.h). */
#ifndef DVI_FIELD_MULTISYMPLECTIC_LATTICE_H
#define DVI_FIELD_MULTISYMPLECTIC_LATTICE_H
#include <dvi/multisymplectic.h>

#include "num/pattern.h"

enum {
  DVI__CORNERS = 8, /* of a cell in space, at most, and its points */
  DVI__BATCH = 256  /* points for one call of a density, at most */
};

/* The quadrature of one axis: value[k][i] is the straight function that is 1 at end i, at point k.
 * All points have the same weight. */
typedef struct dvi__two_points {
  int count;
  double value[2][2];
} dvi__two_points;

/* An axis. Vertices are the nodes but for the last one of a periodic axis. */
typedef struct dvi__lattice_axis {
  char name[32], momentum[48]; /* and of what is observed */
  const char *side[2];         /* parts of the boundary */
  int cells, vertices, is_periodic;
  double *node; /* [cells+1] */
  double weight;
  dvi__two_points rule;
} dvi__lattice_axis;

/* A variable of a part. axis is -1 for values and rates. */
typedef struct dvi__lattice_variable {
  int component, is_rate, axis;
} dvi__lattice_variable;

/* A part of the density. `declared` has the callbacks, and no arrays. */
typedef struct dvi__lattice_part {
  dvi_density_part declared;
  char name[64];
  dvi__lattice_variable *variable; /* [variables] */
  int (*pair)[2];                  /* [pairs] */
  int variables, pairs;
  char *varies, *is_zero; /* [pairs] whether second derivatives vary with z, or are 0 everywhere */
  dvi__two_points time;
} dvi__lattice_part;

/* A condition: fixed values at vertices, or a flux through faces of cells at the boundary, at
 * points with their corners. */
typedef struct dvi__lattice_condition {
  dvi_density_condition declared;
  int64_t count;
  int corners;
  int *place;     /* [count*corners] in u */
  double *shape;  /* [count*corners] functions of the corners, of a flux */
  double *x;      /* [axes*count] places */
  double *datum;  /* [count] */
  double *weight; /* [count], of a flux */
} dvi__lattice_condition;

typedef struct dvi__lattice {
  int axes, components, parts, conditions, corners, points, symmetries;
  dvi__lattice_axis axis[DVI_AXES_MAX];
  int64_t cells, vertices, size; /* size = components*vertices */
  int *corner;                   /* [cells*corners] vertices of cells */
  /* Values, and derivatives along each axis times the cell's width, of the corners' functions */
  double shape[1 + DVI_AXES_MAX][DVI__CORNERS][DVI__CORNERS]; /* [.][point][corner] */
  int at[DVI__CORNERS][DVI_AXES_MAX];                         /* [point] numbers on the axes */
  dvi__lattice_part *part;
  dvi__lattice_condition *condition;
  dvi_multisymplectic_symmetry *symmetry;
  char *names;  /* of the symmetries */
  int *unknown; /* [size] number of the unknown, or -1 */
  int unknowns;
  double time_weight, dt, bound;
  int is_symmetric; /* the matrix of a step */
  int is_linear;    /* second derivatives in a step's matrix are constant, as declared */
  dvi__pattern pattern;
  double *work; /* of a batch */
} dvi__lattice;

/* Make a lattice without a step. It may own things after a failure, too. */
dvi_status dvi__lattice_make(const dvi_multisymplectic_terms *terms, dvi__lattice *lattice);
void dvi__lattice_clear(dvi__lattice *lattice);

/* Make the axes and their sizes alone, and then cells and the functions of their corners. */
dvi_status dvi__lattice_make_axes(const dvi_multisymplectic_terms *terms, dvi__lattice *lattice);
dvi_status dvi__lattice_make_cells(dvi__lattice *lattice);

/* Check a weight of an axis, and give its points. */
dvi_status dvi__check_weight(double weight, const char *axis);
dvi__two_points dvi__two_points_of(double weight);

/* Give the numbers of a vertex and of a cell on each axis, and the place x [axes] of a vertex. */
void dvi__lattice_vertex_index(const dvi__lattice *lattice, int64_t vertex, int *index);
void dvi__lattice_vertex(const dvi__lattice *lattice, int64_t vertex, double *x);
void dvi__lattice_cell(const dvi__lattice *lattice, int64_t cell, int *index);

/* Give the cell around a vertex in which it is the corner with a number, or -1. */
int64_t dvi__lattice_cell_at(const dvi__lattice *lattice, int64_t vertex, int corner);

/* Copy the conditions, and number the unknowns. */
dvi_status dvi__lattice_make_conditions(const dvi_multisymplectic_terms *terms,
                                        dvi__lattice *lattice);

/* Tell if a part's name is that of an end of an axis, and a condition that of a component. */
int dvi__lattice_is_part(const char *part, const dvi__lattice_axis *axis, int end);
int dvi__lattice_is_of(const dvi_density_condition *given, int component);

/* Count the points of a flux, and keep them unless `kept` is NULL. */
int64_t dvi__lattice_take_faces(const dvi__lattice *lattice, const dvi_density_condition *given,
                                dvi__lattice_condition *kept);

/* Set the datum of a condition at time t. */
dvi_status dvi__lattice_datum(const dvi__lattice_condition *condition, double t);

/* Put the fixed values at time t into u [size], and their rates into `rate` [size], unless it is
 * NULL. */
dvi_status dvi__lattice_fix(const dvi__lattice *lattice, double t, double *u, double *rate);

/* ---- rows of cells between two levels ---- */

typedef struct dvi__row {
  double t;           /* of the lower level */
  const double *u[2]; /* [size] levels */
  const double *rate; /* [size] instead of the difference of the levels, or NULL */
  const char *is_in;  /* [cells] whether cells count. NULL if all do */
} dvi__row;

/* Points of some cells of a row at a time: cell by cell, as many as `count`. */
typedef struct dvi__batch {
  const dvi__lattice *lattice;
  const dvi__lattice_part *part;
  double t, level[2]; /* the time, and how much both levels count in values there */
  double duration;    /* weight in time */
  int64_t cell;
  int cells, count;
  double *weight, *x, *z, *l, *l_z, *l_zz; /* [count] and variables, pairs of them */
  double *width;                           /* [axes*cells] */
  double *more;                            /* [variables*count] for use */
} dvi__batch;

typedef enum dvi__wants {
  DVI__WANT_L = 1,
  DVI__WANT_L_Z = 2,
  DVI__WANT_L_ZZ = 4,
  DVI__OF_BOTH_LEVELS = 8 /* only where variables depend on both levels */
} dvi__wants;

/* Return the doubles that a batch's work needs. */
int64_t dvi__batch_work(const dvi__lattice *lattice);

/* Begin a batch of a part with a cell, of at most `most` cells. The caller sets the times. */
dvi__batch dvi__batch_begin(const dvi__lattice *lattice, const dvi__lattice_part *part,
                            int64_t cell, int most);

/* What a variable's shape is divided by in a cell of the batch. */
double dvi__batch_width(const dvi__batch *batch, const dvi__lattice_variable *variable, int cell);

/* Evaluate variables [variables*count] of levels, the density, and the adjoint of the variables:
 * add weight times g.z, differentiated by both levels. */
void dvi__batch_variables(const dvi__batch *batch, const dvi__row *row, double *z);
dvi_status dvi__batch_evaluate(const dvi__batch *batch, int wants);
void dvi__batch_add(const dvi__batch *batch, const double *g, double *lower, double *upper);

/* Set g [variables*count] to the second derivative of the density times z [variables*count]. */
void dvi__batch_second(const dvi__batch *batch, const double *z, double *g);

/* Visit the batches of a row, with z and what else is wanted. */
typedef dvi_status dvi__batch_visitor(void *of, const dvi__batch *batch);
dvi_status dvi__row_visit(const dvi__lattice *lattice, const dvi__row *row, int wants,
                          dvi__batch_visitor *visit, void *of);

/* Set lower and upper [size] to the derivatives of the row's action by both levels. */
dvi_status dvi__row_gradient(const dvi__lattice *lattice, const dvi__row *row, double *lower,
                             double *upper);

/* Set them to the second derivative of the row's action times v, another two levels. */
dvi_status dvi__row_second(const dvi__lattice *lattice, const dvi__row *row, const dvi__row *v,
                           double *lower, double *upper);

/* Add what fluxes through the boundary add to these three. */
dvi_status dvi__row_add_fluxes(const dvi__lattice *lattice, const dvi__row *row, double *lower,
                               double *upper);
void dvi__row_add_second_of_fluxes(const dvi__lattice *lattice, const dvi__row *v, double *lower,
                                   double *upper);
dvi_status dvi__row_add_energy_of_fluxes(const dvi__lattice *lattice, const dvi__row *row,
                                         double *energy);

void dvi__lattice_add_matrix_of_fluxes(const dvi__lattice *lattice, double *values);

/* Add what they add to the stiffness K of a cell, where it is positive. Cells come in their order:
 * taken [conditions] counts points and is 0 for the first one. */
void dvi__lattice_add_fluxes_of_cell(const dvi__lattice *lattice, int64_t cell, int64_t *taken,
                                     double *K);

/* Set p [size] to the momenta of a level u[0] with a rate. */
dvi_status dvi__row_momenta(const dvi__lattice *lattice, const dvi__row *row, double *p);

/* Give the energy of the row, as in dvi/multisymplectic.h. */
dvi_status dvi__row_energy(const dvi__lattice *lattice, const dvi__row *row, double *energy);

/* ---- the equations of a level ---- */

/* Find which second derivatives vary, and which are zero. */
dvi_status dvi__lattice_probe(dvi__lattice *lattice);

/* Find the bound of the steps. */
dvi_status dvi__lattice_find_bound(dvi__lattice *lattice);

/* Make the pattern of the matrix of a step, minus the second derivative of a row's action by its
 * lower and its upper level, and set its values. */
dvi_status dvi__lattice_make_pattern(dvi__lattice *lattice);
dvi_status dvi__lattice_matrix(const dvi__lattice *lattice, const dvi__row *row, double *values);

#endif
