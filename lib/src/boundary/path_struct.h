/* The members of a path, for the files of this room.
 *
 * The unknowns are (q_0, Z^0, q_1, Z^1, .. ) in the order of time, where Z^k are the bubbles of
 * step k (step/element/two_point.h) and given nodes are left out. Then comes the span, if it is
 * free, and a multiplier for each direction along which the path may be moved (gauge.c). Rows have
 * the same order, so that the Jacobian is the symmetric Hessian of the action. With initial ends
 * the row of node k stands with the unknown q_(k+1) that it determines. With mixed ends all numbers
 * of the first and the last node are unknowns, and those that are given have rows x = given. */
#ifndef DVI_BOUNDARY_PATH_STRUCT_H
#define DVI_BOUNDARY_PATH_STRUCT_H
#include <dvi/path.h>

#include "step/element/two_point.h"
#include "solve/nonlinear.h"

enum { DVI__PATH_METHOD_SIZE = 256 };

struct dvi_path {
  const dvi_system *system;
  dvi_counters counters;
  char method[DVI__PATH_METHOD_SIZE];
  dvi_ends ends;
  int n, s, steps, order;
  double start, span; /* a free span's unknown is its ratio to this span */
  double energy;      /* energy of a path with a free span */
  int free_span;
  double *q0, *q1, *p0, *p1, *shift; /* [n], NULL where not given */
  char *free[2];                     /* [n] of mixed ends, else NULL */
  dvi__pattern turn;                 /* transpose of the symmetry A. Empty for the identity */
  double *turn_values;               /* entries of A, column i of the pattern is row i of A */
  dvi__action *action;
  dvi__evaluator *energies; /* evaluator of energies at nodes. NULL unless autonomous */
  dvi__solver *solver;
  dvi__pattern pattern;
  int core;        /* number of unknowns of nodes and bubbles */
  int gauges;      /* number of multipliers, the last unknowns */
  int unknowns;    /* number of all unknowns */
  double *x;       /* [unknowns] the path, a guess or solved */
  double *trial;   /* [unknowns] the path in a solve */
  double *q, *p;   /* [(steps+1)*n] nodes and momenta of x */
  double *trial_p; /* [(steps+1)*n] momenta of trial */
  int solved;      /* p is valid */
  /* Work of one element. */
  double *Y;                    /* [n*s] */
  double *in_ends[2], *in_Z;    /* [n], [n*(s-1)] gradient by the ends and the bubbles */
  double *wrapped;              /* [n] image of a node */
  double *rest;                 /* [n] zeros, for p0 */
  double *block;                /* [entries of the coupling * (s+1)^2] */
  double *kinetic;              /* [n] size of |L_vv|_ii */
  double *row_scale;            /* [n*s] */
  double *rows;                 /* [core] a gradient */
  double *energy_Y, *energy_q0; /* [n*s], [n] gradient of an energy */
  double *probe;                /* [7*n] velocities and gradients at two points */
  /* Gauges (gauge.c). */
  double *gauge;  /* [gauges*steps*n] columns at the nodes but the last */
  double *origin; /* [steps*n] nodes from which the columns are measured */
  double *defect; /* [gauges*n] */
  int *broken;    /* [gauges] */
  int in_use;     /* number of columns in use */
  int holds_time; /* the last column in use is that of time */
};

/* The places of an element's number among all unknowns (or rows), `count` places with factors. */
typedef struct dvi__places {
  int count;
  const int *at;
  const double *factor;
  int single;
} dvi__places;

/* ---- layout.c ---- */

/* Set core, unknowns and pattern. DVI_BAD_SIZE if they cannot be counted by an int. */
dvi_status dvi__path_lay_out(dvi_path *path);

/* Find the places of X_a of coordinate i of step k, or with `row` of the row that belongs to it. */
void dvi__path_places(const dvi_path *path, int k, int a, int i, int row, dvi__places *places);

/* Return the first unknown of node k, or -1 if the node is given. */
int dvi__path_node(const dvi_path *path, int k);

/* Return the place of coordinate i of the first node (end 0) or the last one (1) if mixed ends give
 * it, else -1. */
int dvi__path_given(const dvi_path *path, int end, int i);

/* Return the first bubble of step k. */
int dvi__path_bubbles(const dvi_path *path, int k);

/* Return node k of x. If the first node determines the last one, the last node is a copy, valid
 * until the next call. */
const double *dvi__path_at(dvi_path *path, const double *x, int k);

/* Compute y [n] = A x [n], without the shift. */
void dvi__path_turn(const dvi_path *path, const double *x, double *y);

/* Compute x [n] = A^T y. */
void dvi__path_turn_back(const dvi_path *path, const double *y, double *x);

/* Return A q + a, valid until the next call or that of dvi__path_at. */
const double *dvi__path_image(dvi_path *path, const double *q);

/* ---- equations.c ---- */

dvi_status dvi__path_make_solver(dvi_path *path);

/* Measure the kinetic part at x and set the scales of rows by it. */
dvi_status dvi__path_scale(dvi_path *path, const double *x);

/* Place the element on step k of x and compute its Y. The span is that of x. */
void dvi__path_place(dvi_path *path, const double *x, int k);

/* Return the span of x. */
double dvi__path_span(const dvi_path *path, const double *x);

/* Compute the largest |row| of nodes and bubbles, without multipliers, and the momenta
 * p [(steps+1)*n]. */
dvi_status dvi__path_gradient(dvi_path *path, const double *x, double *p, double *gradient);

/* Compute the Hessian with its border, in the order of the pattern. */
dvi_status dvi__path_jacobian(dvi_path *path, const double *x, double *values);

/* Compute the action and the mean energy, NaN if the system is not autonomous. DVI_NOT_CONVERGED if
 * the path leads through a singularity that the quadrature does not see. */
dvi_status dvi__path_action(dvi_path *path, const double *x, double *action, double *energy);

/* ---- energy.c ---- */

/* Fill energy_spread, kinetic, energy_jump and jump_step of the report for `trial` and its trial_p,
 * which dvi__path_gradient has found. */
dvi_status dvi__path_energies(dvi_path *path, dvi_path_report *report);

/* Check that the path follows a motion, else DVI_STEP_TOO_LARGE. */
dvi_status dvi__path_check_resolved(const dvi_path *path, const dvi_path_report *report);

/* ---- gauge.c ---- */

/* Find the directions along which the periodic path x may be moved. The solution is required to
 * have no distance from x along them. A direction that differs from the span of the others by less
 * than `least_own_part` of itself is left out. Call dvi__path_scale before. */
dvi_status dvi__path_fix_gauge(dvi_path *path, const double *x, double least_own_part);

/* Release the path in time. Return 0 if it was not held. */
int dvi__path_release_time(dvi_path *path);

/* ---- symmetry.c ---- */

/* Check the symmetry of periodic ends at the first `nodes` nodes of x. DVI_BAD_ARGUMENT if the
 * Lagrangian differs at the images of the nodes, a span later. */
dvi_status dvi__path_check_symmetry(dvi_path *path, const double *x, int nodes);

/* ---- index.c ---- */

/* Fill negative, zero and zero_below of the report for `trial`. */
dvi_status dvi__path_index(dvi_path *path, dvi_path_report *report);

#endif
