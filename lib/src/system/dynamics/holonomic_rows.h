/* What an evaluator keeps for constraints, and the matrix of index 1 (holonomic.c). */
#ifndef DVI_SYSTEM_DYNAMICS_HOLONOMIC_ROWS_H
#define DVI_SYSTEM_DYNAMICS_HOLONOMIC_ROWS_H
#include "num/linear.h"
#include "system/evaluate/dynamics.h"

enum { DVI__NOISE_SAMPLES = 7 };

typedef struct dvi__rows_memory {
  dvi__pattern matrix;                        /* of [L_vv G^T; G 0] */
  int *mass_place, *column_place, *row_place; /* places of L_vv, of G^T and of G */
  int *own_place, *diagonal;                  /* [m] of the last block, [n] of L_ii in L_vv */
  int row_count;
  dvi__linear *linear;
  double *values, *x;          /* [entries], [n + m] */
  double *phi, *phi_t, *phi_q; /* [m], [m], [entries of rows_q] */
  double *point, *along[2];    /* [n] a moved point, [n + m] derivatives along the motion */
  double *hessian, *sum;       /* [entries of rows_qq], [n] */
  double *moved_A;             /* [entries of rows_q] A at another point */
  double *derivative, *before; /* [n + m] differences along the motion of two lengths */
  double *defect;              /* [n + m] by which they differ */
  double *line, *samples; /* [n*DVI__NOISE_SAMPLES] near a point, and [m*DVI__NOISE_SAMPLES] phi */
  /* [n] 1 for numbers of rotations, directions and angles, which are rounded as 1 is, else 0 */
  double *unit;
  double *work;  /* [n + m + entries of rows_q] a point of a batch and its results */
  double *scale; /* [m] powers of two near the sizes of the rows of M^-1/2 G^T, inverted */
  /* With dependent rows the matrix is [L_vv G^T; G -softness D], D the diagonal of G M^-1 G^T. */
  double softness;
  int dependent_count;
  char *dependent; /* [m] rows that depend on others at the last start */
  double *numbers;
} dvi__rows_memory;

/* Create the memory of an evaluator, and free it. On a manifold there is no matrix. */
dvi_status dvi__rows_prepare(dvi__evaluator *e);
void dvi__rows_release(dvi__evaluator *e);

dvi__rows_memory *dvi__rows_memory_of(const dvi__evaluator *e);

/* Compute G x + g, where phi_q has G and phi_t has g. */
void dvi__rows_push(const dvi_system *system, const double *phi_q, const double *x,
                    const double *phi_t, double *sum);

/* Differences of (L_v, G v + g) along the motion (1, v, 0), into x of the memory. */
dvi_status dvi__rows_slopes(dvi__evaluator *e, double t, const double *q, const double *v);

/* Write the name of a row's constraint in quotes, with the number of the row if it has several. */
enum { DVI__ROW_LABEL = 96 };
const char *dvi__rows_label(const dvi_system *s, int a, char label[DVI__ROW_LABEL]);

/* Factor the matrix at a point, whose gradients stay in phi_q, and solve for x in place. */
dvi_status dvi__rows_factor(dvi__evaluator *e, double t, const double *q, const double *v);
dvi_status dvi__rows_solve(const dvi__rows_memory *r, int size, double t);

/* Refuse nonholonomic constraints that are dependent, or integrable, near a point. */
dvi_status dvi__rows_are_nonholonomic(dvi__evaluator *e, double t, const double *q);

/* The functions of the states on the constraints (dvi__state_constraint), and all of them. */
dvi_status dvi__rows_check(dvi__evaluator *e, double t, const double *q, const double *p);
dvi_status dvi__rows_distance(dvi__evaluator *e, double t, const double *q, const double *p,
                              double *distance);
dvi_status dvi__rows_size(dvi__evaluator *e, double t, const double *q, const double *p,
                          double *size);
dvi_status dvi__rows_side(dvi__evaluator *e, double t, const double *q, const double *p, int before,
                          int *side);
extern const dvi__state_constraint dvi__on_rows;

/* Check phi = 0, with its roundings where q alone does not explain the rest. The second function
 * says that a projection has found no such place. */
dvi_status dvi__rows_check_place(dvi__evaluator *e, double t, const double *q);
dvi_status dvi__rows_found(dvi__evaluator *e, double t, const double *q);

/* Move q along M^-1 G^T towards the constraint as far as rounding permits, then the momentum. */
dvi_status dvi__rows_approach(dvi__evaluator *e, double t, double *q, double *p);

#endif
