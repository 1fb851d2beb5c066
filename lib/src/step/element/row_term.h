/* Terms of an element's rows beside its action, such as charts that move with their start, forces,
 * multipliers, controls, noise.
 *
 * The rows of the action are
 *
 *     R_k = sum_j b_j ( h (psi_k - psi_k(1)) L_q + psi_k' L_v )_j - psi_k(1) p0,
 *     p1 = p0 + h sum_j b_j L_q_j      (action.h).
 *
 * A term may add to the rows and to p1 - p0, add to their derivatives and to the magnitudes by
 * which roundings are measured, and bring unknowns and rows of its own, which stand behind the
 * path's. The order is Y [n*s], then the unknowns of each term. */
#ifndef DVI_STEP_ELEMENT_ROW_TERM_H
#define DVI_STEP_ELEMENT_ROW_TERM_H
#include "num/pattern.h"

/* The path at which rows are evaluated. Number [i*r + j] over the nodes is that of coordinate i at
 * node j. */
typedef struct dvi__row_path {
  int n, s, r; /* coordinates, degree, quadrature nodes */
  double t0, h;
  const double *q0, *p0;          /* [n] */
  const double *q1;               /* [n] q at the path's end */
  const double *Y;                /* [n*s] coefficients */
  const double *dp;               /* [n] h sum_j b_j L_q_j, not yet known to `place` */
  const double *t, *Q, *V;        /* [r], [n*r], [n*r] */
  const double *weight, *end;     /* [r] b_j, [s] psi_k(1) */
  int lanes;                      /* length of a row of the tables */
  const double *psi, *bar, *dpsi; /* [s*lanes] psi_k(c_j), psi_k(c_j) - psi_k(1), psi_k'(c_j) */
} dvi__row_path;

/* The places to which derivatives are added. */
typedef struct dvi__row_jacobian dvi__row_jacobian;

typedef struct dvi__row_term {
  const char *name; /* in sentences */
  void *of;         /* first argument of the functions, which may be NULL but for `rows` */

  /* Pattern [n x n] of the coordinates that meet in the term's derivatives, beside those that meet
   * in L's. Default none. */
  const dvi__pattern *pattern;

  /* Own unknowns and own rows come in groups of this size, which do not meet each other. Default
   * none. Unknown k of group a is own[a*unknowns + k]. */
  int unknowns;
  /* [n x groups] coordinates whose rows and columns the unknowns of each group meet */
  const dvi__pattern *acting;

  /* Take the path, before L's derivatives are evaluated. */
  void (*place)(void *of, const dvi__row_path *path);

  /* Add to R [n*s] and to dp [n], the change of the momentum. Write own_R [own unknowns]. */
  dvi_status (*rows)(void *of, const dvi__row_path *path, const double *own, double *R, double *dp,
                     double *own_R);

  /* Add the magnitudes of the summands to [n*s] and to [own unknowns], after `rows`. */
  void (*magnitudes)(const void *of, const dvi__row_path *path, double *magnitude,
                     double *own_magnitude);

  /* Add to the derivatives, after `place` and L's Hessians. */
  dvi_status (*derivatives)(void *of, const dvi__row_path *path, const double *own,
                            const dvi__row_jacobian *J);

  /* Give the typical sizes [own unknowns] of the own rows per unit of an unknown. */
  void (*scale)(const void *of, double h, double *scale);
} dvi__row_term;

/* Give the place in dR/dY of the s rows of coordinate `row` that meet Y_l of coordinate `column`.
 * NULL if the pattern has no such entry. */
double *dvi__row_block(const dvi__row_jacobian *J, int row, int column, int l);

/* Give the same place by the number of the entry in the joint pattern (dvi__row_joint), for loops
 * over all entries. */
const dvi__pattern *dvi__row_joint(const dvi__row_jacobian *J);
double *dvi__row_entry(const dvi__row_jacobian *J, int entry, int column, int l);

/* Give the place of the own rows [unknowns] of a group that meet Y_l of a coordinate, and of the s
 * rows of a coordinate that meet an own unknown, counted over all groups. */
double *dvi__row_own_rows(const dvi__row_jacobian *J, int group, int column, int l);
double *dvi__row_own_column(const dvi__row_jacobian *J, int unknown, int row);

/* Give the place in the derivatives of an own row by the own unknown of the same number. */
double *dvi__row_own_diagonal(const dvi__row_jacobian *J, int unknown);

/* Add forces F [n*r] at the nodes by the principle of Lagrange and d'Alembert, beside L_q. Source:
 * Marsden and West 2001, sec. 3.2. */
void dvi__row_add_forces(const dvi__row_path *path, const double *F, double *R, double *dp);
void dvi__row_add_force_magnitudes(const dvi__row_path *path, const double *F, double *magnitude);

/* Add the derivatives F_q and F_v of forces, [entries*r] in the order of a pattern, entry-major. */
void dvi__row_add_force_derivatives(const dvi__row_path *path, const dvi__pattern *pattern,
                                    const double *F_q, const double *F_v,
                                    const dvi__row_jacobian *J);

#endif
