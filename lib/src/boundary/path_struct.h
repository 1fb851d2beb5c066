/* The inside of a path, for the files of this room.
 *
 * Unknowns, in the order of time: (q_0, Z^0, q_1, Z^1, .. ), where Z^k are the bubbles of step k
 * (step/element/two_point.h) and given nodes are left out; then the span, if it is free; then a
 * multiplier for each direction along which the path may be moved (gauge.c). Rows stand in the same
 * order, so that the Jacobian is the symmetric Hessian of the action; but for initial ends, where
 * the row of node k stands with the unknown q_(k+1) that it gives. */
#ifndef DVI_PATH_PATH_STRUCT_H
#define DVI_PATH_PATH_STRUCT_H
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
  double start, span; /* the span's unknown, if it is free, is its ratio to this */
  double energy;      /* of a free span */
  int free_span;
  double *q0, *q1, *p0, *shift; /* [n]; NULL where they are not given */
  /* the symmetry's transpose: its column i is row i of A; empty: the identity */
  dvi__pattern turn;
  double *turn_values;
  dvi__action *action;
  dvi__evaluator *energies; /* at nodes; NULL: the system is not autonomous */
  dvi__solver *solver;
  dvi__pattern pattern;
  int core;                /* unknowns of nodes and bubbles */
  int gauges;              /* multipliers, the last unknowns */
  int unknowns;            /* of all kinds */
  double *x;               /* [unknowns] the path: a guess, or solved */
  double *trial;           /* [unknowns] what a solve works on */
  double *q, *p, *trial_p; /* [(steps+1)*n] nodes and momenta of x; momenta of trial */
  int solved;              /* p is there */
  /* One element's worth of work. */
  double *Y, *in_ends[2], *in_Z, *wrapped, *rest; /* [n*s], [n], [n*(s-1)], [n]; rest: p0 = 0 */
  double *block;                                  /* [entries of the coupling * (s+1)^2] */
  double *kinetic;                                /* [n] size of |L_vv|_ii */
  double *row_scale;                              /* [n*s] */
  double *rows;                                   /* [core] a gradient */
  double *energy_Y, *energy_q0;                   /* [n*s], [n] what an energy changes by */
  double *probe;                                  /* [7*n] velocities and gradients at two points */
  /* Gauge (gauge.c): the columns [gauges*steps*n] at the nodes but the last, the nodes that they
   * are measured from, and how many are in use. */
  double *gauge, *origin;
  double *defect; /* [gauges*n] */
  int *broken;    /* [gauges] */
  int in_use;
  int holds_time; /* the last one in use is that of time */
};

/* Where a number of an element stands among all unknowns (or rows): in `count` places, with
 * factors. */
typedef struct dvi__places {
  int count;
  const int *at;
  const double *factor;
  int single;
} dvi__places;

/* ---- layout.c ---- */

/* Set core, unknowns and pattern. DVI_BAD_SIZE if they cannot be counted by an int. */
dvi_status dvi__path_lay_out(dvi_path *path);

/* Places of X_a of coordinate i of step k; `row`: of the row that belongs to it. */
void dvi__path_places(const dvi_path *path, int k, int a, int i, int row, dvi__places *places);

/* First unknown of node k, or -1 if it is given. */
int dvi__path_node(const dvi_path *path, int k);

/* First bubble of step k. */
int dvi__path_bubbles(const dvi_path *path, int k);

/* Node k as x has it; of a last node that the first one determines a copy, valid until the next
 * call. */
const double *dvi__path_at(dvi_path *path, const double *x, int k);

/* y [n] = A x [n], without the shift. */
void dvi__path_turn(const dvi_path *path, const double *x, double *y);

/* x [n] = A^T y. */
void dvi__path_turn_back(const dvi_path *path, const double *y, double *x);

/* A q + a, valid until the next call or that of dvi__path_at. */
const double *dvi__path_image(dvi_path *path, const double *q);

/* ---- equations.c ---- */

dvi_status dvi__path_make_solver(dvi_path *path);

/* Measure the kinetic part at x, which sets the scales of rows. */
dvi_status dvi__path_scale(dvi_path *path, const double *x);

/* Put the element on step k of x and find its Y; the span is that of x. */
void dvi__path_place(dvi_path *path, const double *x, int k);

/* The span that x holds. */
double dvi__path_span(const dvi_path *path, const double *x);

/* The largest |row| of nodes and bubbles, without multipliers; p [(steps+1)*n] gets the momenta. */
dvi_status dvi__path_gradient(dvi_path *path, const double *x, double *p, double *gradient);

/* The Hessian with its border, in the order of the pattern. */
dvi_status dvi__path_jacobian(dvi_path *path, const double *x, double *values);

/* The action; and the mean energy, NaN if the system is not autonomous. DVI_NOT_CONVERGED if the
 * path leads through a singularity unseen. */
dvi_status dvi__path_action(dvi_path *path, const double *x, double *action, double *energy);

/* ---- energy.c ---- */

/* Fill energy_spread, kinetic, energy_jump and jump_step of the report for `trial` and its trial_p,
 * which dvi__path_gradient has found. */
dvi_status dvi__path_energies(dvi_path *path, dvi_path_report *report);

/* DVI_STEP_TOO_LARGE if these numbers are those of a path that follows no motion. */
dvi_status dvi__path_check_resolved(const dvi_path *path, const dvi_path_report *report);

/* ---- gauge.c ---- */

/* Find the directions along which the periodic path x may be moved; the solution is to have no
 * distance from x along them. One that differs from the others by less than `least_own_part` of
 * itself is none of its own. After dvi__path_scale. */
dvi_status dvi__path_fix_gauge(dvi_path *path, const double *x, double least_own_part);

/* Let the path go in time again; 0 if it was not held. */
int dvi__path_release_time(dvi_path *path);

/* ---- symmetry.c ---- */

/* DVI_BAD_ARGUMENT if the ends are periodic and the Lagrangian at the first `nodes` nodes of x is
 * another one where the symmetry takes them, a span later. */
dvi_status dvi__path_check_symmetry(dvi_path *path, const double *x, int nodes);

/* ---- index.c ---- */

/* Fill negative, zero and zero_below of the report for `trial`. */
dvi_status dvi__path_index(dvi_path *path, dvi_path_report *report);

#endif
